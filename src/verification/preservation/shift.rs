//! The shift that spectral forms are accurate about.

use crate::error::Result;
use crate::verification::evidence::Evidence;

/// A shift near the lowest elastic eigenvalue, which spectral forms are accurate about.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn shift(evidence: &Evidence<'_>) -> Result<f64> {
    let lowest = match evidence.retained.modes.lambda.first() {
        Some(lowest) => Some(*lowest),
        None => evidence.reduction.elastic_scale()?,
    };
    Ok(lowest.filter(|lowest| *lowest > 0.0 && lowest.is_finite()).unwrap_or(1.0))
}
