//! The certificate that no mode is missing.

use super::{Boundary, Component, Modes, Retained, SEED, retained};
use crate::error::{Error, Result};
use crate::factor::{Analysis, InertiaCount, count_below};
use crate::job::{Certify, Job};
use crate::partition::Partition;

/// A Sturm count above the highest mode, against what was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// The count.
    pub count: InertiaCount,
    /// Eigenvalues below the shift under the modes' own boundary.
    pub n_counted: usize,
    /// Modes found below it, rigid-body modes included.
    pub n_found: usize,
    /// Factorisations it took.
    pub n_factorisations: usize,
}

impl Certificate {
    /// True where every mode below the shift was found.
    pub fn holds(&self) -> bool {
        self.n_counted == self.n_found
    }
}

/// Where in the gap above the highest mode the count is taken: the middle, unless that is an eigenvalue itself.
const PLACES: [f64; 3] = [0.5, 0.375, 0.625];
/// Below this relative size an eigenvalue of S(σ) is rounding, and σ too near an eigenvalue.
const SCHUR_GAP: f64 = 1e-12;

/// Certifies the modes by a Sturm count; modes that are missing are looked for once more from another start.
///
/// # Errors
/// [`Error::ModesMissing`] where the second search finds no more; the count's own errors.
pub fn certified(
    component: Component<'_>,
    analysis: &Analysis,
    job: &Job,
    found: Retained,
) -> Result<(Retained, Option<Certificate>)> {
    if job.run.certify == Certify::None {
        return Ok((found, None));
    }
    let n_rigid = component.rigid.count();
    let count = |found: &Retained| certify(component.partition, analysis, &found.modes, found.boundary, n_rigid);
    let first = count(&found)?;
    if first.holds() {
        return Ok((found, Some(first)));
    }
    let again = retained(component, &job.reduction, SEED + 1)?;
    let second = count(&again)?;
    if second.holds() {
        let n_factorisations = first.n_factorisations + second.n_factorisations;
        return Ok((again, Some(Certificate { n_factorisations, ..second })));
    }
    let unit = component.partition.scaling.eigenvalue_unit();
    Err(Error::ModesMissing {
        below_hz: (second.count.sigma * unit).max(0.0).sqrt() / std::f64::consts::TAU,
        found: second.n_found,
        counted: second.n_counted,
    })
}

/// Counts the eigenvalues in the gap above the highest mode.
///
/// # Errors
/// Every shift tried lies on an eigenvalue; no memory for the factor.
fn certify(
    partition: &Partition,
    analysis: &Analysis,
    modes: &Modes,
    boundary: Boundary,
    n_rigid: usize,
) -> Result<Certificate> {
    let mut last = Err(Error::SturmPivot { step: 0 });
    for (attempt, place) in PLACES.into_iter().enumerate() {
        last = count_below(partition, analysis, modes.shift_above(place));
        let Ok(count) = last else { continue };
        let (n_counted, n_found) = match boundary {
            Boundary::FreeInterface => (count.free, modes.count() + n_rigid),
            Boundary::FixedInterface => (count.clamped, modes.count()),
        };
        if boundary == Boundary::FixedInterface || count.schur_gap > SCHUR_GAP {
            return Ok(Certificate { count, n_counted, n_found, n_factorisations: attempt + 1 });
        }
    }
    last.and(Err(Error::SturmPivot { step: partition.n_internal }))
}
