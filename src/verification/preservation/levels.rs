//! The eigenvalues of the full model under a boundary, as a cache has them.
//!
//! An entry serves the comparison that made it, to the bit. Where the count agreed with what was found, a second entry names it under the key
//! of its boundary, and a comparison over less of the spectrum takes its part of it.

use faer::Mat;

use super::boundary::Boundary;
use super::outcome::BoundaryCount;
use crate::cache::{Cache, Digest, Key, Kind, Reader, Recorded, Writer};
use crate::eigen::{ModeError, Modes};
use crate::factor::Storage;
use crate::random::SEED;
use crate::reduction::panel_of;
use crate::verification::evidence::Evidence;

/// Elastic eigenvalues up to the end of a band, with the motions that the support lets pass.
#[derive(Clone, Debug)]
pub(super) struct Levels {
    /// Ascending.
    pub(super) lambda: Vec<f64>,
    /// What is known of the error of each.
    pub(super) errors: Vec<ModeError>,
    /// The next eigenvalue above, where there is one.
    pub(super) next: Option<f64>,
    /// The rigid-body motions that the support lets pass, in the reduced coordinates that are not held; orthonormal in the mass of the
    /// component with its load.
    pub(super) passing: Mat<f64>,
}

impl Levels {
    /// Of the modes up to a limit.
    pub(super) fn up_to(limit: f64, found: &Modes, passing: Mat<f64>) -> Self {
        let Modes { lambda, errors, next, .. } = found;
        Self { lambda: lambda.clone(), errors: errors.clone(), next: *next, passing }.cut(limit)
    }

    /// Those up to a lower limit.
    fn cut(mut self, limit: f64) -> Self {
        let n_found = self.lambda.iter().take_while(|lambda| **lambda <= limit).count();
        self.next = self.lambda.get(n_found).copied().or(self.next);
        self.lambda.truncate(n_found);
        self.errors.truncate(n_found);
        self
    }
}

impl Recorded for Levels {
    const KIND: Kind = Kind::Modes;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { lambda, errors, next, passing } = self;
        to.array(lambda)?;
        to.array(&errors.iter().flat_map(ModeError::numbers).collect::<Vec<f64>>())?;
        to.array(next.as_slice())?;
        to.columns(passing.as_ref())
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let lambda: Vec<f64> = from.array()?;
        let errors: Vec<f64> = from.array()?;
        let (errors, rest) = errors.as_chunks();
        let errors: Vec<ModeError> = errors.iter().map(ModeError::of_numbers).collect();
        let (next, passing) = (from.at_most_one()?, from.columns()?);
        (rest.is_empty() && errors.len() == lambda.len()).then_some(Self { lambda, errors, next, passing })
    }
}

/// Levels that are all there are up to a limit.
struct CountedLevels {
    entry: Digest,
    limit: f64,
    count: BoundaryCount,
}

impl Recorded for CountedLevels {
    const KIND: Kind = Kind::Band;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { entry, limit, count: BoundaryCount { below_hz, n_counted, n_found } } = self;
        to.array(entry)?;
        to.array(&[*limit, *below_hz])?;
        to.counts(&[*n_counted, *n_found])
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let entry = from.digest()?;
        let [limit, below_hz] = from.array()?[..] else { return None };
        let [n_counted, n_found] = from.counts()?[..] else { return None };
        Some(Self { entry, limit, count: BoundaryCount { below_hz, n_counted, n_found } })
    }
}

/// Where the levels of a boundary are kept.
#[derive(Clone, Debug)]
pub(super) struct Place {
    cache: Cache,
    /// The key of the levels up to one limit from one start.
    pub(super) own: Key,
    /// The key of the boundary.
    boundary: Key,
    limit: f64,
    /// The limit up to which earlier runs have counted.
    reach: Option<f64>,
}

impl Place {
    /// The place of the levels up to a limit from the start vectors of a seed; none without a cache, or where what the refinement of a
    /// factor in single precision took is part of the report.
    pub(super) fn of(evidence: &Evidence<'_>, boundary: &Boundary, (limit, seed): (f64, u64)) -> Option<Self> {
        let cache = evidence.partition.cache().filter(|_| evidence.factor.storage() == Storage::Double)?;
        let mut key = evidence.constraint.key(evidence.rigid.key(evidence.partition.key("supported levels")));
        key = key.shown(&boundary.held).numbers(&boundary.load).numbers(&boundary.springs);
        if !evidence.is_held() {
            // Motions that pass are found by the reduced mass then.
            let columns = panel_of(evidence.basis, 0..evidence.basis.n_reduced());
            key = key.columns(columns.as_ref()).columns(evidence.reduction.mass.as_ref());
        }
        let own = key.clone().numbers(&[limit]).numbers(&[seed]);
        let own = match boundary.is_own(evidence) && seed == SEED {
            true => own.numbers(&evidence.retained.modes.lambda),
            false => own,
        };
        Some(Self { cache: cache.clone(), own, boundary: key.text("counted"), limit, reach: None })
    }

    /// What an earlier run has counted further than it is asked for now, with its count; none where a run has looked for the same.
    pub(super) fn counted_further(&mut self) -> Option<(Levels, BoundaryCount)> {
        let counted: CountedLevels = self.cache.of_earlier_run(&self.boundary.digest())?;
        self.reach = Some(counted.limit);
        if counted.limit < self.limit || self.cache.has(Kind::Modes, &self.own.digest()) {
            return None;
        }
        let levels: Levels = self.cache.of_earlier_run(&counted.entry)?;
        let n_found = levels.lambda.len() + levels.passing.ncols();
        let is_counted = [n_found, counted.count.n_counted] == [counted.count.n_found; 2] && levels.lambda.is_sorted();
        is_counted.then(|| {
            self.cache.part_was_taken();
            (levels.cut(self.limit), counted.count)
        })
    }

    /// The levels that `make` makes, or that it made in an earlier run.
    ///
    /// # Errors
    /// What `make` refuses.
    pub(super) fn recalled(&self, make: impl FnOnce() -> crate::error::Result<Levels>) -> crate::error::Result<Levels> {
        self.cache.recall((Kind::Modes, &self.own), Levels::read, make, Levels::write)
    }

    /// Names the levels for comparisons over less, where a count below σ agrees with them and they reach further than what is there.
    pub(super) fn keep(&self, sigma: f64, count: BoundaryCount) {
        // A count below the limit says nothing of what is above it.
        let limit = self.limit.min(sigma);
        if count.n_counted == count.n_found && self.reach.is_none_or(|reach| reach < limit) {
            self.cache.replace(&self.boundary, &CountedLevels { entry: self.own.digest(), limit, count });
        }
    }
}
