//! Modes: the expansion modes V that the reduction method keeps.
//!
//! ```text
//! free-free modes             K x = λ M x on all dofs, rigid-body modes deflated
//! fixed-interface modes       K_II v = λ M_II v
//! ```
//! Both come from the factor of K_II at shift zero. Eigenvalues are recomputed as Rayleigh quotients, whose error is the
//! square of the vector's; each carries the bar that rounding and the digits of the data put on it.

mod answer;
#[cfg(feature = "arpack")]
mod arpack;
mod block_width;
mod boundary_problem;
mod certificate;
mod cluster;
mod columns;
mod counts;
mod dense_spectrum;
mod eigenproblem;
mod equilibration;
mod finite;
mod indefinite;
mod lanczos;
mod modal_problem;
mod next_block;
mod operator;
mod orthogonalisation;
mod quality;
mod random;
mod retained;
mod ritz;
mod search;
mod shifted;
mod slices;
pub(crate) mod zero;

use faer::Mat;

use crate::dense;
use crate::error::Result;
use crate::job::Eigensolver;
use crate::model::Precision;
use crate::sparse::product;

pub(crate) use boundary_problem::massive;
pub use boundary_problem::{AtShift, Boundary, BoundaryProblem, ElasticCount};
pub use certificate::{Certificate, CountedInterval, Mending, certified};
pub use cluster::REPEATED_WITHIN;
pub use eigenproblem::{CLUSTER_GAP, EigenWork, Eigenpairs, Interval, Problem, Wanted};
pub use equilibration::Equilibrated;
pub use lanczos::{lanczos, lanczos_between};
pub use modal_problem::{DataSource, ModalProblem};
pub use operator::{Factored, FreeAtZero, RefinedAtZero, ShiftInvert};
pub use orthogonalisation::mass_qr;
pub(crate) use quality::rayleigh_quotients;
pub use quality::{MassOrthogonality, ModeError, NOTICED_BAR, mass_orthogonality};
pub(crate) use random::SplitMix64;
pub use retained::{Component, Retained};
pub(crate) use search::mode_wish;
pub use search::{SLICED_FROM, Search};
pub use shifted::{Shifted, shift_of_factor, shifted};
pub use slices::{LARGEST_SEARCH, ModeSource, SLICE};

/// Elastic modes of one boundary condition.
#[derive(Clone, Debug)]
pub struct Modes {
    /// λ = ω² in scaled units, ascending: Rayleigh quotients.
    pub lambda: Vec<f64>,
    /// Mode shapes, n × k, M-orthonormal.
    pub shapes: Mat<f64>,
    /// How well each is known.
    pub errors: Vec<ModeError>,
    /// The end of the band that was searched, where one was asked for.
    pub searched_to: Option<f64>,
    /// The next eigenvalue above, where there is one.
    pub next: Option<f64>,
    /// Sturm counts taken during the search, ascending: the ends of its slices.
    pub counts: Vec<ElasticCount>,
    /// What they cost.
    pub work: EigenWork,
}

impl Modes {
    /// Number of modes k.
    pub fn count(&self) -> usize {
        self.lambda.len()
    }

    /// No modes of n dofs.
    pub fn none(n: usize) -> Self {
        Self {
            lambda: Vec::new(),
            shapes: Mat::zeros(n, 0),
            errors: Vec::new(),
            searched_to: None,
            next: None,
            counts: Vec::new(),
            work: EigenWork::default(),
        }
    }

    /// Modes between two shifts.
    pub fn n_between(&self, from: f64, to: f64) -> usize {
        self.lambda.iter().filter(|lambda| from < **lambda && **lambda < to).count()
    }

    /// Whether a shift lies off the modes: by a thousandth of the gap it lies in and by a thousand times what rounding moves
    /// an eigenvalue by.
    pub fn is_clear(&self, sigma: f64) -> bool {
        const ROUNDINGS: f64 = 1e3;
        const SHARE_OF_GAP: f64 = 1e-3;
        let below = self.lambda.iter().copied().filter(|lambda| *lambda <= sigma).fold(0.0, f64::max);
        let above = self.lambda.iter().copied().chain(self.next).filter(|lambda| *lambda > sigma);
        let above = above.fold(f64::INFINITY, f64::min);
        let gap = if above.is_finite() { above - below } else { below };
        let floor = self.errors.iter().map(|error| error.rounding_floor).fold(0.0, f64::max);
        (sigma - below).min(above - sigma) >= (ROUNDINGS * floor).max(SHARE_OF_GAP * gap)
    }

    /// The shapes of the modes between two shifts.
    pub fn shapes_between(&self, from: f64, to: f64) -> Mat<f64> {
        self.selected(|lambda| from < lambda && lambda < to).shapes
    }

    /// These modes and others, ascending.
    pub fn joined(self, more: impl IntoIterator<Item = Self>) -> Self {
        let mut work = self.work;
        let parts: Vec<Self> = std::iter::once(self).chain(more).collect();
        parts[1..].iter().for_each(|part| work += part.work);
        if let [whole, rest @ ..] = &parts[..]
            && rest.iter().all(|part| part.count() == 0)
            && whole.lambda.is_sorted()
        {
            return Self { work, ..parts.into_iter().next().expect("the first") };
        }
        let mut order: Vec<(usize, usize)> =
            parts.iter().enumerate().flat_map(|(part, modes)| (0..modes.count()).map(move |j| (part, j))).collect();
        order.sort_by(|a, b| parts[a.0].lambda[a.1].total_cmp(&parts[b.0].lambda[b.1]));
        let n = parts[0].shapes.nrows();
        let mut shapes = Mat::zeros(n, order.len());
        for (mut to, (part, j)) in shapes.as_mut().col_iter_mut().zip(&order) {
            to.copy_from(parts[*part].shapes.as_ref().col(*j));
        }
        Self {
            lambda: order.iter().map(|(part, j)| parts[*part].lambda[*j]).collect(),
            errors: order.iter().map(|(part, j)| parts[*part].errors[*j]).collect(),
            shapes,
            work,
            searched_to: parts[0].searched_to,
            next: parts[0].next,
            counts: parts[0].counts.clone(),
        }
    }

    /// The lowest modes; the first of the others becomes the next eigenvalue above.
    pub fn truncated(self, count: usize) -> Self {
        if count >= self.count() {
            return self;
        }
        Self {
            next: Some(self.lambda[count]),
            shapes: self.shapes.as_ref().subcols(0, count).to_owned(),
            lambda: self.lambda[..count].to_vec(),
            errors: self.errors[..count].to_vec(),
            ..self
        }
    }

    /// All modes but one, as if it had never been found.
    pub fn without(&self, mode: usize) -> Self {
        let order: Vec<usize> = (0..self.count()).filter(|j| *j != mode).collect();
        self.in_order(&order)
    }

    /// These modes in ascending order.
    fn ascending(self) -> Self {
        if self.lambda.is_sorted() {
            return self;
        }
        let mut order: Vec<usize> = (0..self.count()).collect();
        order.sort_by(|a, b| self.lambda[*a].total_cmp(&self.lambda[*b]));
        self.in_order(&order)
    }

    /// The modes whose eigenvalue satisfies a condition.
    fn selected(&self, is_wanted: impl Fn(f64) -> bool) -> Self {
        let order: Vec<usize> = (0..self.count()).filter(|j| is_wanted(self.lambda[*j])).collect();
        self.in_order(&order)
    }

    fn in_order(&self, order: &[usize]) -> Self {
        Self {
            lambda: order.iter().map(|j| self.lambda[*j]).collect(),
            errors: order.iter().map(|j| self.errors[*j]).collect(),
            shapes: dense::columns(self.shapes.as_ref(), order),
            searched_to: self.searched_to,
            next: self.next,
            counts: self.counts.clone(),
            work: self.work,
        }
    }

    /// A shift above the highest mode and the band that was searched, and below the next mode, at this fraction of the
    /// way: where a Sturm count is taken.
    pub fn shift_above(&self, fraction: f64) -> f64 {
        let top = self.lambda.last().copied().into_iter().chain(self.searched_to).fold(0.0, f64::max);
        match self.next.filter(|next| *next > top) {
            Some(next) => top + fraction * (next - top),
            None if top > 0.0 => (1.0 + fraction) * top,
            None => fraction,
        }
    }
}

/// Which modes, by which solver.
#[derive(Clone, Copy, Debug)]
pub struct ModeRequest {
    /// Count or band, in scaled units.
    pub wanted: Wanted,
    /// Lanczos or the independent witness.
    pub eigensolver: Eigensolver,
    /// Seed of the start vectors.
    pub seed: u64,
}

/// Modes found at once are sound within this factor: an operator is applied with ε of its largest θ, and what that leaves of a
/// mode, ε · 10⁶ of itself, moves its Rayleigh quotient by the square.
const SPREAD: f64 = 1e6;
/// Backward error of a mode that lacks no digits, a hundredth of what M-01 lets pass.
const SETTLED: f64 = 1e-12;
/// Backward error above which a step of inverse iteration is tried on a mode: a tenth of what M-01 asks for, and ten times what
/// modes are left with that carry nothing unseen.
const CARRIES_NOTHING: f64 = 1e-14;
/// Share of λ that the residual of such a mode may leave in doubt, a tenth of what M-24 looks at.
const SETTLED_BAR: f64 = 1e-10;
/// Seed of the first attempt; a repeated one takes another.
pub const SEED: u64 = 0x5eed_0001;

/// Finds elastic modes with a shift-invert operator.
///
/// Where few soft motions spread the spectrum over many powers of ten, a search leaves the modes far above them with few
/// digits. Those are then found with the others deflated, as all elastic modes are found with rigid-body motion deflated.
///
/// # Errors
/// The eigensolver does not converge.
pub fn elastic_modes(problem: ModalProblem<'_>, operator: &dyn ShiftInvert, request: ModeRequest) -> Result<Modes> {
    let n = problem.mass.rows();
    let rigid = problem.rigid.map(|rigid| [rigid.orthonormal.as_ref(), rigid.mass_orthonormal.as_ref()]);
    let mut known = Modes::none(n);
    loop {
        let momenta = product(problem.mass, known.shapes.as_ref());
        let beside = match rigid {
            Some([q, mass_q]) => [dense::beside(q, known.shapes.as_ref()), dense::beside(mass_q, momenta.as_ref())],
            None => [known.shapes.clone(), momenta],
        };
        let deflated = [beside[0].as_ref(), beside[1].as_ref()];
        let wanted = match request.wanted {
            Wanted::Count(count) => Wanted::Count(count.saturating_sub(known.count()).max(usize::from(count > 0))),
            Wanted::UpTo(limit) => Wanted::UpTo(limit),
        };
        let eigenproblem = Problem { operator, mass: problem.mass, deflated };
        let found = search(problem, eigenproblem, ModeRequest { wanted, ..request })?;
        let n_settled = n_settled(problem, &found, operator.shift());
        if n_settled == found.count() {
            return Ok(found.joined([known]));
        }
        known = found.truncated(n_settled).joined([known]);
    }
}

/// Modes of one search that stand: all of them, or those up to [`SPREAD`] where one further up lacks digits.
fn n_settled(problem: ModalProblem<'_>, found: &Modes, sigma: f64) -> usize {
    let (n_near, settled) = (n_near(found, sigma), settled_at(problem.precision));
    let lacks_digits = |error: &ModeError| error.backward > settled || error.residual_bar > SETTLED_BAR;
    if n_near > 0 && found.errors[n_near..].iter().any(lacks_digits) { n_near } else { found.count() }
}

/// Modes up to [`SPREAD`]: θ against the largest, which rounding of the operator is relative to.
fn n_near(found: &Modes, sigma: f64) -> usize {
    let reach = found.lambda.first().map_or(0.0, |first| SPREAD * (first - sigma));
    found.lambda.partition_point(|lambda| lambda - sigma <= reach)
}

/// Backward error of a mode that lacks no digits: those that the data do not have are not missed.
fn settled_at(precision: Precision) -> f64 {
    SETTLED.max(precision.stiffness.max(precision.mass))
}

fn search(problem: ModalProblem<'_>, eigenproblem: Problem<'_>, request: ModeRequest) -> Result<Modes> {
    let pairs = match request.eigensolver {
        Eigensolver::Lanczos => lanczos(eigenproblem, request.wanted, request.seed)?,
        Eigensolver::Arpack => by_arpack(eigenproblem, request)?,
    };
    let around = [None, pairs.next];
    let modes = judged(problem, eigenproblem, pairs, around);
    let modes = purified_where_doubtful(problem, eigenproblem, modes, around);
    let searched_to = match request.wanted {
        Wanted::Count(_) => None,
        Wanted::UpTo(limit) => Some(limit),
    };
    Ok(Modes { searched_to, ..modes })
}

/// The modes after a step of inverse iteration, where one of them lacks digits and gains some: what M hardly sees an iteration
/// carries along, unseen by its products with M.
fn purified_where_doubtful(
    problem: ModalProblem<'_>,
    eigenproblem: Problem<'_>,
    modes: Modes,
    around: [Option<f64>; 2],
) -> Modes {
    let n_near = n_near(&modes, eigenproblem.operator.shift());
    let worst = |modes: &Modes| dense::worst(modes.errors[..n_near].iter().map(|error| error.backward));
    if n_near == 0 || worst(&modes) <= CARRIES_NOTHING {
        return modes;
    }
    let purified = slices::purified(eigenproblem, &modes, CARRIES_NOTHING);
    let purified = judged(problem, eigenproblem, purified, around);
    if worst(&purified) < worst(&modes) { purified } else { Modes { work: purified.work, ..modes } }
}

/// Modes of unit modal mass with their Rayleigh quotients and what is known of their errors; `around` as for the error bars.
fn judged(problem: ModalProblem<'_>, eigenproblem: Problem<'_>, pairs: Eigenpairs, around: [Option<f64>; 2]) -> Modes {
    let mut shapes = pairs.vectors;
    quality::normalise(problem.mass, &mut shapes);
    let (mut lambda, mut errors, mut residuals) = quality::rayleigh_quotients(problem, shapes.as_ref());
    let repeated = cluster::repeated(&lambda, &errors);
    if !repeated.is_empty() {
        cluster::canonicalise(problem.mass, &repeated, &mut shapes);
        (lambda, errors, residuals) = quality::rayleigh_quotients(problem, shapes.as_ref());
        cluster::average(&repeated, &mut lambda, &mut errors);
    }
    quality::add_residual_bars(eigenproblem, &lambda, &mut errors, residuals, around);
    let work = EigenWork { solves: pairs.work.solves + lambda.len(), ..pairs.work };
    Modes { lambda, shapes, errors, searched_to: None, next: pairs.next, counts: Vec::new(), work }
}

#[cfg(feature = "arpack")]
fn by_arpack(problem: Problem<'_>, request: ModeRequest) -> Result<Eigenpairs> {
    arpack::arpack(problem, request.wanted, request.seed)
}

#[cfg(not(feature = "arpack"))]
fn by_arpack(_: Problem<'_>, _: ModeRequest) -> Result<Eigenpairs> {
    Err(crate::error::Error::EigensolverMissing)
}

/// Eigenpairs between two shifts, around the shift of the operator, ascending.
fn pairs_between(problem: Problem<'_>, interval: Interval, solver: (Eigensolver, u64)) -> Result<Eigenpairs> {
    let (eigensolver, seed) = solver;
    let pairs = match eigensolver {
        Eigensolver::Lanczos => lanczos_between(problem, interval, seed),
        #[cfg(feature = "arpack")]
        Eigensolver::Arpack => arpack::arpack_between(problem, interval, seed),
        #[cfg(not(feature = "arpack"))]
        Eigensolver::Arpack => Err(crate::error::Error::EigensolverMissing),
    };
    pairs.map(Eigenpairs::ascending)
}
