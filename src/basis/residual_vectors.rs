//! Residual vectors: the static answers of the interior to the loads of the job.
//!
//! ```text
//! y = K_II⁻¹ f_I    n_I × 1    the answer while the interface is held
//! ```
//! Under a load f the full model takes the displacements u_I = Ψ_S u_B + y, and the interface carries f_B + Ψ_Sᵀ f_I: with y among the
//! columns of Ψ_D the static answer of the reduced model is exact, whatever the boundary of its modes. Residual vectors come after the
//! modes, so that these keep their shapes: a residual vector is replaced by what it adds to them, which is the residual flexibility
//! of the load.

use faer::Mat;

use super::dynamic::{DynamicColumns, DynamicCoordinate};
use crate::dense;
use crate::factor::SolveOperator;
use crate::modes::Component;

/// y of every load of the job, n_I × n_l; none for a free component without interface, which nothing holds while it answers.
pub fn static_answers(component: Component<'_>) -> Option<Mat<f64>> {
    let Component { partition, factor, .. } = component;
    if component.is_modal() {
        return None;
    }
    let mut answers = partition.loads.vectors.as_ref().subrows(0, partition.n_internal).to_owned();
    if answers.ncols() > 0 {
        factor.solve_in_place(answers.as_mut());
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
