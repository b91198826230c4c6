//! The model: two symmetric matrices of one size that passed every check a matrix can pass before it is factored.
//!
//! K and M are scaled by powers of two so that their largest diagonal entries lie in [1, 2). The scaling is exact, is
//! undone where results leave the tool, and frees every later stage from absolute numbers: a model in N, mm and t and
//! the same model in other units give the same bits in between.

mod added_mass;
mod bodies;
mod definite;
mod finding;
mod finding_words;
mod fit;
mod heavy_rows;
mod multipliers;
mod node_order;
mod scaling;
mod site;
mod swapped;
mod symmetry;
mod weight;

use std::collections::HashSet;

use crate::cache::Cache;
use crate::dofs::{DofMap, FileRows, Nodes, RoundedAxes, RowNames};
use crate::error::{Error, Result};
use crate::input::{ConstraintRows, Input, MatrixInput};
use crate::sparse::{Leading, Precision, Rounding, SparseMatrix, couples, diagonal, is_empty_row};

pub use added_mass::add_masses;
pub(crate) use added_mass::inertia_tensor;
pub use bodies::{Bodies, node_of_row};
pub use finding::{ASYMMETRY_WARN, Finding};
use finding_words::PENALTY;
pub use fit::{CoordinateFit, Misfit, RoundedCoordinates};
pub use heavy_rows::HeavyRows;
pub use scaling::Scaling;
pub(crate) use site::ONE_PLACE;
pub use site::{Frame, Site, recentred};
pub use symmetry::{Asymmetry, make_symmetric};
pub use weight::{PartWeight, Supports, Weight};

/// A checked and scaled model.
#[derive(Clone, Debug)]
pub struct Model {
    /// K / 2^a, n × n.
    pub stiffness: SparseMatrix,
    /// M / 2^b, n × n.
    pub mass: SparseMatrix,
    /// The powers of two taken out.
    pub scaling: Scaling,
    /// How well the entries of K and M are known, in the units that they are scaled to.
    pub precision: Precision,
    /// Node and direction of each row, where known.
    pub dofs: Option<DofMap>,
    /// Coordinates and groups, where known.
    pub nodes: Option<Nodes>,
    /// Which rows of the files its rows are.
    pub rows: FileRows,
    /// Axes of nodes that rows were turned from and that look rounded, where there are some.
    pub axes: Option<RoundedAxes>,
    /// Multipoint constraints on its rows, where there are some.
    pub constraints: Option<ConstraintRows>,
    /// Internal forces of a preloaded state / 2^a, one for each row; absent where K is that of an unloaded one.
    pub internal_forces: Option<Vec<f64>>,
    /// Connected parts of the graph of K.
    pub bodies: Bodies,
    /// How coordinates and dof map fit K; unknown until [`crate::coordinates::compared`] has looked.
    pub fit: CoordinateFit,
    /// Whether supports may have taken rows out of the matrices; [`crate::coordinates::compared`] knows.
    pub supports: Supports,
    /// What was found and mended, in the order it was found.
    pub findings: Vec<Finding>,
    /// Results of earlier runs on its matrices; none unless the caller has some.
    pub cache: Option<Cache>,
}

/// What is remembered of a model after its matrices have gone into the partition.
#[derive(Clone, Debug)]
pub struct ModelFacts {
    /// Number of degrees of freedom n: rows of K and M.
    pub n_dofs: usize,
    /// How many of them the job holds.
    pub n_held: usize,
    /// How many of them follow others by constraints.
    pub n_dependent: usize,
    /// Number of nodes, where known.
    pub n_nodes: Option<usize>,
    /// Number of connected parts that can move.
    pub n_bodies: usize,
    /// The mass of all rows, where the caller asked for it and a dof map is there.
    pub weight: Option<Weight>,
    /// Which rows of the files its rows are.
    pub rows: FileRows,
    /// What was found and mended.
    pub findings: Vec<Finding>,
    /// Rows with next to all of the mass, where there are some.
    pub heavy: Option<HeavyRows>,
}

impl ModelFacts {
    /// Dofs that the job does not hold and that do not follow others by constraints.
    pub fn n_moving(&self) -> usize {
        self.n_dofs - self.n_held - self.n_dependent
    }
}

/// Above this share of its largest entry in asymmetry the matrix is not that of a conservative structure.
pub const ASYMMETRY_FAIL: f64 = 1e-6;
/// Asymmetry relative to the two rows of an entry above which it is an error. Below it the rows are known to no more than that, which error
/// bars say.
pub const ASYMMETRY_OF_ROWS_FAIL: f64 = 1e-3;

impl Model {
    /// Checks and scales what was read.
    ///
    /// # Errors
    /// Unsymmetric matrices, empty rows, negative or zero diagonals, no mass or an indefinite one, swapped K and M, rows of M in
    /// another order than those of K, numbers near the ends of the range of double precision.
    ///
    /// # Panics
    /// If K and M differ in size, which reading has ruled out.
    pub fn new(input: Input) -> Result<Self> {
        refuse_same(&input.stiffness, &input.mass)?;
        let mut findings: Vec<Finding> = input.axes.as_ref().and_then(Finding::frame_digits).into_iter().collect();
        let mut read = [&input.stiffness, &input.mass].map(rounding_of);
        let (dofs, rows) = (input.dofs, input.rows);
        let names = RowNames { rows: &rows, dofs: dofs.as_deref() };
        let (stiffness, mass) =
            rayon::join(|| symmetrised("stiffness", input.stiffness, names), || symmetrised("mass", input.mass, names));
        let ((mut stiffness, of_stiffness), (mut mass, of_mass)) = (stiffness?, mass?);
        for (rounding, finding) in read.iter_mut().zip([&of_stiffness, &of_mass]) {
            *rounding = finding.as_ref().map_or(*rounding, |finding| finding.known_by(*rounding));
        }
        findings.extend(of_stiffness.into_iter().chain(of_mass));
        assert!(stiffness.rows() == mass.rows(), "K has {} rows, M has {}", stiffness.rows(), mass.rows());
        swapped::refuse(&stiffness, &mass, dofs.as_deref())?;
        multipliers::refuse(&stiffness, &mass, names)?;
        let constraints = input.constraints;
        let tied = constraints.as_ref().map_or_else(Vec::new, ConstraintRows::tied);
        if input.internal_forces.is_none() {
            refuse_negative_diagonals(&stiffness, names)?;
        }
        check_diagonals((&stiffness, &mass), names, &tied, &mut findings)?;
        findings.extend(node_order::compared([&stiffness, &mass], (input.nodes.as_ref(), &input.cells), names)?);
        clear_negative_rounding(&mut mass);
        let scaling = Scaling::take_out(&mut stiffness, &mut mass)?;
        let in_scaled_units = |force: f64| force / scaling.stiffness_unit();
        let internal_forces = input.internal_forces.map(|forces| forces.into_iter().map(in_scaled_units).collect());
        let [of_stiffness, of_mass] = read;
        let precision = Precision {
            stiffness: in_units(of_stiffness, scaling.stiffness_unit()).measured((&stiffness).into()),
            mass: in_units(of_mass, scaling.mass_unit()).measured((&mass).into()),
        };
        let (is_definite, bodies) = rayon::join(
            || definite::refuse_indefinite(&mass, precision.mass, names),
            || Bodies::of(&stiffness, &node_of_row(stiffness.rows(), dofs.as_deref())),
        );
        is_definite?;
        let (nodes, fit, supports) = (input.nodes, CoordinateFit::Unknown, Supports::Perhaps);
        Ok(Self {
            stiffness,
            mass,
            scaling,
            precision,
            dofs,
            nodes,
            rows,
            axes: input.axes,
            constraints,
            internal_forces,
            bodies,
            fit,
            supports,
            findings,
            cache: None,
        })
    }

    /// What the rows are called in messages.
    pub fn names(&self) -> RowNames<'_> {
        RowNames { rows: &self.rows, dofs: self.dofs.as_deref() }
    }

    /// Number of degrees of freedom n.
    pub fn n_dofs(&self) -> usize {
        self.stiffness.rows()
    }

    /// Number of connected parts of the rows that a condition keeps; a scalar dof by itself is none.
    pub fn n_bodies_among(&self, is_kept: impl Fn(usize) -> bool) -> usize {
        let is_counted = |row: usize| is_kept(row) && !self.names().is_scalar(row);
        Bodies::count_among(&self.stiffness, &node_of_row(self.n_dofs(), self.dofs.as_deref()), is_counted)
    }

    /// Rows with neither stiffness nor mass, which constraints tie to others.
    pub fn empty_rows(&self) -> Vec<usize> {
        let is_empty = |row: &usize| is_empty_row(&self.stiffness, *row) && is_empty_row(&self.mass, *row);
        let tied = self.constraints.iter().flat_map(ConstraintRows::tied).map(|row| row as usize);
        tied.filter(is_empty).collect()
    }

    /// Whether some rows belong to no node.
    pub fn has_scalars(&self) -> bool {
        self.dofs.iter().flatten().any(Option::is_none)
    }

    /// Records the facts of the model.
    pub fn facts(&self) -> ModelFacts {
        let n_nodes = |dofs: &DofMap| dofs.iter().flatten().map(|dof| dof.node).collect::<HashSet<_>>().len();
        ModelFacts {
            n_dofs: self.n_dofs(),
            n_held: 0,
            n_dependent: 0,
            n_nodes: self.dofs.as_ref().map(n_nodes),
            n_bodies: if self.has_scalars() { self.n_bodies_among(|_| true) } else { self.bodies.n_bodies },
            weight: None,
            rows: self.rows.clone(),
            findings: self.findings.clone(),
            heavy: self.heavy_rows(),
        }
    }
}

/// Refuses one matrix in both places. Small diagonal ones may be equal by themselves: those of springs and masses of one.
fn refuse_same(stiffness: &MatrixInput, mass: &MatrixInput) -> Result<()> {
    let is_coupled = || stiffness.matrix.nnz() > stiffness.matrix.rows();
    if (stiffness.path == mass.path || is_coupled()) && stiffness.matrix == mass.matrix {
        let (stiffness, mass) = (stiffness.path.clone(), mass.path.clone());
        return Err(Error::SameMatrix { stiffness, mass });
    }
    Ok(())
}

/// What the entries of a matrix may be off by, in the units of its file.
pub(crate) fn rounding_of(matrix: &MatrixInput) -> Rounding {
    // Of a sum of n parts the sums on the way are no more than those of moduli.
    let own = rounding_as_written(matrix).made_by(matrix.notes.most_repeated as f64);
    matrix.notes.turned.map_or(own, |turned| own.turned(turned)).made_by(matrix.notes.added)
}

fn rounding_as_written(matrix: &MatrixInput) -> Rounding {
    let n_parts = matrix.notes.most_repeated.max(1);
    let is_of_parts = n_parts > 1;
    let half_unit = |decimals: i32| 0.5 * 10f64.powi(-decimals) * n_parts as f64;
    let absolute = matrix.digits.decimals.map_or(0.0, half_unit);
    let digits = matrix.digits.of_each_value();
    // Seventeen digits identify every double, sixteen almost every one: both are as good as binary.
    if digits >= 16 {
        return Rounding { absolute, ..Rounding::BINARY };
    }
    let n_alike = matrix.notes.most_alike.map_or(f64::INFINITY, |most| most as f64);
    Rounding { absolute, is_of_parts, n_alike, ..Rounding::relative(0.5 * 10f64.powi(1 - digits as i32)) }
}

fn in_units(rounding: Rounding, unit: f64) -> Rounding {
    Rounding { absolute: rounding.absolute / unit, ..rounding }
}

/// The matrix, symmetric to the bit, and what that took.
fn symmetrised(name: &'static str, input: MatrixInput, names: RowNames<'_>) -> Result<(SparseMatrix, Option<Finding>)> {
    let mut matrix = input.matrix;
    let asymmetry = make_symmetric(&mut matrix);
    if asymmetry.of_largest > ASYMMETRY_FAIL || asymmetry.of_rows > ASYMMETRY_OF_ROWS_FAIL {
        let place = format!(
            "{}, column {}{}",
            names.full(asymmetry.worst.0),
            names.number(asymmetry.worst.1),
            names.bracketed(asymmetry.worst.1)
        );
        let Asymmetry { of_rows: asymmetry, of_largest, unpaired, .. } = asymmetry;
        return Err(Error::Unsymmetric { matrix: name, asymmetry, of_largest, place, unpaired });
    }
    let Asymmetry { of_largest, of_rows, difference, worst: (row, col), .. } = asymmetry;
    let at = [row, col].map(|row| names.number(row));
    let finding = Finding::Symmetrised { matrix: name, of_largest, of_rows, difference, at };
    Ok((matrix, (of_rows > 0.0).then_some(finding)))
}

/// Refuses diagonals that no structure has. Rows that constraints tie to others (`tied`, ascending) need neither stiffness nor mass.
fn check_diagonals(
    (stiffness, mass): (&SparseMatrix, &SparseMatrix),
    names: RowNames<'_>,
    tied: &[u32],
    findings: &mut Vec<Finding>,
) -> Result<()> {
    let n = stiffness.rows();
    let (k_diag, m_diag) = (diagonal(stiffness), diagonal(mass));
    let m_max = m_diag.iter().fold(0.0f64, |max, m| max.max(m.abs()));
    if m_max == 0.0 && mass.data().iter().all(|m| *m == 0.0) {
        return Err(Error::NoMass);
    }
    let (mut massless, mut alone, mut rounding) = (0, 0, 0);
    let (mut empty, mut particles) = (Vec::new(), Vec::new());
    for (row, m) in m_diag.iter().copied().enumerate() {
        let k_empty = is_empty_row(stiffness, row);
        let m_empty = is_empty_row(mass, row);
        if k_empty && m_empty {
            if tied.binary_search(&(row as u32)).is_err() {
                empty.push(row);
            }
            continue;
        }
        // Of a superelement that one node holds, K̂ has no other rows: inertia couples the node with the motion inside.
        let is_amplitude = |other: usize| names.is_scalar(other) && k_diag[other] > 0.0;
        if k_empty && !couples(mass, row, is_amplitude) {
            particles.push(row);
        }
        if m_empty {
            massless += 1;
            let is_tied = tied.binary_search(&(row as u32)).is_ok();
            alone += usize::from(!is_tied && Leading::from(stiffness).is_diagonal_row(row));
        } else if m < -(n as f64) * f64::EPSILON * m_max {
            return Err(Error::NegativeMass { row: names.number(row), dof: names.bracketed(row), value: m });
        } else if m < 0.0 {
            rounding += 1;
        }
    }
    if let Some(first) = empty.first() {
        return Err(Error::EmptyRows { n_rows: empty.len(), row: names.number(*first), dof: names.bracketed(*first) });
    }
    let mut note = |n_rows: usize, finding: fn(usize) -> Finding| {
        if n_rows > 0 {
            findings.push(finding(n_rows));
        }
    };
    note(massless, |n_rows| Finding::MasslessRows { n_rows });
    note(alone, |n_rows| Finding::HeldByDiagonal { n_rows });
    note(rounding, |n_rows| Finding::NegativeMassByRounding { n_rows });
    findings.extend(Finding::free_particles(particles, names));
    findings.extend(penalties(&k_diag, names));
    Ok(())
}

/// Refuses a dof without stiffness of its own but a negative one. A preloaded component may have such dofs where the job holds them or a
/// patch carries them; where neither does, the factor counts the negative eigenvalues that they make.
fn refuse_negative_diagonals(stiffness: &SparseMatrix, names: RowNames<'_>) -> Result<()> {
    match diagonal(stiffness).into_iter().enumerate().find(|(_, value)| *value < 0.0) {
        Some((row, value)) => {
            Err(Error::NegativeStiffness { row: names.number(row), dof: names.bracketed(row), value })
        }
        None => Ok(()),
    }
}

/// Rows whose stiffness no structure has.
fn penalties(k_diag: &[f64], names: RowNames<'_>) -> Option<Finding> {
    // The stiffness of an amplitude has the unit of its shape.
    let rows = || (0..k_diag.len()).filter(|row| !names.is_scalar(*row));
    let mut sizes: Vec<f64> = rows().map(|row| k_diag[row]).filter(|value| *value > 0.0).collect();
    if sizes.is_empty() {
        return None;
    }
    let middle = sizes.len() / 2;
    let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    let stiff = |row: &usize| k_diag[*row] > PENALTY * median;
    let n_rows = rows().filter(stiff).count();
    let stiffest = rows().filter(stiff).max_by(|a, b| k_diag[*a].total_cmp(&k_diag[*b]))?;
    Some(Finding::Penalties { n_rows, first: names.full(stiffest), ratio: k_diag[stiffest] / median })
}

/// Sets diagonal entries of M that are negative, which by now is rounding only, to zero.
fn clear_negative_rounding(mass: &mut SparseMatrix) {
    for row in 0..mass.rows() {
        if let Some(value) = mass.get_mut(row, row).filter(|value| **value < 0.0) {
            *value = 0.0;
        }
    }
}
