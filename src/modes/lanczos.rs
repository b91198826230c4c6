//! Block Lanczos for K x = λ M x, with shift-invert, M-orthogonalisation against all of V, thick restart and locking.
//!
//! ```text
//! OP = P (K − σM)⁻¹ Pᵀ M     n × n    symmetric in the M-inner product, P = I − Q QᵀM takes out the rigid-body modes
//! V                          n × m    VᵀMV = I
//! T = VᵀM OP V               m × m    Ritz pairs (θ, s): λ = σ + 1/θ, x = V s
//! OP V = V T + W B           W the next block (n × b), B its coupling (b × m); ‖B s‖ is the residual of a Ritz pair
//! ```
//! T is formed from what orthogonalisation takes out, so that after a restart the kept Ritz vectors simply are the basis. Its first pass
//! knows from the recurrence what a block has of the block before it, Bᵀ, and that it has nothing of older ones; later passes measure
//! and correct that. A wanted cluster is never cut, and one pair beyond the wanted ones is found too, so
//! that a Sturm count can be taken in the gap between them.

use faer::{Mat, MatRef};

use super::answer::Goal;
use super::block_width::block_width;
use super::columns::Columns;
use super::eigenproblem::{CLUSTER_GAP, EigenWork, Eigenpairs, Interval, Problem, Wanted, is_above};
use super::orthogonalisation::combine_in_place;
use super::ritz::Ritz;
use crate::dense;
use crate::error::Result;
use crate::random::SplitMix64;
use crate::sparse::product;

/// Restarts after which an iteration that has not converged never will.
pub(super) const MAX_RESTARTS: usize = 60;
/// Modes expected in a band before they are counted.
const EXPECTED_IN_BAND: usize = 16;
/// The share of the basis by which it grows before convergence is looked at again; less than a block for sixty columns.
const STEPS_BETWEEN_LOOKS: usize = 16;

/// Finds the wanted eigenpairs.
///
/// # Errors
/// [`crate::error::Error::LanczosStalled`] when restarts bring no more convergence.
pub fn lanczos(problem: Problem<'_>, wanted: Wanted, seed: u64) -> Result<Eigenpairs> {
    run(problem, Goal::Lowest(wanted), seed)
}

/// Finds the eigenpairs between two shifts with a shift between them; what it returns may be less than the count says where
/// the space of the start vectors holds no more.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub fn lanczos_between(problem: Problem<'_>, interval: Interval, seed: u64) -> Result<Eigenpairs> {
    run(problem, Goal::Between(interval), seed)
}

fn run(problem: Problem<'_>, goal: Goal, seed: u64) -> Result<Eigenpairs> {
    let mut basis = Basis::start(problem, goal, seed);
    loop {
        while basis.has_room() {
            basis.extend();
            if let Some((ritz, taken)) = basis.converged(goal)? {
                if matches!(goal, Goal::Between(_)) || !basis.may_lack_copies(&ritz, taken.len()) {
                    return Ok(basis.extract(&ritz, &taken));
                }
                basis.start_again_beside(&ritz, taken.len());
            }
            if basis.is_exhausted() {
                return basis.everything(goal);
            }
        }
        if basis.work.restarts == MAX_RESTARTS {
            return basis.stalled(goal);
        }
        basis.restart(goal)?;
    }
}

pub(super) struct Basis<'a> {
    pub(super) problem: Problem<'a>,
    pub(super) random: SplitMix64,
    /// V followed by W.
    pub(super) vectors: Columns,
    /// M W, kept for the next application of OP.
    pub(super) mass_next: Mat<f64>,
    /// T.
    pub(super) projected: Mat<f64>,
    /// B, b × m.
    pub(super) coupling: Mat<f64>,
    /// m: columns of V.
    pub(super) size: usize,
    /// The first column of V that OP W couples to by its recurrence.
    pub(super) recent: usize,
    /// Leading columns of V that are locked: their coupling is zero.
    locked: usize,
    /// Largest m.
    capacity: usize,
    /// Random start vectors so far.
    n_starts: usize,
    /// m from which convergence is looked at next.
    look_at: usize,
    pub(super) work: EigenWork,
}

impl<'a> Basis<'a> {
    fn start(problem: Problem<'a>, goal: Goal, seed: u64) -> Self {
        let n = problem.operator.n();
        let expected = match goal {
            Goal::Lowest(Wanted::Count(count)) | Goal::Between(Interval { count, .. }) => count,
            Goal::Lowest(Wanted::UpTo(_)) => EXPECTED_IN_BAND,
        };
        let block = block_width(n, problem.operator.bytes(), expected);
        let capacity = capacity_for(expected, block, n);
        let mut basis = Self {
            problem,
            random: SplitMix64::new(seed),
            vectors: Columns::zeros(n, capacity + block),
            mass_next: Mat::zeros(n, 0),
            projected: Mat::zeros(0, 0),
            coupling: Mat::zeros(0, 0),
            size: 0,
            recent: 0,
            locked: 0,
            capacity,
            n_starts: 0,
            look_at: 0,
            work: EigenWork::default(),
        };
        basis.begin(block);
        basis
    }

    /// Makes W a random block M-orthogonal to V.
    fn begin(&mut self, block: usize) {
        let mut first = Mat::zeros(self.vectors.nrows(), block);
        self.random.fill(first.as_mut());
        // One application of OP removes what M does not see and the directions of very high frequency.
        self.problem.deflate(first.as_mut());
        let mut image = product(self.problem.mass, first.as_ref());
        self.apply(&mut image);
        self.recent = 0;
        let coupled = self.coupled_to_all(&image);
        let (_, _) = self.orthonormalise(image, coupled);
        self.n_starts += block;
    }

    pub(super) fn n_next(&self) -> usize {
        self.mass_next.ncols()
    }

    fn has_room(&self) -> bool {
        self.size + self.n_next() <= self.capacity
    }

    pub(super) fn is_exhausted(&self) -> bool {
        self.n_next() == 0
    }

    pub(super) fn v(&self) -> MatRef<'_, f64> {
        self.vectors.as_ref().subcols(0, self.size)
    }

    /// Replaces M v by OP v.
    pub(super) fn apply(&mut self, block: &mut Mat<f64>) {
        self.work.solves += block.ncols();
        self.problem.apply(block.as_mut());
    }

    /// One block step: V grows by W, a new W is found.
    fn extend(&mut self) {
        let block = self.n_next();
        let mass_last = std::mem::replace(&mut self.mass_next, Mat::zeros(0, 0));
        let mut image = mass_last.clone();
        self.apply(&mut image);
        self.work.steps += 1;
        let before = self.size;
        self.size += block;
        let coupled =
            if self.recent > 0 { self.coupled_by_recurrence(&mass_last, &image) } else { self.coupled_to_all(&image) };
        let (mut coefficients, coupling) = self.orthonormalise(image, coupled);
        self.recent = before;
        // Locked pairs are exact to the tolerance; their coupling is rounding and would unlock them.
        coefficients.as_mut().subrows_mut(0, self.locked).fill(0.0);
        let mut projected = Mat::zeros(self.size, self.size);
        projected.as_mut().submatrix_mut(0, 0, before, before).copy_from(&self.projected);
        projected.as_mut().subcols_mut(before, block).copy_from(&coefficients);
        for j in before..self.size {
            for i in 0..before {
                projected[(j, i)] = projected[(i, j)];
            }
        }
        let own = projected.as_ref().submatrix(before, before, block, block).to_owned();
        for j in 0..block {
            for i in 0..block {
                projected[(before + i, before + j)] = 0.5 * (own[(i, j)] + own[(j, i)]);
            }
        }
        self.projected = projected;
        self.coupling = Mat::zeros(coupling.nrows(), self.size);
        self.coupling.as_mut().subcols_mut(before, block).copy_from(&coupling);
    }

    pub(super) fn ritz(&self) -> Result<Ritz> {
        let (ascending, vectors) = dense::symmetric_eigen(self.projected.as_ref())?;
        let m = ascending.len();
        let mut order: Vec<usize> = (0..m).rev().collect();
        order.sort_by(|a, b| ascending[*b].abs().total_cmp(&ascending[*a].abs()));
        let s = dense::columns(vectors.as_ref(), &order);
        let coupled = dense::product(self.coupling.as_ref(), s.as_ref());
        let residuals = (0..m).map(|j| dense::norm(dense::column(coupled.as_ref(), j))).collect();
        Ok(Ritz { theta: order.iter().map(|j| ascending[*j]).collect(), s, residuals })
    }

    /// The Ritz pairs and which of them are the answer, once they have converged, and the one beyond too.
    fn converged(&mut self, goal: Goal) -> Result<Option<(Ritz, Vec<usize>)>> {
        let at_least = match goal {
            Goal::Lowest(Wanted::Count(count)) => count + 1,
            Goal::Lowest(Wanted::UpTo(_)) => 0,
            Goal::Between(interval) => interval.count,
        };
        if self.size < self.look_at.max(at_least) {
            return Ok(None);
        }
        // Ritz pairs cost m³ and a wide basis is not worth looking at after every block.
        self.look_at = self.size + self.size / STEPS_BETWEEN_LOOKS;
        let ritz = self.ritz()?;
        let sigma = self.problem.operator.shift();
        let taken = match goal {
            Goal::Lowest(wanted) => ritz.count_wanted(wanted, sigma).map(|count| (0..count).collect()),
            Goal::Between(interval) => ritz.inside(interval, sigma),
        };
        Ok(taken.map(|taken| (ritz, taken)))
    }

    /// Whether a wanted cluster has as many members as start vectors were used: each finds one copy of a multiple
    /// eigenvalue, and further copies come from rounding alone.
    fn may_lack_copies(&self, ritz: &Ritz, count: usize) -> bool {
        let theta = &ritz.theta[..count];
        (self.n_starts..=count).any(|end| theta[end - self.n_starts] - theta[end - 1] <= CLUSTER_GAP * theta[end - 1])
    }

    /// Locks the wanted pairs and starts a new block in the space M-orthogonal to them, where missing copies come first
    /// and the pair beyond the wanted ones follows.
    fn start_again_beside(&mut self, ritz: &Ritz, count: usize) {
        let block = self.n_next();
        combine_in_place(self.vectors.as_mut(), self.size, ritz.s.as_ref().subcols(0, count));
        self.size = count;
        self.locked = count;
        self.projected = Mat::from_fn(count, count, |i, j| if i == j { ritz.theta[i] } else { 0.0 });
        self.begin(block);
        self.coupling = Mat::zeros(self.n_next(), count);
    }

    /// Replaces V by its best Ritz vectors, or makes room where a band turns out to hold many modes.
    fn restart(&mut self, goal: Goal) -> Result<()> {
        let ritz = self.ritz()?;
        let (n, block) = (self.vectors.nrows(), self.n_next());
        let sigma = self.problem.operator.shift();
        let n_wanted = match goal {
            Goal::Lowest(Wanted::Count(count)) => count,
            Goal::Lowest(Wanted::UpTo(limit)) => {
                (0..ritz.n_finite()).take_while(|j| !is_above(ritz.lambda(*j, sigma), limit)).count()
            }
            Goal::Between(interval) => ritz.n_within_reach(interval, sigma),
        };
        self.look_at = 0;
        let capacity = capacity_for(n_wanted, block, n);
        if capacity > self.capacity {
            self.vectors.grow(capacity + block);
            self.capacity = capacity;
            return Ok(());
        }
        self.work.restarts += 1;
        let keep = (n_wanted + (self.size - n_wanted.min(self.size)) / 2).min(self.size.saturating_sub(block)).max(1);
        self.locked = (0..keep).take_while(|j| ritz.is_converged(*j)).count();
        let s = ritz.s.as_ref().subcols(0, keep);
        combine_in_place(self.vectors.as_mut(), self.size, s);
        let next = self.vectors.as_ref().subcols(self.size, block).to_owned();
        self.vectors.as_mut().subcols_mut(keep, block).copy_from(&next);
        self.coupling = dense::product(self.coupling.as_ref(), s);
        self.coupling.as_mut().subcols_mut(0, self.locked).fill(0.0);
        self.projected = Mat::from_fn(keep, keep, |i, j| if i == j { ritz.theta[i] } else { 0.0 });
        self.size = keep;
        self.recent = 0;
        Ok(())
    }
}

/// Columns of V before a restart: four times the wanted ones and eight blocks converge fifty modes without one.
fn capacity_for(n_wanted: usize, block: usize, n: usize) -> usize {
    (4 * n_wanted + 8 * block).min(n)
}
