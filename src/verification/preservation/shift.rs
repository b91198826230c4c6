//! The shift that spectral forms are accurate about.

use crate::verification::evidence::Evidence;

/// A shift near the lowest elastic eigenvalue, which spectral forms are accurate about.
pub(super) fn shift(evidence: &Evidence<'_>) -> f64 {
    let (k, m) = (&evidence.reduction.stiffness, &evidence.reduction.mass);
    let ratios = (0..k.nrows()).filter(|i| k[(*i, *i)] > 0.0 && m[(*i, *i)] > 0.0).map(|i| k[(i, i)] / m[(i, i)]);
    let of_diagonal = || ratios.fold(f64::INFINITY, f64::min);
    let lowest = evidence.retained.modes.lambda.first().copied().unwrap_or_else(of_diagonal);
    if lowest > 0.0 && lowest.is_finite() { lowest } else { 1.0 }
}
