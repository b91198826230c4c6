//! Intervals between two Sturm counts, filled with the modes that the counts say are there.
//!
//! ```text
//! |---- n₁ ----|------- n₂ -------|-- n₃ --|      shifts, with the eigenvalues counted between them
//! ```
//! An interval with more modes than a search takes at once is cut in two by another count. A search has its shift inside
//! the interval, the modes known nearby deflated, and is made M-orthogonal to all modes known. An interval in which
//! modes stay missing is cut further, so that each search has fewer to find, until it is given up by name. The last end is
//! moved up where it may lie inside a cluster: clusters stay whole.

use faer::Mat;

use super::boundary_problem::{BoundaryProblem, ElasticCount};
use super::eigenproblem::{EigenWork, Interval, Problem, are_clustered};
use super::search::middle;
use super::{CLUSTER_GAP, Modes, SEED, judged, pairs_between};
use crate::dense;
use crate::error::{Error, Result};
use crate::job::Eigensolver;
use crate::sparse::product;

/// Modes searched for at once.
pub const SLICE: usize = 120;
/// Searches of one interval from different start vectors.
const ATTEMPTS: u64 = 2;
/// Cuts of an interval that still holds too many modes for one search: sixty halve any range of doubles to one mode's.
const CUTS_TO_SIZE: usize = 60;
/// Cuts of an interval in which modes stay missing.
const CUTS_TO_FIND: usize = 6;

/// Where modes come from; asked again where a count says that some are missing.
pub trait ModeSource {
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

    /// Whether modes are fewer than were asked for, as where a component has no more.
    fn is_exhausted_by(&self, _modes: &Modes) -> bool {
        false
    }
}

/// Finds what the counts say is missing from the known modes; `ends` are ascending, the lowest interval starts at zero. The
/// counts of the result end where no cluster is cut.
///
/// # Errors
/// [`Error::ModesMissing`] where modes stay missing; those of the source and of the counts.
pub(super) fn fill(
    source: &dyn ModeSource,
    problem: &BoundaryProblem<'_>,
    known: Modes,
    ends: &[ElasticCount],
) -> Result<Modes> {
    let mut filling = Filling { source, problem, modes: known };
    let mut lower = (0.0, 0);
    for end in ends {
        filling.fill(lower, *end, (CUTS_TO_SIZE, CUTS_TO_FIND))?;
        lower = (end.inertia.sigma, end.n_elastic);
    }
    if let [inner @ .., last] = ends {
        let last = filling.end_beyond_cluster(*last)?;
        filling.modes.counts.extend_from_slice(inner);
        filling.modes.counts.push(last);
    }
    filling.modes.counts.sort_by(|a, b| a.inertia.sigma.total_cmp(&b.inertia.sigma));
    Ok(filling.modes)
}

struct Filling<'a> {
    source: &'a dyn ModeSource,
    problem: &'a BoundaryProblem<'a>,
    modes: Modes,
}

impl Filling<'_> {
    /// Fills the interval from a shift with the count below it up to another; `cuts` are those left to cut it to size and to
    /// find what stays missing.
    fn fill(&mut self, lower: (f64, usize), upper: ElasticCount, cuts: (usize, usize)) -> Result<()> {
        let (from, to) = (lower.0, upper.inertia.sigma);
        let Some(counted) = upper.n_elastic.checked_sub(lower.1) else {
            return Err(missing(self.problem, &self.modes, upper));
        };
        let too_many = counted > SLICE && cuts.0 > 0;
        if self.is_filled(from, to, counted, upper)? {
            return Ok(());
        }
        if !too_many {
            for attempt in 0..ATTEMPTS {
                let count = counted - self.modes.n_between(from, to);
                let more = self.source.between(Interval { from, to, count }, &self.modes, SEED + 2 + attempt)?;
                // What is left of a copy of a known mode is rounding, with an eigenvalue anywhere.
                let more = more.selected(|lambda| from < lambda && lambda < to);
                let is_progress = more.count() > 0;
                self.modes = std::mem::replace(&mut self.modes, Modes::none(0)).joined(more);
                if self.is_filled(from, to, counted, upper)? {
                    return Ok(());
                }
                if !is_progress {
                    break;
                }
            }
        }
        let cuts = if too_many { (cuts.0 - 1, cuts.1) } else { (cuts.0, cuts.1.saturating_sub(1)) };
        match self.cut(lower, upper) {
            Some(middle) if cuts.1 > 0 => {
                self.fill(lower, middle, cuts)?;
                self.fill((middle.inertia.sigma, middle.n_elastic), upper, cuts)?;
                self.modes.counts.push(middle);
                Ok(())
            }
            _ => Err(missing(self.problem, &self.modes, upper)),
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
            match self.problem.count_below(sigma) {
                Ok(above) => {
                    self.fill((end.inertia.sigma, end.n_elastic), above, (CUTS_TO_SIZE, CUTS_TO_FIND))?;
                    end = above;
                }
                Err(Error::SturmPivot { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        Err(Error::SturmPivot { step: 0 })
    }

    /// Whether nothing is missing; more modes than counted cannot be mended.
    fn is_filled(&self, from: f64, to: f64, counted: usize, upper: ElasticCount) -> Result<bool> {
        let found = self.modes.n_between(from, to);
        if found > counted {
            return Err(missing(self.problem, &self.modes, upper));
        }
        Ok(found == counted)
    }

    /// A count near the middle of an interval, off the eigenvalues known.
    fn cut(&mut self, lower: (f64, usize), upper: ElasticCount) -> Option<ElasticCount> {
        const PLACES: [f64; 5] = [0.5, 0.44, 0.56, 0.38, 0.62];
        let (from, to) = (lower.0, upper.inertia.sigma);
        for place in PLACES {
            let half = middle(from, to);
            let sigma = if place <= 0.5 {
                from + 2.0 * place * (half - from)
            } else {
                half + (2.0 * place - 1.0) * (to - half)
            };
            if !self.modes.is_clear(sigma) {
                continue;
            }
            self.modes.work.factorisations += 1;
            if let Ok(count) = self.problem.count_below(sigma)
                && (lower.1..=upper.n_elastic).contains(&count.n_elastic)
            {
                return Some(count);
            }
        }
        None
    }
}

/// The error of an interval that is given up.
pub(super) fn missing(problem: &BoundaryProblem<'_>, modes: &Modes, upper: ElasticCount) -> Error {
    let unit = problem.component.partition.scaling.eigenvalue_unit();
    let (sigma, n_rigid) = (upper.inertia.sigma, problem.n_rigid());
    Error::ModesMissing {
        below_hz: (sigma * unit).max(0.0).sqrt() / std::f64::consts::TAU,
        found: modes.n_between(f64::NEG_INFINITY, sigma) + n_rigid,
        counted: upper.n_elastic + n_rigid,
    }
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
    let n = modal.mass.rows();
    let nothing = Mat::zeros(n, 0);
    let rigid = modal.rigid.map_or((nothing.as_ref(), nothing.as_ref()), |rigid| {
        (rigid.orthonormal.as_ref(), rigid.mass_orthonormal.as_ref())
    });
    // Modes further away than the interval is wide are damped by the shift and orthogonalised away at the end.
    let width = interval.to - interval.from;
    let near = known.shapes_between(interval.from - width, interval.to + width);
    let q = dense::beside(rigid.0, near.as_ref());
    let mass_q = dense::beside(rigid.1, product(modal.mass, near.as_ref()).as_ref());
    let (modes, n_factorisations) = problem.with_operator_inside(interval, |operator| {
        let deflated = [q.as_ref(), mass_q.as_ref()];
        let mut pairs = pairs_between(Problem { operator, mass: modal.mass, deflated }, interval, solver)?;
        let along = dense::gram(known.shapes.as_ref(), product(modal.mass, pairs.vectors.as_ref()).as_ref());
        dense::add_product(pairs.vectors.as_mut(), -1.0, known.shapes.as_ref(), along.as_ref());
        let whole = Problem { operator, mass: modal.mass, deflated: [rigid.0, rigid.1] };
        // Nothing nearer than the ends of the interval is known of the neighbours.
        Ok(judged(modal, whole, pairs, [Some(interval.from), Some(interval.to)]).ascending())
    })?;
    let work = EigenWork { factorisations: n_factorisations, ..modes.work };
    Ok(Modes { work, next: None, ..modes })
}
