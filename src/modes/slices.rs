//! Intervals between two Sturm counts, filled with the modes that the counts say are there.
//!
//! ```text
//! |---- n₁ ----|------- n₂ -------|-- n₃ --|--- n₄ ---|     shifts, with the eigenvalues counted between them
//!     round 1         round 2        round 1   round 2
//! ```
//! An interval that lacks more modes than a search takes at once is cut by further counts. A search has
//! its shift inside the interval, the modes known inside it deflated, and is made M-orthogonal to all modes known. Every other
//! interval is searched first, each as if there were no others: they do not touch, so that their modes are orthogonal by what lies
//! between them, and as many are searched side by side as memory allows. Those between them follow, with the modes of the
//! first round deflated. How many are searched at the same time changes no result.
//!
//! An interval in which modes stay missing is cut further, so that each search has fewer to find, until the search ends with an error that names it.
//! The last end is moved up where it may lie inside a cluster: clusters stay whole.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::boundary_problem::BoundaryProblem;
use super::counts::{Counts, middle};
use crate::dense;
use crate::eigen::ElasticCount;
use crate::eigen::purified;
use crate::eigen::{CLUSTER_GAP, Modes, judged, pairs_between, settled_at};
use crate::eigen::{EigenWork, Eigenpairs, Interval, Problem, are_clustered};
use crate::error::{Error, Result};
use crate::job::Eigensolver;
use crate::number::counted;
use crate::random::SEED;
use crate::sparse::product;

/// Modes that a slice of a band is to have.
pub const SLICE: usize = 120;
/// The most that a search is to find.
pub const LARGEST_SEARCH: usize = SLICE + SLICE / 2;
/// Searches of one interval from different start vectors, after the one of its round.
const ATTEMPTS: u64 = 2;
/// Cuts of an interval that lacks too many modes for one search: sixty halve any range of doubles to one mode's.
const CUTS_TO_SIZE: usize = 60;
/// Cuts of an interval in which modes stay missing.
const CUTS_TO_FIND: usize = 6;

/// Where modes come from; asked again where a count says that some are missing.
pub trait ModeSource: Sync {
    /// The modes of the job, from the start vectors of a seed.
    ///
    /// # Errors
    /// The eigensolver fails.
    fn lowest(&self, seed: u64) -> Result<Modes>;

    /// The modes between two shifts that are not among those known.
    ///
    /// # Errors
    /// The eigensolver fails.
    fn between(&self, interval: Interval, known: &Modes, seed: u64) -> Result<Modes>;

    /// The modes that were asked for, of all that were found.
    fn asked(&self, modes: Modes) -> Modes {
        modes
    }

    /// The modes again, from other start vectors, after a count has found some missing; none where that would bring the same ones.
    ///
    /// # Errors
    /// The eigensolver fails.
    fn again(&self, seed: u64) -> Result<Option<Modes>> {
        self.lowest(seed).map(Some)
    }

    /// The count below the band, where it does not begin at zero.
    fn begin(&self) -> Option<ElasticCount> {
        None
    }

    /// Whether modes are fewer than were asked for, as where a component has no more.
    fn is_exhausted_by(&self, _modes: &Modes) -> bool {
        false
    }
}

/// What is filled, and how many intervals of it may be searched at the same time.
pub(super) struct Band<'a> {
    /// Where modes come from.
    pub source: &'a dyn ModeSource,
    /// The eigenproblem.
    pub problem: &'a BoundaryProblem<'a>,
    /// Searches at the same time, at most.
    pub at_once: usize,
}

impl Band<'_> {
    /// Finds what the counts say is missing from the known modes; `ends` are ascending, the lowest interval starts where the band of the
    /// source does. The counts of the result end where no cluster is cut.
    ///
    /// # Errors
    /// [`Error::ModesMissing`] where modes stay missing; those of the source and of the counts.
    pub(super) fn fill(&self, known: Modes, ends: &[ElasticCount]) -> Result<Modes> {
        let mut filling = Filling { band: self, modes: known };
        let ends = filling.cut_to_size(ends)?;
        filling.search_every_other(&ends)?;
        for (lower, upper) in self.intervals(&ends) {
            filling.fill(lower, upper, CUTS_TO_FIND)?;
        }
        if let [inner @ .., last] = &ends[..] {
            let last = filling.end_beyond_cluster(*last)?;
            filling.modes.counts.extend_from_slice(inner);
            filling.modes.counts.push(last);
        }
        filling.modes.counts.sort_by(|a, b| a.inertia.sigma.total_cmp(&b.inertia.sigma));
        Ok(filling.modes)
    }

    /// The intervals below ascending ends: a shift with the count below it, that of the source for the first, and the count at the
    /// other end.
    fn intervals(&self, ends: &[ElasticCount]) -> impl Iterator<Item = ((f64, usize), ElasticCount)> {
        let begin = self.source.begin().map_or((0.0, 0), |begin| begin.place());
        let lower = std::iter::once(begin).chain(ends.iter().map(|end| end.place()));
        lower.zip(ends.iter().copied())
    }
}

struct Filling<'a> {
    band: &'a Band<'a>,
    modes: Modes,
}

impl Filling<'_> {
    /// The ends, with further counts where an interval lacks more modes than a search should find.
    fn cut_to_size(&mut self, ends: &[ElasticCount]) -> Result<Vec<ElasticCount>> {
        let mut cut = Vec::new();
        for (lower, upper) in self.band.intervals(ends) {
            self.cut_to_parts((lower, upper), &mut cut, CUTS_TO_SIZE)?;
            cut.push(upper);
        }
        Ok(cut)
    }

    /// Cuts one interval until none of its parts lacks too many modes.
    fn cut_to_parts(
        &mut self,
        (lower, upper): ((f64, usize), ElasticCount),
        cut: &mut Vec<ElasticCount>,
        cuts: usize,
    ) -> Result<()> {
        if self.n_lacking(lower, upper)? <= LARGEST_SEARCH {
            return Ok(());
        }
        match self.cut(lower, upper)? {
            Some(middle) if cuts > 0 => {
                self.cut_to_parts((lower, middle), cut, cuts - 1)?;
                cut.push(middle);
                self.cut_to_parts((middle.place(), upper), cut, cuts - 1)
            }
            _ => Err(missing(self.band.problem, &self.modes, upper)),
        }
    }

    /// Modes counted between two shifts and not known; more modes than counted cannot be mended.
    fn n_lacking(&self, lower: (f64, usize), upper: ElasticCount) -> Result<usize> {
        let counted = upper.n_elastic.checked_sub(lower.1);
        let found = self.modes.n_between(lower.0, upper.inertia.sigma);
        counted
            .and_then(|counted| counted.checked_sub(found))
            .ok_or_else(|| missing(self.band.problem, &self.modes, upper))
    }

    /// Searches the intervals that lack modes once, every other one first.
    fn search_every_other(&mut self, ends: &[ElasticCount]) -> Result<()> {
        let mut lacking = Vec::new();
        for (lower, upper) in self.band.intervals(ends) {
            let count = self.n_lacking(lower, upper)?;
            if count > 0 {
                lacking.push(Interval { from: lower.0, to: upper.inertia.sigma, count });
            }
        }
        for round in 0..2 {
            let round: Vec<Interval> = lacking.iter().copied().skip(round).step_by(2).collect();
            let found = side_by_side(&round, self.band.at_once, |interval| {
                self.band.source.between(interval, &self.modes, SEED + 2)
            });
            self.take(&round, found.into_iter().collect::<Result<_>>()?);
        }
        Ok(())
    }

    /// Adds what searches have found in their intervals, and says whether that is anything.
    fn take(&mut self, intervals: &[Interval], found: Vec<Modes>) -> bool {
        // What is left of a copy of a known mode is rounding, with an eigenvalue anywhere.
        let inside = |(interval, modes): (&Interval, Modes)| modes.selected(|lambda| interval.holds(lambda));
        let found: Vec<Modes> = intervals.iter().zip(found).map(inside).collect();
        let is_progress = found.iter().any(|modes| modes.count() > 0);
        self.modes = std::mem::replace(&mut self.modes, Modes::none(0)).joined(found);
        is_progress
    }

    /// Fills the interval from a shift with the count below it up to another; `cuts` are those left to find what stays missing.
    fn fill(&mut self, lower: (f64, usize), upper: ElasticCount, cuts: usize) -> Result<()> {
        for attempt in 0..ATTEMPTS {
            let count = self.n_lacking(lower, upper)?;
            if count == 0 {
                return Ok(());
            }
            let interval = Interval { from: lower.0, to: upper.inertia.sigma, count };
            let found = self.band.source.between(interval, &self.modes, SEED + 3 + attempt)?;
            if !self.take(&[interval], vec![found]) {
                break;
            }
        }
        if self.n_lacking(lower, upper)? == 0 {
            return Ok(());
        }
        match self.cut(lower, upper)? {
            Some(middle) if cuts > 1 => {
                self.fill(lower, middle, cuts - 1)?;
                self.fill(middle.place(), upper, cuts - 1)?;
                self.modes.counts.push(middle);
                Ok(())
            }
            _ => Err(missing(self.band.problem, &self.modes, upper)),
        }
    }

    /// Moves an end up while a mode lies so near below it that its cluster may go on above.
    fn end_beyond_cluster(&mut self, mut end: ElasticCount) -> Result<ElasticCount> {
        /// Doublings that take a shift from the gap of a cluster beyond any spectrum of doubles.
        const DOUBLINGS: i32 = 64;
        let mut sigma = end.inertia.sigma;
        for doubling in 1..=DOUBLINGS {
            let below = self.modes.lambda.iter().copied().filter(|lambda| *lambda < end.inertia.sigma);
            if !below.reduce(f64::max).is_some_and(|last| are_clustered(last, end.inertia.sigma)) {
                return Ok(end);
            }
            sigma *= 1.0 + 2f64.powi(doubling) * CLUSTER_GAP;
            self.modes.work.factorisations += 1;
            match self.band.problem.count_below(sigma) {
                Ok(above) => {
                    self.fill(end.place(), above, CUTS_TO_FIND)?;
                    end = above;
                }
                Err(Error::SturmPivot) => {}
                Err(error) => return Err(error),
            }
        }
        Err(Error::SturmPivot)
    }

    /// A count near the middle of an interval, off the eigenvalues known.
    fn cut(&mut self, lower: (f64, usize), upper: ElasticCount) -> Result<Option<ElasticCount>> {
        let mut counts = Counts::between(self.band.problem, lower, upper);
        let count = counts.take_near(middle(lower.0, upper.inertia.sigma), |sigma| self.modes.is_clear(sigma))?;
        self.modes.work.factorisations += counts.n_taken;
        Ok(count)
    }
}

/// Searches intervals, at most so many at the same time; the answers in their order.
fn side_by_side<T: Send + Sync>(
    intervals: &[Interval],
    at_once: usize,
    search: impl Fn(Interval) -> T + Sync,
) -> Vec<T> {
    let answers: Vec<OnceLock<T>> = intervals.iter().map(|_| OnceLock::new()).collect();
    let next = AtomicUsize::new(0);
    (0..at_once.clamp(1, intervals.len().max(1))).into_par_iter().for_each(|_| {
        while let Some(place) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|place| *place < intervals.len()) {
            answers[place].get_or_init(|| search(intervals[place]));
        }
    });
    answers.into_iter().map(|answer| answer.into_inner().expect("each place was taken once")).collect()
}

/// Why counts and modes do not agree where modes other than the rigid-body ones were found below zero: no interval above zero has them, and
/// every count does.
fn below_zero(problem: &BoundaryProblem<'_>, modes: &Modes) -> Option<Error> {
    let count = modes.lambda.iter().filter(|lambda| **lambda < 0.0).count();
    let partition = problem.component.partition;
    let what = || format!("whether {} free", counted(count, "mode below zero is", "modes below zero are"));
    match (count, partition.has_few_digits()) {
        (0, _) => None,
        (_, true) => Some(partition.precision.stiffness.too_uncertain(what())),
        // What is unstable with some dofs held is so with none.
        (count, false) => Some(Error::IndefiniteStiffness { count, boundary: "free" }),
    }
}

/// The error of an interval that is given up: why counts and modes differ where that is known, or that modes are missing.
pub(super) fn missing(problem: &BoundaryProblem<'_>, modes: &Modes, upper: ElasticCount) -> Error {
    let (sigma, n_rigid) = (upper.inertia.sigma, problem.n_rigid());
    if let Some(error) = below_zero(problem, modes) {
        return error;
    }
    let partition = problem.component.partition;
    let below_hz = partition.scaling.hertz(sigma);
    let [found, counted] = [modes.n_between(f64::NEG_INFINITY, sigma), upper.n_elastic].map(|n| n + n_rigid);
    // None is missing: a motion that is free as far as few digits tell is one by itself, and not with the rounding of the others.
    if found > counted && partition.has_few_digits() {
        let what =
            format!("how many modes lie below {below_hz:.6} Hz: {found} were found, and a Sturm count says {counted}");
        return partition.precision.stiffness.too_uncertain(what);
    }
    Error::ModesMissing { below_hz, found, counted }
}

/// Searches an interval with a shift inside it, by an eigensolver and from the start vectors of a seed.
///
/// # Errors
/// Every shift tried lies on an eigenvalue; a dense eigenproblem does not converge.
pub(super) fn search_between(
    problem: &BoundaryProblem<'_>,
    interval: Interval,
    known: &Modes,
    solver: (Eigensolver, u64),
) -> Result<Modes> {
    let modal = problem.modal();
    // Modes beyond the ends are orthogonalised away at the end: deflating them takes longer than finding them again.
    let near = known.shapes_between(interval.from, interval.to);
    let q = dense::side_by_side(modal.deflated[0], near.as_ref());
    let mass_q = dense::side_by_side(modal.deflated[1], product(modal.mass, near.as_ref()).as_ref());
    let (modes, n_factorisations) = problem.with_operator_inside(interval, |operator| {
        let deflated = [q.as_ref(), mass_q.as_ref()];
        let pairs = pairs_between(Problem { operator, mass: modal.mass, deflated }, interval, solver)?;
        let whole = Problem { operator, mass: modal.mass, deflated: modal.deflated };
        // Nothing nearer than the ends of the interval is known of the neighbours.
        let around = [Some(interval.from), Some(interval.to)];
        // What the neighbours' searches found already is taken out: their modes and these come of different starts.
        let orthogonal_and_judged = |mut pairs: Eigenpairs| {
            let along = dense::gram(known.shapes.as_ref(), product(modal.mass, pairs.vectors.as_ref()).as_ref());
            dense::add_product(pairs.vectors.as_mut(), -1.0, known.shapes.as_ref(), along.as_ref());
            judged(modal, whole, pairs, around).ascending()
        };
        let modes = orthogonal_and_judged(pairs);
        let settled = settled_at(modal.precision);
        if modes.errors.iter().all(|error| error.backward <= settled) {
            return Ok(modes);
        }
        Ok(orthogonal_and_judged(purified(whole, &modes, settled)))
    })?;
    let work = EigenWork { factorisations: n_factorisations, ..modes.work };
    Ok(Modes { work, next: None, ..modes })
}
