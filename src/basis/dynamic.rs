//! Dynamic modes: what the interior does beyond following the interface statically.

use faer::{Mat, MatRef};

use super::orthonormal::orthonormalised;
use super::rounding::{INDEPENDENT, clear_rounding, clear_unloaded};
use crate::constraint::ConstraintModes;
use crate::dense;
use crate::eigen::{Modes, mass_qr, rows_with_mass};
use crate::factor::SolveOperator;
use crate::job::Boundary;
use crate::modes::Retained;
use crate::partition::{Expansion, LoadFacts, Partition};
use crate::rigid::RigidBodyModes;
use crate::sparse::Leading;
use crate::sparse::{absolute_energy, product};

/// What a dynamic coordinate stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DynamicCoordinate {
    /// Rigid-body mode k itself, in a model without interface.
    RigidBody(usize),
    /// Inertia-relief mode of rigid-body motion k.
    InertiaRelief(usize),
    /// Mode-accelerated free-free mode k.
    FreeFree(usize),
    /// Fixed-interface normal mode k.
    FixedInterface(usize),
    /// Mode-accelerated mode k with some interface dofs held.
    MixedInterface(usize),
    /// Mode-accelerated expansion mode k of a file.
    Expansion(usize),
    /// Residual vector of load k of the job.
    ResidualVector(usize),
}

impl DynamicCoordinate {
    /// The number of the mode, of one that was computed.
    pub fn mode(self) -> Option<usize> {
        match self {
            Self::FreeFree(mode) | Self::FixedInterface(mode) | Self::MixedInterface(mode) => Some(mode),
            Self::RigidBody(_) | Self::InertiaRelief(_) | Self::Expansion(_) | Self::ResidualVector(_) => None,
        }
    }

    /// What it is called, counted from one: `mode 3`, `residual vector of thrust`. `loads` are those of the job.
    pub fn name(self, loads: &[LoadFacts]) -> String {
        match self {
            Self::RigidBody(index) => format!("rigid-body mode {}", index + 1),
            Self::InertiaRelief(index) => format!("inertia relief {}", index + 1),
            Self::FreeFree(mode) | Self::FixedInterface(mode) | Self::MixedInterface(mode) => {
                format!("mode {}", mode + 1)
            }
            Self::Expansion(mode) => format!("expansion mode {}", mode + 1),
            Self::ResidualVector(load) => format!("residual vector of {}", loads[load].name),
        }
    }
}

/// A column that was left out.
#[derive(Clone, Debug, PartialEq)]
pub struct DroppedColumn {
    /// What it was.
    pub coordinate: DynamicCoordinate,
    /// What was left of its length after taking out the columns before it.
    pub remaining: f64,
}

/// Columns for Ψ_D before dependent ones are taken out, in the order of the coordinates.
#[derive(Clone, Debug)]
pub struct DynamicColumns {
    /// n_I × n_η.
    pub columns: Mat<f64>,
    /// What each column is.
    pub coordinates: Vec<DynamicCoordinate>,
}

/// Lengths asked for instead in a complete basis, where any columns that are independent span the whole interior: the largest
/// that leaves as many. A column that keeps little is put together from large parts of little, and its name is lost in rounding.
const CLEARLY_INDEPENDENT: [f64; 4] = [1e-4, 1e-5, 1e-6, 1e-7];
/// Columns orthogonalised together.
const PANEL: usize = 8;

impl DynamicColumns {
    /// These columns, then others.
    pub(super) fn followed_by(self, others: Self) -> Self {
        Self {
            columns: dense::side_by_side(self.columns.as_ref(), others.columns.as_ref()),
            coordinates: self.coordinates.into_iter().chain(others.coordinates).collect(),
        }
    }
}

/// Without an interface: the rigid-body modes and the elastic modes themselves, V = \[U X\] of (22).
pub fn modal_columns(rigid: &RigidBodyModes, modes: &Modes) -> DynamicColumns {
    let columns = dense::side_by_side(rigid.modes.as_ref(), modes.shapes.as_ref());
    let zero = (0..rigid.count()).map(DynamicCoordinate::RigidBody);
    DynamicColumns { columns, coordinates: zero.chain((0..modes.count()).map(DynamicCoordinate::FreeFree)).collect() }
}

/// Inertia-relief modes K_II⁻¹ (MU)_I (37) of the rigid-body modes `motions`, by their numbers.
pub fn inertia_relief_columns(
    partition: &Partition,
    factor: &dyn SolveOperator,
    (rigid, motions): (&RigidBodyModes, &[usize]),
) -> DynamicColumns {
    // The modes of the file, not the orthonormal ones: a coordinate then answers to one named unit acceleration.
    let moved = dense::columns(rigid.modes.as_ref(), motions);
    let inertia = product(&partition.mass, moved.as_ref());
    let mut columns = inertia.as_ref().subrows(0, partition.n_internal).to_owned();
    let terms = absolute_energy(&partition.mass, moved.as_ref());
    clear_unloaded(partition, &terms, columns.as_mut());
    factor.solve_in_place(columns.as_mut());
    DynamicColumns { columns, coordinates: motions.iter().copied().map(DynamicCoordinate::InertiaRelief).collect() }
}

/// Mode-accelerated expansion modes K_II⁻¹ (MV)_I (23) of a file. For eigenvectors these are X_I − Ψ_S X_B over ω², for rigid-body
/// motions inertia-relief modes (37): whoever gives all modes of a method has its space.
pub fn expansion_columns(partition: &Partition, factor: &dyn SolveOperator) -> DynamicColumns {
    let Expansion { facts, inertia } = &partition.expansion;
    let mut columns = inertia.as_ref().subrows(0, partition.n_internal).to_owned();
    let terms: Vec<f64> = facts.iter().map(|facts| facts.terms).collect();
    clear_unloaded(partition, &terms, columns.as_mut());
    factor.solve_in_place(columns.as_mut());
    DynamicColumns { columns, coordinates: (0..facts.len()).map(DynamicCoordinate::Expansion).collect() }
}

/// Mode-accelerated modes X_I − Ψ_S X_B (23); modes of the held interface, X_B = 0, stay as they are (38).
///
/// Equation (23) asks for K_II⁻¹ (M_II X_I + M_IB X_B); for an eigenvector that is ω⁻² (X_I − Ψ_S X_B), without a solve.
/// Every column is scaled to unit length, so the factor does not matter.
pub fn accelerated_columns(
    partition: &Partition,
    constraint: &ConstraintModes<'_>,
    retained: &Retained,
) -> DynamicColumns {
    let (n_i, n_b, modes) = (partition.n_internal, partition.n_interface(), &retained.modes);
    let mut columns = modes.shapes.as_ref().subrows(0, n_i).to_owned();
    if retained.boundary != Boundary::FixedInterface {
        let x_b = modes.shapes.as_ref().subrows(n_i, n_b);
        constraint.modes.add_followed(columns.as_mut(), -1.0, x_b);
        clear_rounding(partition, constraint, modes, columns.as_mut());
    }
    let kind = match retained.boundary {
        Boundary::FixedInterface => DynamicCoordinate::FixedInterface,
        Boundary::FreeInterface => DynamicCoordinate::FreeFree,
        Boundary::MixedInterface => DynamicCoordinate::MixedInterface,
    };
    DynamicColumns { columns, coordinates: (0..modes.count()).map(kind).collect() }
}

/// Columns that are M_II-orthonormal, with the triangle that gives the named ones back.
pub(super) struct Independent {
    pub(super) modes: Mat<f64>,
    pub(super) coordinates: Vec<DynamicCoordinate>,
    pub(super) mixing: Mat<f64>,
    pub(super) kept: Vec<usize>,
    pub(super) dropped: Vec<DroppedColumn>,
}

/// M_II-orthonormalises the columns in their order, leaving out those that depend on earlier ones, unless they are `asked` for.
///
/// The order matters: a column is replaced by what it adds to the columns before it, so the low modes keep their shape.
pub(super) fn independent(named: &DynamicColumns, mass: Leading<'_>, asked: &[usize]) -> Independent {
    let n_rows = rows_with_mass(mass);
    // More columns than there are dimensions depend on each other, whatever rounding leaves of the last ones.
    match orthonormalised(named.columns.as_ref(), mass).filter(|(modes, _)| modes.ncols() <= n_rows) {
        Some((modes, mixing)) => {
            let kept = (0..modes.ncols()).collect();
            Independent { modes, coordinates: named.coordinates.clone(), mixing, kept, dropped: Vec::new() }
        }
        None => {
            let found = by_panels(named, mass, (INDEPENDENT, asked));
            let is_complete = found.kept.len() == n_rows;
            if !is_complete || found.least_share() > CLEARLY_INDEPENDENT[0] {
                return found;
            }
            let mut clearer = CLEARLY_INDEPENDENT.into_iter().map(|least| by_panels(named, mass, (least, &[])));
            let clearest = clearer.find(|other| other.kept.len() == found.kept.len()).unwrap_or(found);
            clearest.with_whole_mixing(named, mass)
        }
    }
}

impl Independent {
    /// The mixing of a complete basis, where a column that was left out has parts in columns behind it, too.
    fn with_whole_mixing(mut self, named: &DynamicColumns, mass: Leading<'_>) -> Self {
        let left_out: Vec<usize> = (0..named.columns.ncols()).filter(|j| !self.kept.contains(j)).collect();
        let columns = dense::columns(named.columns.as_ref(), &left_out);
        let parts = dense::gram(self.modes.as_ref(), product(mass, columns.as_ref()).as_ref());
        for (j, part) in left_out.into_iter().zip(parts.col_iter()) {
            self.mixing.as_mut().col_mut(j).copy_from(part);
        }
        self
    }

    /// The smallest share of its length that a column kept without the columns before it.
    fn least_share(&self) -> f64 {
        let share = |(slot, named): (usize, &usize)| {
            self.mixing[(slot, *named)].abs() / dense::norm(dense::column(self.mixing.as_ref(), *named))
        };
        self.kept.iter().enumerate().map(share).fold(1.0, f64::min)
    }
}

/// The independent columns where columns may depend on each other: those that keep more than `least` of their length or are asked for, and
/// no more than there are rows with mass, whatever rounding leaves of further ones.
fn by_panels(named: &DynamicColumns, mass: Leading<'_>, (least, asked): (f64, &[usize])) -> Independent {
    let (n, total, most) = (named.columns.nrows(), named.columns.ncols(), rows_with_mass(mass));
    let mut basis = Mat::zeros(n, total);
    let mut mixing = Mat::zeros(total, total);
    let (mut coordinates, mut kept, mut dropped) = (Vec::new(), Vec::new(), Vec::new());
    let mut start = 0;
    while start < total {
        // A column that is asked for is a panel of its own, of which nothing is too little.
        let is_asked = asked.contains(&start);
        let rest = start + 1..total.min(start + PANEL);
        let width = if is_asked { 1 } else { 1 + rest.take_while(|column| !asked.contains(column)).count() };
        let mut panel = named.columns.as_ref().subcols(start, width).to_owned();
        let lengths = scale_to_unit_mass(&mut panel, mass);
        let size = kept.len();
        let least = if is_asked { 0.0 } else { least };
        let mut step = orthonormal_panel(basis.as_ref().subcols(0, size), panel, (mass, least));
        step.kept.truncate(most - size);
        for j in 0..width {
            let coordinate = named.coordinates[start + j];
            for i in 0..size {
                mixing[(i, start + j)] = step.coefficients[(i, j)] * lengths[j];
            }
            for (slot, i) in step.kept.iter().enumerate() {
                mixing[(size + slot, start + j)] = step.coupling[(*i, j)] * lengths[j];
            }
            if step.kept.contains(&j) {
                basis.as_mut().subcols_mut(kept.len(), 1).copy_from(step.block.as_ref().subcols(j, 1));
                kept.push(start + j);
                coordinates.push(coordinate);
            } else {
                dropped.push(DroppedColumn { coordinate, remaining: step.remaining[j] });
            }
        }
        start += width;
    }
    Independent {
        modes: basis.as_ref().subcols(0, kept.len()).to_owned(),
        mixing: mixing.as_ref().subrows(0, kept.len()).to_owned(),
        coordinates,
        kept,
        dropped,
    }
}

/// Scales columns to unit M_II-length and returns the lengths; a column without mass becomes zero.
fn scale_to_unit_mass(panel: &mut Mat<f64>, mass: Leading<'_>) -> Vec<f64> {
    let images = product(mass, panel.as_ref());
    let mut lengths = Vec::with_capacity(panel.ncols());
    for j in 0..panel.ncols() {
        let square = dense::dot(dense::column(panel.as_ref(), j), dense::column(images.as_ref(), j));
        let length = square.max(0.0).sqrt();
        let factor = if length > 0.0 { 1.0 / length } else { 0.0 };
        dense::column_mut(panel.as_mut(), j).iter_mut().for_each(|value| *value *= factor);
        lengths.push(length);
    }
    lengths
}

struct Step {
    block: Mat<f64>,
    coefficients: Mat<f64>,
    coupling: Mat<f64>,
    kept: Vec<usize>,
    remaining: Vec<f64>,
}

/// panel = basis · coefficients + block · coupling, twice over for orthogonality to rounding, and once more where a column is kept of which
/// rounding is the larger part.
fn orthonormal_panel(basis: MatRef<'_, f64>, panel: Mat<f64>, (mass, independent): (Leading<'_>, f64)) -> Step {
    let width = panel.ncols();
    let mut block = panel.clone();
    let mut coefficients = Mat::zeros(basis.ncols(), width);
    let mut coupling: Mat<f64> = Mat::identity(width, width);
    let mut dependent = vec![false; width];
    let mut remaining = vec![0.0; width];
    for pass in 0..if independent > 0.0 { 2 } else { 3 } {
        let c = dense::gram(basis, product(mass, block.as_ref()).as_ref());
        dense::add_product(block.as_mut(), -1.0, basis, c.as_ref());
        dense::add_product(coefficients.as_mut(), 1.0, c.as_ref(), coupling.as_ref());
        let mut image = product(mass, block.as_ref());
        let least = if pass == 0 { independent } else { 0.0 };
        let r = mass_qr(&mut block, &mut image, least, &mut dependent);
        if pass == 0 {
            remaining = (0..width).map(|j| r[(j, j)]).collect();
        }
        coupling = dense::product(r.as_ref(), coupling.as_ref());
    }
    // Gram-Schmidt makes nothing of a column that depends on others; what was left of it is measured anew.
    for j in (0..width).filter(|j| dependent[*j]) {
        remaining[j] = left_of(panel.as_ref().subcols(j, 1), [basis, block.as_ref().subcols(0, j)], mass);
    }
    Step { block, coefficients, coupling, kept: (0..width).filter(|j| !dependent[*j]).collect(), remaining }
}

/// Length in the mass of what is left of a column without its parts along orthonormal columns, some of which may be zero.
fn left_of(column: MatRef<'_, f64>, without: [MatRef<'_, f64>; 2], mass: Leading<'_>) -> f64 {
    let mut left = column.to_owned();
    for basis in [without, without].concat() {
        let parts = dense::gram(basis, product(mass, left.as_ref()).as_ref());
        dense::add_product(left.as_mut(), -1.0, basis, parts.as_ref());
    }
    let image = product(mass, left.as_ref());
    dense::dot(dense::column(left.as_ref(), 0), dense::column(image.as_ref(), 0)).max(0.0).sqrt()
}
