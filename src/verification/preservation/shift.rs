//! The shift that spectral forms are accurate about.

use crate::eigen::lowest_ratio;
use crate::verification::evidence::Evidence;

/// A shift near the lowest elastic eigenvalue, which spectral forms are accurate about.
pub(super) fn shift(evidence: &Evidence<'_>) -> f64 {
    let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
    let lowest = evidence.retained.modes.lambda.first().copied().or_else(|| lowest_ratio(k, m));
    lowest.filter(|lowest| *lowest > 0.0 && lowest.is_finite()).unwrap_or(1.0)
}
