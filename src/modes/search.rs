//! The search for the modes of a job: in one go, in slices, or all at once.
//!
//! A band is counted before it is searched, so that it is known what it will take. Up to [`SLICED_FROM`] modes come from
//! one operator at shift zero; more come in slices, each from a shift of its own; most of the spectrum of a small model
//! comes from a dense decomposition. The certificate judges all of them alike.

use super::boundary_problem::BoundaryProblem;
use super::certificate::{Certificate, Mending, certified, judge};
use super::counts::Counts;
use super::earlier::{CertifiedBand, CertifiedModes};
use super::slices::{Band, ModeSource, SLICE, search_between};
use super::{Component, dense_spectrum, indefinite};
use crate::cache::{Cache, Key, Kind, recalled};
use crate::eigen::ElasticCount;
use crate::eigen::{CLUSTER_GAP, ModeRequest, Modes, ShiftInvert, are_left_inexact, elastic_modes};
use crate::eigen::{EigenWork, Interval, Wanted, are_clustered, is_above};
use crate::error::{Error, Result};
use crate::factor::Storage;
use crate::job::{Boundary, Certify, Eigensolver, ModeSelection, ReductionJob};
use crate::partition::Partition;
use crate::random::SEED;

/// More modes than this come in slices. On solids of 30,000 and 91,000 dofs 400 modes take 1.1 times as long in slices as in one
/// go, 800 modes 0.6 and 0.7 times.
pub const SLICED_FROM: usize = 400;

/// What a job asks of the spectrum of a component, and how it is found.
#[derive(Clone, Debug)]
pub struct Search<'a> {
    /// The eigenproblem.
    pub problem: BoundaryProblem<'a>,
    wanted: Wanted,
    /// Modes asked for, were there as many; none for a band.
    n_asked: Option<usize>,
    eigensolver: Eigensolver,
    /// The count at the end of the band, where a band is asked for and its end is off the eigenvalues.
    edge: Option<ElasticCount>,
    /// Slices searched at the same time, at most.
    at_once: usize,
    /// Modes of an earlier run that contain what is asked for.
    earlier: Option<CertifiedModes>,
    /// The shift up to which earlier runs have certified modes.
    reach: Option<f64>,
}

impl<'a> Search<'a> {
    /// Prepares the search: looks at the signs of the spectrum and counts the modes of a band.
    ///
    /// # Errors
    /// The stiffness has negative eigenvalues; no memory for the count; [`Error::ModesUnheld`].
    pub fn new(component: Component<'a>, job: &ReductionJob) -> Result<Self> {
        indefinite::refuse(component)?;
        if component.is_modal() && component.partition.expansion.count() > 0 {
            return Err(Error::ModesUnheld);
        }
        let boundary = component.boundary(job);
        let problem = BoundaryProblem { component, boundary };
        let wanted = mode_wish(job.wanted(), component.partition);
        let n_asked = match job.wanted() {
            ModeSelection::Count { count } => Some(count),
            ModeSelection::UpTo { .. } => None,
        };
        let (eigensolver, nothing) = (job.eigensolver, (None, None));
        let search = Self { problem, wanted, n_asked, eigensolver, edge: None, at_once: 1, earlier: None, reach: None };
        let (reach, earlier) = search.of_earlier_run().unwrap_or(nothing);
        let edge = match wanted {
            Wanted::UpTo(limit) if limit > 0.0 && earlier.is_none() => edge_of(&problem, limit)?,
            _ => None,
        };
        Ok(Self { edge, earlier, reach, ..search })
    }

    /// How far earlier runs have certified modes, and these where they contain what is asked for and no run has looked for the same.
    fn of_earlier_run(&self) -> Option<(Option<f64>, Option<CertifiedModes>)> {
        let cache = self.cache().filter(|_| self.wanted != Wanted::Count(0))?;
        let band: CertifiedBand = cache.of_earlier_run(&self.key_of_boundary().digest())?;
        let reach = Some(band.count.inertia.sigma);
        if cache.has(Kind::Modes, &self.key(SEED).digest()) {
            return Some((reach, None));
        }
        let n = self.problem.modal().mass.rows();
        Some((reach, CertifiedModes::containing(self.wanted, cache, &band, n)))
    }

    /// This search with so many slices at the same time, which changes only its time and its memory.
    pub fn with_slices_at_once(self, at_once: usize) -> Self {
        match self.eigensolver {
            Eigensolver::Lanczos => Self { at_once, ..self },
            // One of its iterations keeps all others waiting.
            Eigensolver::Arpack => self,
        }
    }

    /// The count at the end of the band, where a band is asked for.
    pub fn edge(&self) -> Option<ElasticCount> {
        self.edge
    }

    /// Modes that are going to be found, as far as that is known.
    pub fn n_expected(&self) -> Option<usize> {
        match self.wanted {
            Wanted::Count(count) => Some(count),
            Wanted::UpTo(_) => match &self.earlier {
                Some(earlier) => Some(self.n_asked_of(&earlier.modes.lambda)),
                None => self.edge.map(|edge| edge.n_elastic),
            },
        }
    }

    /// The lowest modes by this search, or what an earlier run found by the same one or by one that reaches further.
    ///
    /// # Errors
    /// What [`ModeSource::lowest`] refuses; a solve that did not come down to rounding.
    pub fn lowest_or_earlier(&self, seed: u64) -> Result<Modes> {
        if let Some(earlier) = &self.earlier {
            self.cache().iter().for_each(|cache| cache.part_was_taken());
            // They took no work of this run.
            return Ok(Modes { work: EigenWork::default(), ..self.asked(earlier.modes.clone()) });
        }
        let factor = self.problem.component.factor;
        recalled(self.cache(), || self.key(seed), || factor.vouched(self.lowest(seed)))
    }

    /// The modes with the certificate that none is missing; see [`certified`]. What an earlier run has certified further up is not counted
    /// again.
    ///
    /// # Errors
    /// As [`certified`].
    pub fn certified(&self, found: Modes, certify: Certify) -> Result<(Modes, Option<Certificate>)> {
        if let Some(CertifiedModes { modes, count }) = &self.earlier {
            let certificate = (certify != Certify::None).then(|| judge((&self.problem, self), modes, *count));
            return Ok((found, certificate));
        }
        let (found, certificate) = certified(self, &self.problem, found, self.edge, certify)?;
        if let (Some(cache), Some(certificate)) = (self.cache(), &certificate) {
            self.keep(cache, &found, certificate);
        }
        Ok((found, certificate))
    }

    /// Names the modes of this search for searches that ask for less, where the certificate leaves no doubt.
    fn keep(&self, cache: &Cache, found: &Modes, certificate: &Certificate) {
        let is_sound = self.wanted != Wanted::Count(0)
            && certificate.holds()
            && certificate.doubt() <= 1.0
            && certificate.mending == Mending::None;
        let count = ElasticCount { inertia: certificate.count, n_elastic: found.count() };
        if is_sound && certificate.n_found == found.count() + self.problem.n_rigid() {
            let band = CertifiedBand { entry: self.key(SEED).digest(), count };
            CertifiedModes::keep(cache, &self.key_of_boundary(), &band, self.reach);
        }
    }

    /// The cache, where what this search finds is kept.
    fn cache(&self) -> Option<&'a Cache> {
        let component = self.problem.component;
        // What refinement took of a factor in single precision is part of the report, and nobody knows it without the solves. The other
        // eigensolver is a library of the system, whose bytes no key sees.
        let is_kept = component.factor.storage() == Storage::Double && self.eigensolver == Eigensolver::Lanczos;
        component.partition.cache().filter(|_| is_kept)
    }

    /// The key of the modes from the start vectors of a seed. The count at the end of a band follows from what is in it.
    fn key(&self, seed: u64) -> Key {
        let BoundaryProblem { component, boundary } = &self.problem;
        component.key("modes").shown(&(boundary, self.wanted, self.eigensolver)).numbers(&[seed])
    }

    /// The key of all modes under the boundary.
    fn key_of_boundary(&self) -> Key {
        let BoundaryProblem { component, boundary } = &self.problem;
        component.key("certified modes").shown(&boundary)
    }

    /// How many of the lowest modes are asked for, the last cluster whole.
    fn n_asked_of(&self, lambda: &[f64]) -> usize {
        let mut count = match self.wanted {
            Wanted::Count(count) => count.min(lambda.len()),
            Wanted::UpTo(limit) => lambda.iter().take_while(|lambda| !is_above(**lambda, limit)).count(),
        };
        while count > 0 && count < lambda.len() && are_clustered(lambda[count - 1], lambda[count]) {
            count += 1;
        }
        count
    }

    /// No modes, where none are looked for.
    pub fn nothing(&self) -> Modes {
        Modes::none(self.problem.modal().mass.rows())
    }

    /// Whether nothing has stiffness, as in a point mass: then all motion is that of rigid bodies.
    fn is_without_stiffness(&self) -> bool {
        let stiffness = self.problem.modal().stiffness;
        (0..stiffness.rows()).all(|row| stiffness.entries(row).all(|(_, value)| value == 0.0))
    }

    fn in_one_go(&self, seed: u64) -> Result<Modes> {
        let request = ModeRequest { wanted: self.wanted, eigensolver: self.eigensolver, seed };
        let problem = self.problem.modal();
        let solve = |operator: &dyn ShiftInvert| elastic_modes(problem, operator, request);
        // The factor of K_II serves two purposes; one of K − σM is made for this one.
        let counted =
            |(modes, factorisations): (Modes, usize)| modes.after(EigenWork { factorisations, ..EigenWork::default() });
        let below = || self.problem.with_operator_below(solve).map(counted);
        let is_held = self.problem.boundary == Boundary::FixedInterface;
        let (modes, n_factorisations) = match self.problem.with_lowest_operator(solve) {
            Err(Error::LanczosStalled { .. }) if !is_held => return below(),
            found => found?,
        };
        if is_held || n_factorisations > 0 || !are_left_inexact(problem, &modes) {
            return Ok(counted((modes, n_factorisations)));
        }
        // A motion that is local to a node of the interface turns the whole component about it in the answer of the held one, and rounding
        // of that is left in the mode.
        let again = below()?.after(modes.work);
        let is_better = again.largest_backward() < modes.largest_backward();
        Ok(if is_better { again } else { Modes { work: again.work, ..modes } })
    }

    fn in_slices(&self) -> Result<Modes> {
        let nothing = self.nothing();
        let mut counts = match (self.wanted, self.edge) {
            (Wanted::Count(count), _) => Counts::up_to(&self.problem, count)?,
            (Wanted::UpTo(_), Some(edge)) => Counts::between(&self.problem, (0.0, 0), edge),
            (Wanted::UpTo(_), None) => return Ok(nothing),
        };
        let Some(last) = counts.last() else { return Ok(nothing) };
        // Every other slice is searched at the same time: an odd one would be left over.
        let n_slices = 2 * last.n_elastic.div_ceil(2 * SLICE);
        let mut ends = counts.cut_evenly(n_slices)?;
        ends.push(last);
        let work = EigenWork { factorisations: counts.n_taken, ..EigenWork::default() };
        let band = Band { source: self, problem: &self.problem, at_once: self.at_once };
        band.fill(Modes { work, ..nothing }, &ends)
    }
}

impl ModeSource for Search<'_> {
    fn lowest(&self, seed: u64) -> Result<Modes> {
        if self.is_without_stiffness() {
            return Ok(self.asked(self.nothing()));
        }
        let count = self.n_expected().unwrap_or(0);
        if count <= SLICED_FROM {
            return Ok(self.asked(self.in_one_go(seed)?));
        }
        // The witness finds its modes itself.
        let all = match self.eigensolver {
            Eigensolver::Lanczos => dense_spectrum::all_modes(&self.problem, count)?,
            Eigensolver::Arpack => None,
        };
        let modes = match all {
            Some(modes) => modes,
            None => self.in_slices()?,
        };
        Ok(self.asked(modes))
    }

    fn between(&self, interval: Interval, known: &Modes, seed: u64) -> Result<Modes> {
        search_between(&self.problem, interval, known, (self.eigensolver, seed))
    }

    /// One rule for all searches: it looks at the quotients, not at the estimates of an iteration.
    fn asked(&self, modes: Modes) -> Modes {
        let count = self.n_asked_of(&modes.lambda);
        Modes { searched_to: self.wanted.band_end(), ..modes.truncated(count) }
    }

    fn is_exhausted_by(&self, modes: &Modes) -> bool {
        self.n_asked.is_some_and(|n_asked| modes.count() < n_asked)
    }
}

/// The count just above the end of a band, moved up while it meets an eigenvalue.
fn edge_of(problem: &BoundaryProblem<'_>, limit: f64) -> Result<Option<ElasticCount>> {
    for step in [1.0, 2.0, 10.0, 100.0] {
        match problem.count_below(limit * (1.0 + step * CLUSTER_GAP)) {
            Ok(count) => return Ok(Some(count)),
            Err(Error::SturmPivot) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(None)
}

/// What a job asks of the spectrum, in scaled units.
pub(crate) fn mode_wish(selection: ModeSelection, partition: &Partition) -> Wanted {
    match selection {
        // No model has more modes than degrees of freedom.
        ModeSelection::Count { count } => Wanted::Count(count.min(partition.n_dofs())),
        ModeSelection::UpTo { up_to_hz } => Wanted::UpTo(partition.scaling.eigenvalue(up_to_hz)),
    }
}
