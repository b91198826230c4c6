//! Residual vectors: the static answers of the interior to the loads of the job.
//!
//! ```text
//! y = K_II⁻¹ f_I    n_I × 1    the answer while the interface is held
//! ```
//! Under a load f the full model takes the displacements u_I = Ψ_S u_B + y, and the interface carries f_B + Ψ_Sᵀ f_I: with y among the
//! columns of Ψ_D the static answer of the reduced model is exact, whatever the boundary of its modes. Residual vectors come after the
//! modes, so that these keep their shapes: a residual vector is replaced by what it adds to them, which is the residual flexibility
//! of the load.
//!
//! What the other columns lack of an answer is an energy. Length in the mass does not tell it: what is left of y may be as short as rounding
//! and as stiff as the highest mode. The reduced answer is the best in energy of all combinations of the columns, so that it lacks no more
//! than the remainder of any of them:
//!
//! ```text
//! y⊥ = y − Ψ_D Ψ_Dᵀ M_II y        ‖y − Ψ_D η‖_K ≤ ‖y⊥‖_K
//! ```
//! Inertia-relief modes are the answers to unit accelerations, and are judged like them: next to a heavy mass the answers to rotations have
//! nearly the shape of those to translations, and what they add is all that an angular acceleration does to the rest of the component.
//!
//! A residual vector is left out where y⊥ has no more than [`ANSWERED`] of the energy of y, as a ratio of lengths, or no more than its solve
//! lacks. M-27 asks no more than that of the columns that are left.

use faer::{Mat, MatRef};

use super::basis::Basis;
use super::dynamic::{DynamicColumns, DynamicCoordinate};
use crate::constraint::ConstraintModes;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::rows_with_mass;
use crate::factor::SolveOperator;
use crate::modes::Component;
use crate::sparse::{absolute_energy, product};

/// ‖u − Ψ_D η‖_K / ‖u‖_K up to which columns answer a load: what M-27 asks of a load with a residual vector, kept or not.
pub(crate) const ANSWERED: f64 = 1e-9;
/// Share of a length, in the mass, that is rounding alone.
const ROUNDING: f64 = NOISE_FACTOR * f64::EPSILON;

/// y of every load of the job, n_I × n_l; none for a free component without interface, which nothing holds while it answers.
pub fn static_answers(component: Component<'_>, constraint: &ConstraintModes) -> Option<Mat<f64>> {
    let Component { partition, factor, .. } = component;
    // Nothing holds it either where the interface leaves rigid-body motions free.
    if component.is_modal() || constraint.attachment.is_some() {
        return None;
    }
    let mut answers = partition.loads.vectors.as_ref().subrows(0, partition.n_internal).to_owned();
    // A load on the interface alone leaves the interior at rest while the interface is held.
    let inside: Vec<usize> = (0..partition.loads.count()).filter(|load| partition.loads.acts_inside(*load)).collect();
    let mut solved = dense::columns(answers.as_ref(), &inside);
    factor.solve_in_place(solved.as_mut());
    for (at, load) in inside.into_iter().enumerate() {
        answers.as_mut().col_mut(load).copy_from(solved.as_ref().col(at));
    }
    Some(answers)
}

impl DynamicColumns {
    /// These columns, then the residual vectors of the loads that ask for one, of the static answers to all; none where nothing answers.
    #[must_use]
    pub fn with_answers(self, component: Component<'_>, answers: Option<&Mat<f64>>) -> Self {
        let loads = &component.partition.loads;
        let asked: Vec<usize> = (0..loads.count()).filter(|load| loads.facts[*load].has_residual_vector).collect();
        let Some(answers) = answers.filter(|_| !asked.is_empty()) else { return self };
        self.followed_by(Self {
            columns: dense::columns(answers.as_ref(), &asked),
            coordinates: asked.into_iter().map(DynamicCoordinate::ResidualVector).collect(),
        })
    }
}

impl<'a> Basis<'a> {
    /// As [`Self::new`], but for residual vectors and inertia relief: one that the others miss in energy is kept, however little of its
    /// length is left.
    pub fn answering(component: Component<'_>, constraint: &ConstraintModes<'a>, columns: &DynamicColumns) -> Self {
        let mass = component.partition.internal().mass;
        let mut asked: Vec<usize> = Vec::new();
        loop {
            let basis = Self::keeping(constraint, columns, (mass, &asked));
            if constraint.attachment.is_some() {
                return basis;
            }
            let missed: Vec<usize> = missed_answers(component, columns, &basis)
                .into_iter()
                .filter(|column| !asked.contains(column))
                .collect();
            if missed.is_empty() {
                return basis;
            }
            asked.extend(missed);
        }
    }
}

/// Numbers, among the named columns, of the static answers that were left out although the basis misses what they answer.
fn missed_answers(component: Component<'_>, columns: &DynamicColumns, basis: &Basis<'_>) -> Vec<usize> {
    let mass = component.partition.internal().mass;
    // Columns that span the whole interior miss nothing that has mass, and no further one is orthogonal to them.
    if basis.dropped.is_empty() || basis.n_dynamic() == rows_with_mass(mass) {
        return Vec::new();
    }
    let Component { partition, rigid, .. } = component;
    let is_missed = |column: &usize| {
        let load = match columns.coordinates[*column] {
            DynamicCoordinate::ResidualVector(load) => partition.loads.vectors.as_ref().subcols(load, 1).to_owned(),
            DynamicCoordinate::InertiaRelief(motion) => {
                product(&partition.mass, rigid.modes.as_ref().subcols(motion, 1))
            }
            _ => return false,
        };
        let load = load.as_ref().subrows(0, partition.n_internal);
        let answer = columns.columns.as_ref().subcols(*column, 1);
        is_missed(component, (load, answer), basis.dynamic_modes.as_ref())
    };
    (0..columns.coordinates.len()).filter(|column| !basis.kept.contains(column)).filter(is_missed).collect()
}

/// Whether what is left of the answer y to a load, without its parts along M-orthonormal columns, is more than its own error.
fn is_missed(component: Component<'_>, (load, y): (MatRef<'_, f64>, MatRef<'_, f64>), basis: MatRef<'_, f64>) -> bool {
    let pencil = component.partition.internal();
    let length = |x: MatRef<'_, f64>, image: MatRef<'_, f64>| {
        dense::dot(dense::column(x, 0), dense::column(image, 0)).max(0.0).sqrt()
    };
    let in_mass = |x: MatRef<'_, f64>| length(x, product(pencil.mass, x).as_ref());
    let in_energy = |x: MatRef<'_, f64>| length(x, product(pencil.stiffness, x).as_ref());
    let mut left = y.to_owned();
    for _ in 0..2 {
        let parts = dense::gram(basis, product(pencil.mass, left.as_ref()).as_ref());
        dense::add_product(left.as_mut(), -1.0, basis, parts.as_ref());
    }
    // What a solve lacks, K_II⁻¹ (f − K_II y), and the rounding of the entries.
    let mut lacking = load.to_owned();
    lacking -= product(pencil.stiffness, y);
    component.factor.solve_in_place(lacking.as_mut());
    let rounding = f64::EPSILON * absolute_energy(pencil.stiffness, y)[0].sqrt();
    let error = in_energy(lacking.as_ref()) + rounding;
    in_energy(left.as_ref()) > (ANSWERED * in_energy(y)).max(NOISE_FACTOR * error)
        && in_mass(left.as_ref()) > ROUNDING * in_mass(y)
}
