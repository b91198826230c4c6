//! The reduced model cut down to its leading coordinates.

use faer::Mat;

use super::super::evidence::Evidence;
use crate::error::Result;

/// K̂ and M̂ of the leading `n` coordinates.
///
/// # Errors
/// A modal mass that cannot be cut down.
pub(super) fn leading(evidence: &Evidence<'_>, n: usize) -> Result<(Mat<f64>, Mat<f64>)> {
    let reduction = evidence.reduction;
    let part = |a: &Mat<f64>| a.submatrix(0, 0, n, n).to_owned();
    let smaller = reduction.modal_mass.as_ref().filter(|_| n < reduction.n_reduced());
    let mass = smaller.map(|modal| modal.of_leading(n)).transpose()?;
    Ok((part(&reduction.stiffness), mass.unwrap_or_else(|| part(&reduction.mass))))
}
