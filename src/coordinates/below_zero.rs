//! Negative springs, which are no fault of coordinates.

use super::doubt::{Doubt, Place};
use super::free::Free;
use super::motions::Motions;
use super::zeros::{Whole, Zeros};
use crate::eigen::zero;
use crate::error::{Error, Result};

/// The motions without energy, where nothing is below zero. Coordinates that are off, by rounding or more, strain K: what that costs is above zero. A motion below zero by more than roundings of K
/// and than what practice takes for free is a negative spring, where a count half way to it says so.
///
/// # Errors
/// [`Error::NegativeRigidEnergy`] with the dof that the force is largest at.
pub(super) fn refused(motions: &Motions<'_>, (doubts, free): (&[Doubt], &[Free]), whole: &Whole<'_>) -> Result<Zeros> {
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
