//! Eigenvalues in scaled units and frequencies in Hz.

use crate::verification::evidence::Evidence;

/// The frequency of an eigenvalue in scaled units, in Hz; that of a negative one is negative.
pub(super) fn hertz(evidence: &Evidence<'_>, lambda: f64) -> f64 {
    let unit = evidence.partition.scaling.eigenvalue_unit();
    (lambda * unit).abs().sqrt().copysign(lambda) / std::f64::consts::TAU
}

/// The eigenvalue of a frequency, in scaled units.
pub(super) fn eigenvalue(evidence: &Evidence<'_>, frequency_hz: f64) -> f64 {
    let omega = std::f64::consts::TAU * frequency_hz;
    omega * omega / evidence.partition.scaling.eigenvalue_unit()
}

/// A shift near the lowest elastic eigenvalue, which spectral forms are accurate about.
pub(super) fn shift(evidence: &Evidence<'_>) -> f64 {
    let (k, m) = (&evidence.reduction.stiffness, &evidence.reduction.mass);
    let ratios = (0..k.nrows()).filter(|i| k[(*i, *i)] > 0.0 && m[(*i, *i)] > 0.0).map(|i| k[(i, i)] / m[(i, i)]);
    let of_diagonal = || ratios.fold(f64::INFINITY, f64::min);
    let lowest = evidence.retained.modes.lambda.first().copied().unwrap_or_else(of_diagonal);
    if lowest > 0.0 && lowest.is_finite() { lowest } else { 1.0 }
}
