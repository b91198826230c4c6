//! Negative eigenvalues of K with the interface free.
//!
//! The eigenvalues of K below zero are those of K_II and those of S = K_BB + K_BI Ψ_S (Haynsworth 1968), a matrix of the order of the
//! interface. Where K_II has a Cholesky factor, S has them all.

use faer::{Mat, Side};

use super::ConstraintModes;
use crate::dense;
use crate::error::Result;
use crate::partition::Partition;
use crate::rigid::{RigidBodyModes, shown_below_zero};
use crate::sparse::diagonal;

/// Roundings that an eigenvalue of S may be made of, in units of ε and of the precision of the data times the terms of S.
const ROUNDINGS: f64 = 100.0;

/// How many eigenvalues of S are negative beyond rounding. The motions that count as rigid have an energy all the same, and one below zero
/// shows what the entries of K are rounded by.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub fn n_negative(partition: &Partition, constraint: &ConstraintModes<'_>, rigid: &RigidBodyModes) -> Result<usize> {
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let uncondensed = diagonal(&partition.stiffness).split_off(n_i);
    let scale: Vec<f64> = uncondensed.into_iter().map(dense::power_of_two_root).collect();
    let scaled = Mat::from_fn(n_b, n_b, |i, j| constraint.stiffness[(i, j)] * scale[i] * scale[j]);
    // In these scales the terms of S are at most `cancellation`, and rounding of S is that times the precision of the data.
    let precision = partition.precision.stiffness.share.max(shown_below_zero(partition, rigid)) + f64::EPSILON;
    let rounding = ROUNDINGS * precision * constraint.cancellation * partition.cancellation;
    // A Cholesky factorisation costs a tenth of the eigenvalues, and nearly every S passes it.
    let lifted = Mat::from_fn(n_b, n_b, |i, j| scaled[(i, j)] + if i == j { rounding } else { 0.0 });
    if lifted.llt(Side::Lower).is_ok() {
        return Ok(0);
    }
    let (eigenvalues, _) = dense::symmetric_eigen(scaled.as_ref())?;
    Ok(eigenvalues.iter().filter(|value| **value < -rounding).count())
}
