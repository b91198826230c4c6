//! Negative springs, which are no fault of coordinates.

use super::doubt::{Doubt, Place};
use super::free::Free;
use super::motions::Motions;
use super::zeros::{Whole, Zeros};
use crate::eigen::zero;
use crate::error::{Error, Result};

/// The motions without energy of a K in which no motion by the coordinates has negative energy.
///
/// Coordinates that are off, by rounding or more, strain K, and that takes positive energy. A motion below zero by more than roundings of K and
/// than what practice takes for free is that of a negative spring, where a count half way to it says so.
///
/// # Errors
/// [`Error::NegativeRigidEnergy`] with the dof that the force is largest at.
pub(super) fn zeros_unless_negative(
    motions: &Motions<'_>,
    (doubts, free): (&[Doubt], &[Free]),
    whole: &Whole<'_>,
) -> Result<Zeros> {
    let zeros = whole.zeros()?;
    for doubt in doubts {
        let Some([energy, noise]) = free[doubt.body].below_zero else { continue };
        if zero::is_negligible(energy, zeros.first_elastic(0)) {
            continue;
        }
        let count = whole.counted_below(0.5 * energy)?;
        if count > 0 {
            let rotations: Vec<usize> = doubt.costly.iter().map(|costly| costly.rotation).collect();
            let Place { at, .. } = Place::of(motions, &motions.bodies[doubt.body].rows, &rotations);
            return Err(Error::NegativeRigidEnergy { energy, noise, count, at: Some(at) });
        }
    }
    Ok(zeros)
}
