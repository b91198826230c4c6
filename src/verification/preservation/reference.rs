//! The full model under one boundary of the scene.

use faer::Mat;

use super::boundary::Boundary;
use super::full::Supported;
use super::levels::{Levels, Place};
use super::outcome::BoundaryCount;
use crate::dense;
use crate::eigen::ModeError;
use crate::error::Result;
use crate::number::scientific;
use crate::random::SEED;
use crate::verification::evidence::Evidence;

/// How far roundings of one sign may exceed their typical sum.
pub(super) const ROUNDINGS: f64 = 10.0;
/// Backward error of a pair beyond which it is not accepted, unless the digits of the data explain it: half the digits are gone.
const NOT_SOLVED: f64 = 1e-8;

/// The full model's answer under one boundary.
#[derive(Clone, Debug)]
pub(super) struct Reference {
    pub(super) boundary: Boundary,
    /// Elastic eigenvalues up to the end of the band, ascending.
    pub(super) lambda: Vec<f64>,
    /// What is known of the error of each.
    pub(super) errors: Vec<ModeError>,
    /// The next eigenvalue above, where there is one.
    pub(super) next: Option<f64>,
    /// The rigid-body motions that the support lets pass, in the first coordinates that are not held; orthonormal in the mass of the
    /// component with its load.
    passing: Mat<f64>,
    /// Where a cache keeps what was found, until it is counted.
    place: Option<Place>,
    /// The Sturm count, where one was made.
    pub(super) count: Option<BoundaryCount>,
}

impl Reference {
    /// The full model up to `limit`; the retained modes where they are the answer already and `seed` is the first. What an earlier run has
    /// counted further comes with that count.
    ///
    /// # Errors
    /// The eigensolver does not converge; no memory.
    pub(super) fn new(evidence: &Evidence<'_>, boundary: Boundary, limit: f64, seed: u64) -> Result<Self> {
        let mut place = Place::of(evidence, &boundary, (limit, seed));
        if let Some((levels, count)) = place.as_mut().and_then(Place::counted_further) {
            return Ok(Self { count: Some(count), ..Self::of(boundary, levels, None) });
        }
        let found = || Self::found(evidence, &boundary, (limit, seed));
        let levels = match &place {
            Some(place) => place.recalled(found)?,
            None => found()?,
        };
        Ok(Self::of(boundary, levels, place))
    }

    fn of(boundary: Boundary, levels: Levels, place: Option<Place>) -> Self {
        let Levels { lambda, errors, next, passing } = levels;
        Self { boundary, lambda, errors, next, passing, place, count: None }
    }

    fn found(evidence: &Evidence<'_>, boundary: &Boundary, (limit, seed): (f64, u64)) -> Result<Levels> {
        let modes = &evidence.retained.modes;
        let is_covered = match (modes.next, modes.searched_to) {
            (Some(next), _) => next > limit,
            (None, Some(searched_to)) => searched_to >= limit,
            (None, None) => true,
        };
        let supported = Supported::new(evidence, boundary)?;
        let found = if boundary.is_own(evidence) && is_covered && seed == SEED {
            modes
        } else {
            &supported.modes_up_to(evidence, limit, seed)?
        };
        Ok(Levels::up_to(limit, found, supported.passing(evidence)))
    }

    /// Takes a count, and names what was found for later runs where it agrees.
    pub(super) fn counted(&mut self, evidence: &Evidence<'_>, count: Option<BoundaryCount>) {
        self.count = count;
        if let (Some(place), Some(count)) = (&self.place, count) {
            place.keep(evidence.partition.scaling.eigenvalue(count.below_hz), count);
        }
    }

    /// Rigid-body motions that the support lets pass.
    pub(super) fn n_zero(&self) -> usize {
        self.passing.ncols()
    }

    /// Rigid-body motions that the support lets pass, in some coordinates of a reduced model of `n_b` interface dofs, `n_free` of which are first
    /// and are not held, n × n_zero.
    pub(super) fn passing_coordinates(&self, kept: &[usize], (n_free, n_b): (usize, usize)) -> Mat<f64> {
        let motions = &self.passing;
        let row = |i: usize| if i < n_free { i } else { n_free + kept[i] - n_b };
        let entry = |i: usize, j: usize| if row(i) < motions.nrows() { motions[(row(i), j)] } else { 0.0 };
        Mat::from_fn(kept.len(), motions.ncols(), entry)
    }

    /// Why the full model was not solved under this boundary well enough to be compared with; the retained modes have M-01
    /// to say so.
    pub(super) fn unsound(&self, evidence: &Evidence<'_>) -> Option<String> {
        let precision = evidence.partition.precision;
        let most = NOT_SOLVED.max(ROUNDINGS * precision.share());
        let backward = dense::worst(self.errors.iter().map(|error| error.backward));
        (!self.boundary.is_own(evidence) && dense::worse(backward, most))
            .then(|| format!("the full model leaves a residual of {} there", scientific(backward, 2)))
    }

    /// What rounding moves an eigenvalue by, in scaled units: that of the mode it moves most.
    pub(super) fn rounding_floor(&self) -> f64 {
        dense::worst(self.errors.iter().map(|error| error.rounding_floor))
    }
}
