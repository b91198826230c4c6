//! How many points a scan of both models between the samples of a response has, and what it costs.

use crate::job::Job;

use super::sizes::Sizes;
use super::work::Work;

/// Steps in the width η f of a resonance or antiresonance. Half a step from its top the response is 1/√(1 + 1/16) of the peak: 0.3 dB.
const STEPS_IN_A_PEAK: f64 = 4.0;
/// Relative distance of points at most, however wide the damping makes a resonance: where responses cancel an error may be far narrower.
pub(crate) const WIDEST_STEP: f64 = 0.02;
/// Points of a scan at most; η below 1/200 needs more over two decades.
const MAX_POINTS: usize = 4096;
/// Points of a scan where its products are large.
const MIN_POINTS: usize = 256;
/// Floating-point operations that a scan may cost: a second of one core.
pub(crate) const MAX_FLOPS: f64 = 1e10;
/// Outputs of the scene that are followed from scan to scan; where there are more, a scan of all of them finds which.
pub(crate) const FOLLOWED: usize = 48;
/// Scans until the largest error is a sample, mostly.
const SCANS: f64 = 2.0;
/// ln of the band where it begins at zero: samples begin at a tenth of the first frequency.
const FROM_ZERO: f64 = 3.5;
/// Operations on each term of a response besides its real and imaginary part, four: the weights of modes, and the comparison.
const BESIDE_OF_A_TERM: f64 = 3.0;

/// Points of a scan over a band, ln(high/low) wide, with a structural damping factor.
pub(crate) fn points(width: f64, eta: f64, flops_of_a_point: f64) -> usize {
    let dear = ((MAX_FLOPS / flops_of_a_point) as usize).max(MIN_POINTS);
    let step = (eta / STEPS_IN_A_PEAK).min(WIDEST_STEP);
    ((width / step).ceil() as usize).clamp(1, MAX_POINTS.min(dear))
}

/// Operations of a point: real and imaginary part of n_B × r times r × n_B of both models, and of as many rows more as there are outputs.
pub(crate) fn flops_of_a_point(n_b: f64, n_both: f64, seen_both: f64) -> f64 {
    4.0 * n_b * (n_b * n_both + seen_both)
}

/// The scans of a response whose full model is known in a space of so many columns.
pub(super) fn scans(job: &Job, sizes: &Sizes, extended: f64) -> Work {
    let default = Default::default();
    let scene = job.scene.as_ref().unwrap_or(&default);
    let width = scene.band_hz.map_or(FROM_ZERO, |[low, high]| if low > 0.0 { (high / low).ln() } else { FROM_ZERO });
    let (n_b, n_both) = (sizes.n_interface, extended + sizes.n_reduced());
    let followed = sizes.n_outputs.min(FOLLOWED as f64);
    let of_a_point = flops_of_a_point(n_b, n_both, followed * n_both);
    let n_points = points(width, 2.0 * scene.damping.unwrap_or_default().ratio, of_a_point.max(1.0)) as f64;
    let of_all = if sizes.n_outputs > followed { flops_of_a_point(n_b, 0.0, sizes.n_outputs * n_both) } else { 0.0 };
    let flops = SCANS * n_points * of_a_point + (SCANS + 1.0) * n_points * of_all;
    Work { dense_flops: BESIDE_OF_A_TERM * flops, ..Work::default() }
}
