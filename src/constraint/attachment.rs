//! Rubin's static modes where K_II is singular: an interface that leaves rigid-body motions of the component free.
//!
//! ```text
//! A    n' × n_B   inertia-relief attachment modes (40): answers to unit loads at the interface and the inertia that these set free,
//!                 without rigid-body motion
//! Ψ_R  n_I × n_B  A_I A_B⁻¹ (41), in the place of constraint modes
//! ```
//! Constraint modes do not exist there: with the interface at rest the component is still free to move. Loads on a free component
//! always have an answer.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use crate::dense;
use crate::error::{Error, Result};
use crate::partition::Partition;

/// ε κ(A_B) above which Ψ_R is refused: half the digits of a double are left of it there.
const LARGEST_ERROR: f64 = 1e-6;

/// Answers of a free component to loads.
#[derive(Clone, Debug)]
pub struct Attachment {
    /// A, n' × n_B.
    pub modes: Mat<f64>,
    /// Answers to the loads of the job, n' × n_l.
    pub of_loads: Mat<f64>,
    /// κ(A_B) with unit diagonal.
    pub condition: f64,
}

impl Attachment {
    /// The answers with the condition of those to unit loads at the interface.
    ///
    /// # Errors
    /// [`Error::AttachmentCondition`]; a dense eigenproblem that does not converge.
    pub fn new(partition: &Partition, modes: Mat<f64>, of_loads: Mat<f64>) -> Result<Self> {
        let (scaled, _) = dense::unit_diagonal(interface_rows(partition, &modes).as_ref());
        let (values, _) = dense::symmetric_eigen(scaled.as_ref())?;
        let (least, most) = (values.first().copied().unwrap_or(1.0), values.last().copied().unwrap_or(1.0));
        let condition = if least > 0.0 { most / least } else { f64::INFINITY };
        if f64::EPSILON * condition > LARGEST_ERROR || !condition.is_finite() {
            return Err(Error::AttachmentCondition { condition, error: LARGEST_ERROR });
        }
        Ok(Self { modes, of_loads, condition })
    }

    /// A_B⁻¹, n_B × n_B.
    ///
    /// # Errors
    /// [`Error::AttachmentCondition`].
    pub(super) fn inverse(&self, partition: &Partition) -> Result<Mat<f64>> {
        let n_b = partition.n_interface();
        let (scaled, scale) = dense::unit_diagonal(interface_rows(partition, &self.modes).as_ref());
        let refused = |_| Error::AttachmentCondition { condition: self.condition, error: LARGEST_ERROR };
        let inverse = scaled.llt(Side::Lower).map_err(refused)?.solve(&Mat::<f64>::identity(n_b, n_b));
        Ok(Mat::from_fn(n_b, n_b, |i, j| inverse[(i, j)] * scale[i] * scale[j]))
    }
}

/// A_B, n_B × n_B.
fn interface_rows(partition: &Partition, modes: &Mat<f64>) -> Mat<f64> {
    let mut rows = modes.as_ref().subrows(partition.n_internal, partition.n_interface()).to_owned();
    dense::symmetrise(&mut rows);
    rows
}
