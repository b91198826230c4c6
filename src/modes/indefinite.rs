//! The count at the lower end of the spectrum: nothing lies below zero.
//!
//! Cholesky factorisation of K_II at shift zero is a count of its own: it ends with positive pivots only where K_II has no
//! eigenvalue below zero. With the interface free, the eigenvalues of K below zero are those of K_II and those of
//! S = K_BB + K_BI Ψ_S (Haynsworth 1968), a matrix of the order of the interface. So the factor that the reduction needs
//! anyway counts both boundaries at the lower end, and the zero modes are counted by the rank of U_B, which S U_B = 0 holds.

use faer::{Mat, Side};

use super::Component;
use crate::dense;
use crate::error::{Error, Result};
use crate::sparse::diagonal;

/// Roundings that an eigenvalue of S may be made of, in units of ε and of the precision of the data times the terms of S.
const ROUNDINGS: f64 = 100.0;

/// Refuses a stiffness that has negative eigenvalues with the interface free.
///
/// # Errors
/// [`Error::IndefiniteStiffness`].
pub(super) fn refuse(component: Component<'_>) -> Result<()> {
    // Where the interface holds nothing, a factor below zero says it while the modes are looked for.
    let Component { partition, constraint: Some(constraint), .. } = component else { return Ok(()) };
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let uncondensed = diagonal(&partition.stiffness).split_off(n_i);
    let scale: Vec<f64> = uncondensed.into_iter().map(dense::power_of_two_root).collect();
    let scaled = Mat::from_fn(n_b, n_b, |i, j| constraint.stiffness[(i, j)] * scale[i] * scale[j]);
    // In these scales the terms of S are at most `cancellation`, and rounding of S is that times the precision of the data.
    let precision = partition.precision.stiffness.share + f64::EPSILON;
    let rounding = ROUNDINGS * precision * constraint.cancellation * partition.cancellation;
    // A Cholesky factorisation costs a tenth of the eigenvalues, and nearly every S passes it.
    let lifted = Mat::from_fn(n_b, n_b, |i, j| scaled[(i, j)] + if i == j { rounding } else { 0.0 });
    if lifted.llt(Side::Lower).is_ok() {
        return Ok(());
    }
    let (eigenvalues, _) = dense::symmetric_eigen(scaled.as_ref())?;
    match eigenvalues.iter().filter(|value| **value < -rounding).count() {
        0 => Ok(()),
        count => Err(Error::IndefiniteStiffness { count, boundary: "free" }),
    }
}
