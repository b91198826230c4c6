//! The matrices of the full model on the columns made again, with what is known of their errors.
//!
//! ```text
//! WᵀKW, WᵀMW   q × q      q = p + n_N
//! WᵀMe         q × 3      e a unit translation
//! FᵀTW         n_l × q    loads of the job
//! RTW          1 × q      a quantity of the job
//! TW           m × q      rows of the model that the file recovers
//! ```
//! Nothing larger outlives this stage.

use faer::{Mat, MatRef};
use supel_runtime::MatrixKind;

use super::bilinear::{Bilinear, Known};
use super::columns::{Columns, Named};
use super::dependence::Dependence;
use super::interior::Solved;
use crate::dense::{self, NOISE_FACTOR};
use crate::partition::Partition;
use crate::reduction::clear_rounding;
use crate::sparse::energies_of_terms;
use crate::sparse::{SparseMatrix, panels, product, product_and_terms};

/// A symmetric form on some columns w, whose own errors are e.
#[derive(Clone)]
pub(super) struct Form {
    /// wᵀAw, q × q.
    pub(super) matrix: Mat<f64>,
    /// √(eᵀAe).
    pub(super) errors: Vec<f64>,
    /// √(|w|ᵀ|A||w|): rounding of an entry is ε times the product of two of these.
    pub(super) terms: Vec<f64>,
}

/// A linear map of some columns.
#[derive(Clone)]
pub(super) struct Rows {
    /// m × q.
    pub(super) rows: Mat<f64>,
    /// What the entries of each column may be off by.
    pub(super) errors: Vec<f64>,
    /// How large the entries of each column may be.
    pub(super) sizes: Vec<f64>,
}

/// The full model on the columns W.
pub(super) struct Projected {
    /// P, n_B × p.
    pub(super) probes: Mat<f64>,
    pub(super) named: Vec<Named>,
    pub(super) stiffness: Form,
    pub(super) mass: Form,
    /// What M̂ has to be in place of WᵀMW, where it sees some motions alone.
    modal_mass: Option<Form>,
    /// (WᵀMe)ᵀ, 3 × q, where the directions are known.
    pub(super) gravity: Option<Rows>,
    /// 1/√m by which the loads of gravity count among what tells columns apart, of a component that the job holds: of a free one they
    /// are M̂Û, which the interface sees.
    pub(super) gravity_weight: Option<f64>,
    /// fᵀTW of each load of the job, 1 × q, in its unit.
    pub(super) loads: Vec<Rows>,
    /// R T W of each quantity of the job, 1 × q.
    pub(super) quantities: Vec<Rows>,
    /// WᵀAW of each further matrix of the job, in its unit.
    pub(super) matrices: Vec<Bilinear>,
    /// TW, where rows are recovered.
    pub(super) recovery: Option<Rows>,
    /// (WᵀMU)ᵀ, n_r × q, U the unit motions; of a component without interface that has them.
    pub(super) motions: Option<Mat<f64>>,
    /// How well static answers solve their equations.
    pub(super) solved: Solved,
    /// λ₁, the first elastic eigenvalue.
    pub(super) first: f64,
    /// How far the named columns depend on each other.
    pub(super) dependence: Dependence,
}

impl Projected {
    /// Projects the matrices; `unit` are the unit motions, translations first, where the directions are known, `n_zero` is how many
    /// motions are free, and `first` the first elastic eigenvalue.
    pub(super) fn new(
        partition: &Partition,
        columns: Columns,
        (unit, n_zero, first): (Option<MatRef<'_, f64>>, usize, f64),
        massive: Option<Massive>,
    ) -> Self {
        let (shapes, n_probes) = (columns.shapes.as_ref(), columns.n_probes());
        let stiffness = form(&partition.stiffness, shapes, &columns.energy_errors);
        let mass = form(&partition.mass, shapes, &columns.inertia_errors);
        let modal_mass = massive.map(|massive| massive.form(partition, shapes, &mass));
        let of_held = partition.gravity.as_ref().map(|gravity| (gravity.loads.clone(), gravity.mass));
        let gravity_weight = of_held.as_ref().filter(|(_, mass)| *mass > 0.0).map(|(_, mass)| 1.0 / mass.sqrt());
        let loads_of = |unit: MatRef<'_, f64>| {
            let loads = product(&partition.mass, unit.subcols(0, 3));
            let mass = dense::dots(unit.subcols(0, 3), loads.as_ref()).into_iter().fold(0.0, f64::max);
            (loads, mass)
        };
        let gravity = of_held.or_else(|| unit.map(loads_of));
        let gravity = gravity.map(|of| loads((of.0.as_ref(), of.1), shapes, (&mass, n_probes)));
        let named_loads = (0..partition.loads.count()).map(|load| {
            let norm = columns.load_norms.as_ref().map(|norms| norms[load]);
            named_load(partition, (load, norm), shapes, ([&stiffness, &mass], first))
        });
        let named_loads: Vec<Rows> = named_loads.collect();
        let diagonal = crate::sparse::diagonal(&partition.mass);
        let quantities =
            partition.quantities.rows.iter().map(|row| quantity(row, shapes, (&mass, &diagonal))).collect();
        let lengths: Vec<f64> = (0..shapes.ncols()).map(|j| mass.matrix[(j, j)].max(0.0).sqrt()).collect();
        let known = Known { lengths: &lengths, errors: &mass.errors, diagonal: &diagonal };
        let further = partition.matrices.iter();
        let mut matrices: Vec<Bilinear> = further.map(|carried| Bilinear::of(&carried.matrix, shapes, known)).collect();
        for (carried, form) in partition.matrices.iter().zip(&mut matrices) {
            if shapes.ncols() == n_zero && carried.facts.kind == MatrixKind::Damping {
                clear_rounding(&mut form.matrix, carried, shapes);
            }
        }
        let recovery = (!partition.recovered.rows.is_empty()).then(|| recovered(partition, &columns, &mass));
        let is_modal = columns.probes.ncols() == 0;
        let motions =
            unit.filter(|_| is_modal).map(|unit| dense::gram(product(&partition.mass, unit).as_ref(), shapes));
        let dependence = Dependence::of(&partition.mass, shapes.subcols(n_probes, columns.named.len()));
        let Columns { probes, named, solved, .. } = columns;
        Self {
            probes,
            named,
            stiffness,
            mass,
            modal_mass,
            gravity,
            gravity_weight,
            loads: named_loads,
            quantities,
            matrices,
            recovery,
            motions,
            solved,
            first,
            dependence,
        }
    }

    /// Whether a column has an energy that is more than rounding next to that of its inertia in the first elastic mode: a free mass at the
    /// interface has none.
    pub(super) fn is_stiff(&self, column: usize) -> bool {
        let [energy, inertia] = [&self.stiffness, &self.mass].map(|form| form.matrix[(column, column)]);
        energy > least_energy(inertia, self.first)
    }

    /// The place of a named column.
    pub(super) fn place_of(&self, named: Named) -> Option<usize> {
        self.named.iter().position(|known| *known == named)
    }

    /// What M̂ has to be on the columns.
    pub(super) fn reduced_mass(&self) -> &Form {
        self.modal_mass.as_ref().unwrap_or(&self.mass)
    }

    /// How many of the first columns leave the interior in equilibrium: none of Rubin's static modes, which rigid-body modes stand next to.
    pub(super) fn n_in_equilibrium(&self) -> usize {
        match self.named.iter().any(|named| matches!(named, Named::Rigid(_))) {
            true => 0,
            false => self.n_probes(),
        }
    }

    /// p.
    pub(super) fn n_probes(&self) -> usize {
        self.probes.ncols()
    }

    /// The error of a named column relative to its length in the mass, ten times over: it is no more than an estimate.
    pub(super) fn doubt(&self, column: usize) -> f64 {
        let at = self.n_probes() + column;
        let length = self.mass.matrix[(at, at)].max(f64::MIN_POSITIVE).sqrt();
        NOISE_FACTOR * self.mass.errors[at] / length
    }

    /// The largest error of a column that is a static answer relative to itself, in energy.
    pub(super) fn error_of_answers(&self) -> f64 {
        let is_answer = |named: &Named| matches!(named, Named::Relief(_) | Named::Residual(_));
        let share = |column: usize| {
            let (at, energy) = (self.n_probes() + column, &self.stiffness.matrix);
            let length = energy[(at, at)].max(0.0).sqrt();
            if length > 0.0 { self.stiffness.errors[at] / length } else { 0.0 }
        };
        (0..self.named.len()).filter(|column| is_answer(&self.named[*column])).map(share).fold(0.0, f64::max)
    }

    /// The largest rounding of the inertia of a named column, relative to it.
    pub(super) fn rounding_of_inertia(&self) -> f64 {
        let share = |column: usize| {
            let at = self.n_probes() + column;
            self.mass.terms[at].powi(2) / self.mass.matrix[(at, at)].max(f64::MIN_POSITIVE)
        };
        f64::EPSILON * (0..self.named.len()).map(share).fold(0.0, f64::max)
    }

    /// Length of a named column in the mass; that of the mode it is made of is one.
    pub(super) fn length(&self, column: usize) -> f64 {
        let at = self.n_probes() + column;
        match self.named[column] {
            Named::Mode(_) => self.mass.matrix[(at, at)].max(0.0).sqrt(),
            Named::Rigid(_) | Named::Relief(_) | Named::Expansion(_) | Named::Residual(_) => 1.0,
        }
    }

    /// What rounding of products with M makes of the share of its length that a column keeps without others: ε of the terms of each.
    pub(super) fn rounding_of_share(&self, column: usize, others: &[usize]) -> f64 {
        let square = |place: &usize| {
            let at = self.n_probes() + place;
            self.mass.terms[at].powi(2) / self.mass.matrix[(at, at)].max(f64::MIN_POSITIVE)
        };
        NOISE_FACTOR * f64::EPSILON * others.iter().chain([&column]).map(square).sum::<f64>()
    }
}

/// The motions that a reduced mass sees where it does not see all: Q, n' × (n_r + k), rigid-body motion and modes found again.
pub(super) struct Massive {
    /// Q, M-orthonormal.
    pub(super) shapes: Mat<f64>,
    /// How far a motion of this space may lie outside of that of the reduction: the sine of an angle in the mass.
    pub(super) angle: f64,
}

impl Massive {
    /// WᵀMQ (WᵀMQ)ᵀ, with `mass` the form WᵀMW.
    ///
    /// Another Q, at an angle α to this one, changes wᵀMQ QᵀMv by α ‖w‖ ‖QᵀMv‖ and α ‖v‖ ‖QᵀMw‖ at most. Both are those of an error α‖w‖ of each column.
    fn form(self, partition: &Partition, shapes: MatRef<'_, f64>, mass: &Form) -> Form {
        let seen = dense::gram(shapes, product(&partition.mass, self.shapes.as_ref()).as_ref());
        let mut matrix = dense::product(seen.as_ref(), seen.transpose());
        dense::symmetrise(&mut matrix);
        let length = |j: usize| mass.matrix[(j, j)].max(0.0).sqrt();
        let errors = mass.errors.iter().enumerate().map(|(j, error)| error + self.angle * length(j)).collect();
        Form { matrix, errors, terms: mass.terms.clone() }
    }
}

/// ελ₁ wᵀMw: what rounding leaves of the energy of a column that has none, next to that of its inertia in the first elastic mode. An energy
/// below is compared with it, and not with itself.
pub(super) fn least_energy(inertia: f64, first: f64) -> f64 {
    f64::EPSILON * first * inertia.max(0.0)
}

/// wᵀAw, panel by panel.
fn form(matrix: &SparseMatrix, shapes: MatRef<'_, f64>, errors: &[f64]) -> Form {
    let q = shapes.ncols();
    let (mut projected, mut terms) = (Mat::zeros(q, q), Vec::with_capacity(q));
    for columns in panels(q) {
        let panel = shapes.get(.., columns.clone());
        let (image, sizes) = product_and_terms(matrix, panel);
        terms.extend(energies_of_terms(panel, sizes.as_ref()).into_iter().map(f64::sqrt));
        projected.as_mut().get_mut(.., columns).copy_from(dense::gram(shapes, image.as_ref()));
    }
    dense::symmetrise(&mut projected);
    // Entries of a column are rounded by ε of themselves, which is a motion as large as ε times its terms.
    let errors = errors.iter().zip(&terms).map(|(error, terms)| error + f64::EPSILON * terms).collect();
    Form { matrix: projected, errors, terms }
}

/// (WᵀMe)ᵀ for unit motions e with the largest eᵀMe: no more than the product of both lengths in the mass.
fn loads((loads, largest): (MatRef<'_, f64>, f64), shapes: MatRef<'_, f64>, (mass, n_probes): (&Form, usize)) -> Rows {
    let length = largest.sqrt();
    let columns = 0..shapes.ncols();
    let own = |j: usize| mass.matrix[(j, j)].max(0.0).sqrt();
    // What one column of a kind lacks another may lack as well: all come from the same factor.
    let share = |like: std::ops::Range<usize>| {
        let shares = like.filter(|j| own(*j) > 0.0).map(|j| mass.errors[j] / own(j));
        shares.fold(0.0, f64::max)
    };
    let shares = [share(0..n_probes), share(n_probes..shapes.ncols())];
    let error = |j: usize| mass.errors[j].max(shares[usize::from(j >= n_probes)] * own(j));
    Rows {
        rows: dense::gram(loads, shapes),
        errors: columns.clone().map(|j| length * (error(j) + f64::EPSILON * mass.terms[j])).collect(),
        sizes: columns.map(|j| length * own(j)).collect(),
    }
}

/// fᵀTW of one load f. An error e of a column has the energy eᵀKe, so that |fᵀe| ≤ √(f_Iᵀ K_II⁻¹ f_I) √(eᵀKe); a component of which
/// no interior answers has its inertia instead, with the diagonal of M. On a column without stiffness f does work by rounding alone, which is
/// compared with that of a motion of its least energy.
fn named_load(
    partition: &Partition,
    (load, norm): (usize, Option<f64>),
    shapes: MatRef<'_, f64>,
    ([stiffness, mass], first): ([&Form; 2], f64),
) -> Rows {
    let vector = partition.loads.vectors.as_ref().subcols(load, 1);
    let terms = dense::gram(dense::absolute(vector).as_ref(), dense::absolute(shapes).as_ref());
    let by_inertia = || {
        let diagonal = crate::sparse::diagonal(&partition.mass);
        let share = |(f, m): (&f64, f64)| if m > 0.0 { f * f / m } else { 0.0 };
        dense::column(vector, 0).iter().zip(diagonal).map(share).sum::<f64>().sqrt()
    };
    let least = |norm: f64, j: usize| norm * least_energy(mass.matrix[(j, j)], first).sqrt();
    let (norm, errors, of_energy) = match norm {
        Some(norm) => (norm, &stiffness.errors, norm),
        None => (by_inertia(), &mass.errors, 0.0),
    };
    Rows {
        rows: dense::gram(vector, shapes),
        errors: errors.iter().enumerate().map(|(j, error)| norm * error + f64::EPSILON * terms[(0, j)]).collect(),
        sizes: (0..shapes.ncols()).map(|j| terms[(0, j)].max(least(of_energy, j))).collect(),
    }
}

/// r W of one quantity r. An error e of a column has the inertia eᵀMe, so that |r e| is about √(Σ r_k²/M_kk) √(eᵀMe) at most. What a
/// massless dof lacks is like its own motion.
fn quantity(row: &[(u32, f64)], shapes: MatRef<'_, f64>, (mass, diagonal): (&Form, &[f64])) -> Rows {
    let terms = |j: usize| row.iter().map(|(dof, factor)| (factor * shapes[(*dof as usize, j)]).abs()).sum::<f64>();
    let share = |(dof, factor): &(u32, f64)| {
        let mass = diagonal[*dof as usize];
        if mass > 0.0 { factor * factor / mass } else { 0.0 }
    };
    let norm = row.iter().map(share).sum::<f64>().sqrt();
    let massless = |j: usize| {
        let of_dof = |(dof, factor): &(u32, f64)| {
            if diagonal[*dof as usize] > 0.0 { 0.0 } else { (factor * shapes[(*dof as usize, j)]).abs() }
        };
        let length = mass.matrix[(j, j)].max(0.0).sqrt();
        if length > 0.0 { row.iter().map(of_dof).sum::<f64>() / length } else { 0.0 }
    };
    let error = |j: usize| (norm + massless(j)) * mass.errors[j] + f64::EPSILON * terms(j);
    Rows {
        rows: Mat::from_fn(1, shapes.ncols(), |_, j| {
            row.iter().map(|(dof, factor)| factor * shapes[(*dof as usize, j)]).sum()
        }),
        errors: (0..shapes.ncols()).map(error).collect(),
        sizes: (0..shapes.ncols()).map(terms).collect(),
    }
}

/// TW. What a column lacks is a motion of like columns: displacements for its inertia are as large as theirs, wherever those are largest,
/// because rows that a mode leaves at rest are moved by what it lacks all the same. What solves lack is measured.
fn recovered(partition: &Partition, columns: &Columns, mass: &Form) -> Rows {
    /// Share of their largest displacement up to which columns are at rest in all recovered rows, and compared with that.
    const AT_REST: f64 = 1e-6;
    let (shapes, n_probes) = (columns.shapes.as_ref(), columns.n_probes());
    let rows = Mat::from_fn(partition.recovered.rows.len(), shapes.ncols(), |i, j| {
        let entries = partition.transformation.rows[partition.recovered.rows[i].0].entries();
        entries.map(|(dof, factor)| factor * shapes[(dof as usize, j)]).sum()
    });
    let length = |j: usize| mass.matrix[(j, j)].max(0.0).sqrt();
    let largest = |a: MatRef<'_, f64>, j: usize| dense::column(a, j).iter().fold(0.0f64, |max, x| max.max(x.abs()));
    let (mut errors, mut sizes) = (Vec::new(), Vec::new());
    for like in [0..n_probes, n_probes..shapes.ncols()] {
        let share = |a: MatRef<'_, f64>| {
            let shares = like.clone().filter(|j| length(*j) > 0.0).map(|j| largest(a, j) / length(j));
            shares.fold(0.0, f64::max)
        };
        let own = share(rows.as_ref());
        let whole = share(shapes).max(own);
        errors.extend(like.clone().map(|j| {
            whole * mass.errors[j] + columns.displacement_errors[j] + f64::EPSILON * largest(rows.as_ref(), j)
        }));
        sizes.extend(like.map(|j| own.max(AT_REST * whole) * length(j)));
    }
    Rows { rows, errors, sizes }
}
