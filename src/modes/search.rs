//! The search for the modes of a job: in one go, in slices, or all at once.
//!
//! A band is counted before it is searched, so that it is known what it will take. Up to [`SLICED_FROM`] modes come from
//! one operator at shift zero; more come in slices, each from a shift of its own; most of the spectrum of a small model
//! comes from a dense decomposition. The certificate judges all of them alike.

use super::boundary_problem::{BoundaryProblem, ElasticCount, ratios};
use super::eigenproblem::{EigenWork, Interval, Wanted, are_clustered, is_above};
use super::finite::above_all;
use super::slices::{ModeSource, fill, search_between};
use super::{Boundary, CLUSTER_GAP, Component, ModeRequest, Modes, dense_spectrum, elastic_modes, indefinite};
use crate::error::{Error, Result};
use crate::job::{Eigensolver, ModeSelection, ReductionJob};
use crate::partition::Partition;

/// More modes than this come in slices: a basis of four vectors a mode stays below a thousand.
pub const SLICED_FROM: usize = 200;
/// How far a shift is moved that lies on an eigenvalue, relatively.
const OFF: f64 = 1e-3;

/// What a job asks of the spectrum of a component, and how it is found.
#[derive(Clone, Copy, Debug)]
pub struct Search<'a> {
    /// The eigenproblem.
    pub problem: BoundaryProblem<'a>,
    wanted: Wanted,
    /// Modes asked for, were there as many; none for a band.
    n_asked: Option<usize>,
    eigensolver: Eigensolver,
    /// The count at the end of the band, where a band is asked for and its end is off the eigenvalues.
    edge: Option<ElasticCount>,
}

impl<'a> Search<'a> {
    /// Prepares the search: looks at the signs of the spectrum and counts the modes of a band.
    ///
    /// # Errors
    /// The stiffness has negative eigenvalues; no memory for the count.
    pub fn new(component: Component<'a>, job: &ReductionJob) -> Result<Self> {
        indefinite::refuse(component)?;
        let boundary = if component.is_modal() { Boundary::FreeInterface } else { Boundary::of(job.method) };
        let problem = BoundaryProblem { component, boundary };
        let wanted = wanted(job.modes, component.partition);
        let edge = match wanted {
            Wanted::UpTo(limit) if limit > 0.0 => edge_of(&problem, limit)?,
            _ => None,
        };
        let n_asked = match job.modes {
            ModeSelection::Count { count } => Some(count),
            ModeSelection::UpTo { .. } => None,
        };
        Ok(Self { problem, wanted, n_asked, eigensolver: job.eigensolver, edge })
    }

    /// The count at the end of the band, where a band is asked for.
    pub fn edge(&self) -> Option<ElasticCount> {
        self.edge
    }

    /// Modes that are going to be found, as far as that is known.
    pub fn n_expected(&self) -> Option<usize> {
        match self.wanted {
            Wanted::Count(count) => Some(count),
            Wanted::UpTo(_) => self.edge.map(|edge| edge.n_elastic),
        }
    }

    fn in_one_go(&self, seed: u64) -> Result<Modes> {
        let request = ModeRequest { wanted: self.wanted, eigensolver: self.eigensolver, seed };
        let problem = self.problem.modal();
        let (mut modes, n_factorisations) =
            self.problem.with_lowest_operator(|operator| elastic_modes(problem, operator, request))?;
        modes.work.factorisations += n_factorisations;
        Ok(modes)
    }

    fn in_slices(&self) -> Result<Modes> {
        let nothing = Modes::none(self.problem.modal().mass.rows());
        match (self.wanted, self.edge) {
            (Wanted::Count(count), _) => {
                let ends = self.ends_above(count)?;
                let work = EigenWork { factorisations: ends.len(), ..EigenWork::default() };
                fill(self, &self.problem, Modes { work, ..nothing }, &ends)
            }
            (Wanted::UpTo(_), edge) => fill(self, &self.problem, nothing, edge.as_slice()),
        }
    }

    /// Counts up to one with more than `count` modes below it, but not many more, or with all modes there are.
    fn ends_above(&self, count: usize) -> Result<Vec<ElasticCount>> {
        const STEPS: usize = 60;
        let ratios = ratios(self.problem.modal());
        let top = above_all(&self.problem);
        // λ of plane and solid meshes grows at least linearly in the number of the mode.
        let share = count as f64 / self.problem.modal().mass.rows() as f64;
        let mut sigma = ratios.get(ratios.len() / 2).copied().unwrap_or(1.0) * share;
        let (mut lower, mut upper): (Vec<ElasticCount>, Option<ElasticCount>) = (Vec::new(), None);
        for _ in 0..STEPS {
            match self.problem.count_below(sigma) {
                Ok(end) if end.n_elastic > count || sigma >= top => upper = Some(end),
                Ok(end) => lower.push(end),
                Err(Error::SturmPivot { .. }) => {
                    sigma *= 1.0 + OFF;
                    continue;
                }
                Err(error) => return Err(error),
            }
            let below = lower.last().map_or(0.0, |end| end.inertia.sigma);
            sigma = match upper {
                Some(end) if end.n_elastic <= count + SLICED_FROM || end.inertia.sigma < (1.0 + OFF) * below => break,
                Some(end) => middle(below, end.inertia.sigma),
                None => 4.0 * sigma,
            };
        }
        lower.extend(upper);
        Ok(lower)
    }

    /// Cuts what a search has found down to what was asked for.
    fn cut(&self, modes: Modes) -> Modes {
        let lambda = &modes.lambda;
        let mut count = match self.wanted {
            Wanted::Count(count) => count.min(lambda.len()),
            Wanted::UpTo(limit) => lambda.iter().take_while(|lambda| !is_above(**lambda, limit)).count(),
        };
        while count > 0 && count < lambda.len() && are_clustered(lambda[count - 1], lambda[count]) {
            count += 1;
        }
        let searched_to = match self.wanted {
            Wanted::Count(_) => None,
            Wanted::UpTo(limit) => Some(limit),
        };
        Modes { searched_to, ..modes.truncated(count) }
    }
}

/// Half way in frequency, where modes lie more evenly than in λ.
pub(super) fn middle(from: f64, to: f64) -> f64 {
    (0.5 * (from.max(0.0).sqrt() + to.sqrt())).powi(2)
}

impl ModeSource for Search<'_> {
    fn lowest(&self, seed: u64) -> Result<Modes> {
        let count = self.n_expected().unwrap_or(0);
        if count <= SLICED_FROM {
            return self.in_one_go(seed);
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
        Ok(self.cut(modes))
    }

    fn between(&self, interval: Interval, known: &Modes, seed: u64) -> Result<Modes> {
        search_between(&self.problem, interval, known, (self.eigensolver, seed))
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
            Err(Error::SturmPivot { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(None)
}

fn wanted(selection: ModeSelection, partition: &Partition) -> Wanted {
    match selection {
        // No model has more modes than degrees of freedom.
        ModeSelection::Count { count } => Wanted::Count(count.min(partition.n_dofs())),
        ModeSelection::UpTo { up_to_hz } => {
            let omega = 2.0 * std::f64::consts::PI * up_to_hz;
            Wanted::UpTo(omega * omega / partition.scaling.eigenvalue_unit())
        }
    }
}
