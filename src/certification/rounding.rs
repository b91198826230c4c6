//! What the digits of a result and of the matrices leave open.

use std::ops::Range;

use super::angles::AmongKnown;
use super::claims::Claims;
use super::independence::Standing;
use super::measured::Measured;

/// Relative difference of a frequency that no digits excuse, and energy of rigid-body motion relative to the first elastic one that they
/// excuse without a warning.
pub(super) const MOST_OF_DIGITS: f64 = 1e-2;

/// What the shape of a pair leaves open.
#[derive(Clone, Copy)]
pub(super) struct OfShape {
    /// Of an eigenvalue, by the force that is left over, relative to it.
    pub(super) residual_bar: f64,
    /// Of its frequency, by its digits.
    pub(super) of_digits: f64,
    /// Whether it is its mode but for the rounding of its digits.
    pub(super) is_rounded: bool,
}

/// Whether the shape of a pair is a mode, or rigid-body motion, as far as its digits tell: no farther from it than what they round, in the
/// norm of M. Where the modes of a cluster were taken from the shape itself, what it has of other known ones and the force that it leaves
/// over are held against that: of a rounding δx the latter is ‖δx‖ in the norm of K − σM at most.
pub(super) fn is_rounded_mode(
    (claims, measured): (&Claims, &Measured),
    known: Option<&AmongKnown>,
    (claim, standing, cluster): (usize, Standing, Option<&Range<usize>>),
) -> bool {
    if claims.shape_rounding[claim] <= f64::EPSILON {
        return false;
    }
    let rounded = claims.rounded[claim];
    match (standing, cluster, known) {
        (Standing::Rigid, ..) => (1.0 - measured.rigid_share(claim)).max(0.0).sqrt() <= rounded,
        (Standing::Kept, Some(cluster), Some(known)) => {
            let of_others = known.of_others(claim, cluster).hypot(measured.rigid_share(claim).max(0.0).sqrt());
            of_others <= rounded && measured.lacking[claim] <= of_rounding(claims, measured, claim).max(rounded)
        }
        (Standing::None, Some(cluster), Some(known)) => known.outside(claim, cluster) <= rounded,
        _ => false,
    }
}

/// What the digits of K and M leave open of the frequency of a shape, relative to it, up to what no digits excuse.
pub(super) fn of_digits_in_frequency(measured: &Measured, claim: usize) -> f64 {
    let bar = 0.5 * measured.errors[claim].data_bar;
    if bar.is_nan() { 0.0 } else { bar.min(MOST_OF_DIGITS) }
}

/// Length of what the digits of a shape round, relative to it, in the norm of K: δxᵀKδx ≤ u² |x|ᵀ|K||x|.
pub(super) fn of_rounding(claims: &Claims, measured: &Measured, claim: usize) -> f64 {
    let rounding = claims.shape_rounding[claim];
    if rounding > f64::EPSILON { rounding * measured.errors[claim].cancellation.sqrt() } else { 0.0 }
}

/// What they leave open of its frequency, relative to it: the quotient is off by the square of that length at most, and δ²/γ, the bar of
/// its residual, by that over γ; of a root it is half.
pub(super) fn of_digits_of_shape(claims: &Claims, measured: &Measured, (claim, gap): (usize, f64)) -> f64 {
    let share = 0.5 * of_rounding(claims, measured, claim).powi(2) * (1.0 + 1.0 / gap);
    if share.is_nan() { 0.0 } else { share }
}

/// What they leave open of the energy of a shape, relative to the first elastic mode.
pub(super) fn of_digits_in_energy(measured: &Measured, claim: usize, first: f64) -> f64 {
    let bar = measured.errors[claim].data_bar * (measured.lambda[claim] / first).abs();
    if bar.is_nan() { 0.0 } else { bar }
}
