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
//!
//! The file is longer than most: an iteration is one type, and its steps are not understood apart.

use faer::{Mat, MatRef};
use rayon::prelude::*;

use super::block_width::block_width;
use super::columns::Columns;
use super::orthogonalisation::{combine_in_place, mass_qr};
use super::problem::{CLUSTER_GAP, EigenWork, Eigenpairs, Interval, Problem, Wanted, is_above, mass_norm};
use super::ritz::{Goal, ROUNDING, Ritz};
use crate::dense;
use crate::error::{Error, Result};
use crate::random::SplitMix64;
use crate::sparse::{absolute_energy, product};
use crate::tally;

/// Restarts after which an iteration that has not converged never will.
const MAX_RESTARTS: usize = 60;
/// Restarts after which it is looked at whether residuals are rounding: more than any iteration takes whose residuals still fall.
const MANY_RESTARTS: usize = 20;
/// Modes expected in a band before they are counted.
const EXPECTED_IN_BAND: usize = 16;
/// The share of the basis by which it grows before convergence is looked at again; less than a block for sixty columns.
const STEPS_BETWEEN_LOOKS: usize = 16;
/// Share of its length that a column may lose to the columns before it while M times it is still good enough as it is carried
/// along: it loses one digit then.
const SHRINKS: f64 = 0.1;

/// Passes over V, the last one only where the one before left little of a column.
const MAX_PASSES: usize = 3;
/// Share of a unit column that is not rounding, where the first pass was not over all of V: half its digits.
const LEFT: f64 = 1e-8;
/// Share of a unit column that has to be left for its orthogonality to be that of rounding: twice is enough.
const MIN_ORTHOGONAL_SHARE: f64 = 0.5;
/// Share of a random direction outside a basis that is not rounding of taking the basis out: thousands of roundings.
const OUTSIDE: f64 = 1e-12;

/// Finds the wanted eigenpairs.
///
/// # Errors
/// [`Error::LanczosStalled`] when restarts bring no more convergence.
pub fn lanczos(problem: Problem<'_>, wanted: Wanted, seed: u64) -> Result<Eigenpairs> {
    run(problem, Goal::Lowest(wanted), seed)
}

/// Finds the eigenpairs between two shifts with a shift between them; what it returns may be less than the count says where
/// the space of the start vectors holds no more.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub fn lanczos_between(problem: Problem<'_>, interval: Interval, seed: u64) -> Result<Eigenpairs> {
    let found = run(problem, Goal::Between(interval), seed)?;
    tally::found(found.values.len());
    Ok(found)
}

fn run(problem: Problem<'_>, goal: Goal, seed: u64) -> Result<Eigenpairs> {
    let mut basis = KrylovBasis::start(problem, goal, seed);
    loop {
        while basis.has_room() {
            basis.extend();
            if let Some((ritz, taken)) = basis.converged(goal)? {
                // A whole space lacks no copies, and has no block to begin again with.
                let is_all = matches!(goal, Goal::Between(_)) || basis.is_exhausted();
                if is_all || !basis.may_lack_copies(&ritz, taken.len()) {
                    return Ok(basis.extract(&ritz, &taken));
                }
                basis.start_again_without(&ritz, taken.len());
            }
            if basis.is_exhausted() {
                return basis.everything(goal);
            }
        }
        if basis.work.restarts == MANY_RESTARTS
            && let Some(pairs) = basis.down_to_rounding(goal)?
        {
            return Ok(pairs);
        }
        if basis.work.restarts == MAX_RESTARTS {
            return basis.stalled(goal);
        }
        basis.restart(goal)?;
    }
}

/// V with the next block W, and what OP is on V.
struct KrylovBasis<'a> {
    problem: Problem<'a>,
    random: SplitMix64,
    /// V followed by W.
    vectors: Columns,
    /// M W, kept for the next application of OP.
    mass_next: Mat<f64>,
    /// T.
    projected: Mat<f64>,
    /// B, b × m.
    coupling: Mat<f64>,
    /// m: columns of V.
    size: usize,
    /// The first column of V that OP W couples to by its recurrence.
    recent: usize,
    /// Leading columns of V that are locked: their coupling is zero.
    locked: usize,
    /// Largest m.
    capacity: usize,
    /// Columns of W at first; later ones have fewer where the space comes to its end.
    block: usize,
    /// Random start vectors so far.
    n_starts: usize,
    /// m from which convergence is looked at next.
    look_at: usize,
    work: EigenWork,
}

impl<'a> KrylovBasis<'a> {
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
            block,
            n_starts: 0,
            look_at: 0,
            work: EigenWork::default(),
        };
        basis.begin(block);
        basis
    }

    /// Makes W a random block.
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

    /// Makes W a random block outside V, as wide as what is left there.
    fn begin_outside(&mut self) {
        let mut next = Mat::zeros(self.vectors.nrows(), self.block);
        let mut width = 0;
        while width < self.block
            && let Some(unit) = self.fresh(&next)
        {
            next.as_mut().subcols_mut(width, 1).copy_from(&unit);
            width += 1;
        }
        let next = next.as_ref().subcols(0, width);
        self.vectors.as_mut().subcols_mut(self.size, width).copy_from(next);
        self.mass_next = product(self.problem.mass, next);
        self.recent = 0;
        self.n_starts += width;
    }

    fn n_next(&self) -> usize {
        self.mass_next.ncols()
    }

    fn has_room(&self) -> bool {
        self.size + self.n_next() <= self.capacity
    }

    fn is_exhausted(&self) -> bool {
        self.n_next() == 0
    }

    fn v(&self) -> MatRef<'_, f64> {
        self.vectors.as_ref().subcols(0, self.size)
    }

    /// Replaces M v by OP v.
    fn apply(&mut self, block: &mut Mat<f64>) {
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

    fn ritz(&self) -> Result<Ritz> {
        let (ascending, vectors) = dense::symmetric_eigen(self.projected.as_ref())?;
        let m = ascending.len();
        let mut order: Vec<usize> = (0..m).rev().collect();
        order.sort_by(|a, b| ascending[*b].abs().total_cmp(&ascending[*a].abs()));
        let s = dense::columns(vectors.as_ref(), &order);
        let coupled = dense::product(self.coupling.as_ref(), s.as_ref());
        let residuals = (0..m).map(|j| dense::norm(dense::column(coupled.as_ref(), j))).collect();
        Ok(Ritz::new(order.iter().map(|j| ascending[*j]).collect(), s, residuals))
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
        if let Goal::Lowest(_) = goal {
            tally::converged((0..ritz.theta.len()).take_while(|j| ritz.is_converged(*j)).count());
        }
        let sigma = self.problem.operator.shift();
        Ok(ritz.answer(goal, sigma).map(|taken| (ritz, taken)))
    }

    /// The answer of an iteration that is no nearer to it after many restarts, where its residuals are what rounding of products with
    /// M leaves: a large mass far from the point that its motion is described at makes terms that nearly cancel.
    fn down_to_rounding(&self, goal: Goal) -> Result<Option<Eigenpairs>> {
        let (ritz, sigma) = (self.ritz()?, self.problem.operator.shift());
        let n_looked_at = (ritz.n_asked(goal, sigma) + 1).min(ritz.theta.len());
        let vectors = dense::product(self.v(), ritz.s.as_ref().subcols(0, n_looked_at));
        let terms = absolute_energy(self.problem.mass, vectors.as_ref());
        let ritz = ritz.beneath_terms(dense::worst(terms));
        Ok(ritz.answer(goal, sigma).map(|taken| self.extract(&ritz, &taken)))
    }

    /// Whether a wanted cluster has as many members as start vectors were used: each finds one copy of a multiple
    /// eigenvalue, and further copies come from rounding alone.
    fn may_lack_copies(&self, ritz: &Ritz, count: usize) -> bool {
        let theta = &ritz.theta[..count];
        (self.n_starts..=count).any(|end| theta[end - self.n_starts] - theta[end - 1] <= CLUSTER_GAP * theta[end - 1])
    }

    /// Locks the wanted pairs and starts a new block in the space M-orthogonal to them, where missing copies come first
    /// and the pair beyond the wanted ones follows.
    fn start_again_without(&mut self, ritz: &Ritz, count: usize) {
        combine_in_place(self.vectors.as_mut(), self.size, ritz.s.as_ref().subcols(0, count));
        self.size = count;
        self.locked = count;
        self.projected = Mat::from_fn(count, count, |i, j| if i == j { ritz.theta[i] } else { 0.0 });
        self.begin_outside();
        self.coupling = Mat::zeros(self.n_next(), count);
    }

    /// Replaces V by its best Ritz vectors, or makes room where a band or a cluster turns out to hold many modes.
    fn restart(&mut self, goal: Goal) -> Result<()> {
        let ritz = self.ritz()?;
        let (n, block) = (self.vectors.nrows(), self.n_next());
        let sigma = self.problem.operator.shift();
        let n_wanted = ritz.n_asked(goal, sigma);
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

impl KrylovBasis<'_> {
    /// All pairs of an exhausted space, as far as wanted.
    fn everything(&self, goal: Goal) -> Result<Eigenpairs> {
        let ritz = self.ritz()?;
        let sigma = self.problem.operator.shift();
        let n_finite = ritz.n_finite();
        let count = match goal {
            Goal::Between(interval) => {
                let inside: Vec<usize> = (0..n_finite).filter(|j| interval.holds(ritz.lambda(*j, sigma))).collect();
                return Ok(self.extract(&ritz, &inside));
            }
            Goal::Lowest(Wanted::Count(count)) => (0..n_finite)
                .find(|j| *j >= count && (*j == 0 || !ritz.same_cluster(*j - 1, *j, sigma)))
                .unwrap_or(n_finite),
            Goal::Lowest(Wanted::UpTo(limit)) => {
                (0..n_finite).find(|j| is_above(ritz.lambda(*j, sigma), limit)).unwrap_or(n_finite)
            }
        };
        Ok(self.extract(&ritz, &(0..count).collect::<Vec<_>>()))
    }

    /// The end of an iteration that makes no more progress: of an interval what has converged, of the lowest pairs nothing.
    fn stalled(&self, goal: Goal) -> Result<Eigenpairs> {
        let ritz = self.ritz()?;
        let converged: Vec<usize> = (0..ritz.theta.len()).filter(|j| ritz.is_converged(*j)).collect();
        match goal {
            Goal::Lowest(_) => Err(Error::LanczosStalled {
                restarts: MAX_RESTARTS,
                converged: converged.iter().enumerate().take_while(|(at, j)| at == *j).count(),
            }),
            Goal::Between(interval) => {
                let sigma = self.problem.operator.shift();
                let inside = converged.into_iter().filter(|j| interval.holds(ritz.lambda(*j, sigma)));
                Ok(self.extract(&ritz, &inside.collect::<Vec<_>>()))
            }
        }
    }

    /// x = V s + W B s / θ: the step of inverse iteration that the last block gives for nothing; an exhausted space has no such
    /// block, and the step costs a solve.
    fn extract(&self, ritz: &Ritz, taken: &[usize]) -> Eigenpairs {
        let sigma = self.problem.operator.shift();
        let s = dense::columns(ritz.s.as_ref(), taken);
        let over_theta = |block: &mut Mat<f64>| {
            for (j, pair) in taken.iter().enumerate() {
                block.as_mut().col_mut(j).iter_mut().for_each(|value| *value /= ritz.theta[*pair]);
            }
        };
        let (mut vectors, mut work) = (dense::product(self.v(), s.as_ref()), self.work);
        if self.is_exhausted() {
            // Orthonormalising a whole space blows up from rounding what M hardly sees.
            work.solves += taken.len();
            vectors = self.problem.step(vectors.as_ref());
            over_theta(&mut vectors);
            self.problem.orthonormalise(&mut vectors);
        } else {
            let mut correction = dense::product(self.coupling.as_ref(), s.as_ref());
            over_theta(&mut correction);
            let next = self.vectors.as_ref().subcols(self.size, self.n_next());
            dense::add_product(vectors.as_mut(), 1.0, next, correction.as_ref());
        }
        self.problem.deflate(vectors.as_mut());
        let beyond = taken.len();
        Eigenpairs {
            values: taken.iter().map(|j| ritz.lambda(*j, sigma)).collect(),
            vectors,
            next: (beyond < ritz.n_finite()).then(|| ritz.lambda(beyond, sigma)),
            work,
        }
    }
}

/// What a block has of the columns of V, before anything is taken out of it.
struct Coupled {
    /// The first column that it has anything of but rounding.
    from: usize,
    /// The shares of the columns from there on.
    shares: Mat<f64>,
    /// Length below which a column of the block is rounding.
    floor: f64,
}

impl KrylovBasis<'_> {
    /// Makes a block M-orthogonal to V and M-orthonormal in itself: block = V C + W B. Stores W and M W.
    ///
    /// The first pass takes out `start` and normalises, however small the columns are; the second, on columns of unit length,
    /// takes out what rounding left along all of V. Errors of a solve lie along the lowest modes and grow with the condition of
    /// K: where they made up most of a column, there is a third pass.
    fn orthonormalise(&mut self, mut block: Mat<f64>, start: Coupled) -> (Mat<f64>, Mat<f64>) {
        let width = block.ncols();
        let mut known = Some(start.shares);
        let mut coefficients = Mat::zeros(self.size, width);
        let mut coupling: Mat<f64> = Mat::identity(width, width);
        let mut mass_block = Mat::zeros(0, 0);
        let mut dependent = vec![false; width];
        for pass in 0..MAX_PASSES {
            let (from, least) = match pass {
                0 => (start.from, start.floor),
                1 if start.from > 0 => (0, LEFT),
                _ => (0, MIN_ORTHOGONAL_SHARE),
            };
            let basis = self.v().subcols(from, self.size - from);
            let c = known.take().unwrap_or_else(|| dense::gram(basis, mass_block.as_ref()));
            dense::add_product(block.as_mut(), -1.0, basis, c.as_ref());
            dense::add_product(coefficients.as_mut().subrows_mut(from, c.nrows()), 1.0, c.as_ref(), coupling.as_ref());
            // What was blown up took its rounding along: rigid-body motion, and the difference between M W and what is carried.
            self.problem.deflate(block.as_mut());
            mass_block = product(self.problem.mass, block.as_ref());
            let r = mass_qr(&mut block, &mut mass_block, least, &mut dependent);
            coupling = dense::product(r.as_ref(), coupling.as_ref());
            if pass > 0 && (0..width).all(|j| dependent[j] || r[(j, j)] > MIN_ORTHOGONAL_SHARE) {
                break;
            }
            if shrinks(&r) {
                mass_block = product(self.problem.mass, block.as_ref());
            }
        }
        self.replace_dependent(&mut block, &dependent);
        let kept: Vec<usize> = (0..width).filter(|j| !dependent[*j] || self.holds(block.as_ref(), *j)).collect();
        let coupling = Mat::from_fn(kept.len(), width, |i, j| coupling[(kept[i], j)]);
        let next = self.vectors.as_mut().subcols_mut(self.size, kept.len());
        next.par_col_iter_mut().zip(&kept).for_each(|(mut column, j)| column.copy_from(block.col(*j)));
        let next = self.vectors.as_ref().subcols(self.size, kept.len());
        let is_carried = dependent.iter().all(|dependent| !dependent);
        self.mass_next = if is_carried { mass_block } else { product(self.problem.mass, next) };
        (coefficients, coupling)
    }

    /// What a block has of all of V, by inner products.
    fn coupled_to_all(&self, block: &Mat<f64>) -> Coupled {
        let mass_block = product(self.problem.mass, block.as_ref());
        let own = (0..block.ncols()).fold(0.0f64, |max, j| {
            let square = dense::dot(dense::column(block.as_ref(), j), dense::column(mass_block.as_ref(), j));
            max.max(square.max(0.0).sqrt())
        });
        let floor = f64::EPSILON * self.largest_diagonal().max(own);
        Coupled { from: 0, shares: dense::gram(self.v(), mass_block.as_ref()), floor }
    }

    /// What OP W has of V, W the last columns of V and `mass_last` M W. By its recurrence OP W couples to W and to the block
    /// before W alone, and to that one by Bᵀ = (OP V)ᵀ M W: neither asks for M OP W.
    fn coupled_by_recurrence(&self, mass_last: &Mat<f64>, image: &Mat<f64>) -> Coupled {
        let before = self.size - mass_last.ncols();
        let to_previous = self.coupling.as_ref().subcols(self.recent, before - self.recent).transpose();
        let mut shares = Mat::zeros(self.size - self.recent, image.ncols());
        shares.as_mut().subrows_mut(0, before - self.recent).copy_from(to_previous);
        let to_last = dense::gram(mass_last.as_ref(), image.as_ref());
        shares.as_mut().subrows_mut(before - self.recent, mass_last.ncols()).copy_from(&to_last);
        let own = (0..to_last.ncols().min(to_last.nrows())).fold(0.0f64, |max, j| max.max(to_last[(j, j)].abs()));
        Coupled { from: self.recent, shares, floor: f64::EPSILON * self.largest_diagonal().max(own) }
    }

    fn largest_diagonal(&self) -> f64 {
        (0..self.projected.nrows()).fold(0.0f64, |max, i| max.max(self.projected[(i, i)].abs()))
    }

    fn holds(&self, block: MatRef<'_, f64>, j: usize) -> bool {
        dense::column(block, j).iter().any(|value| *value != 0.0)
    }

    /// Puts new random directions in the place of dependent columns, or zeros where the space is exhausted.
    fn replace_dependent(&mut self, block: &mut Mat<f64>, dependent: &[bool]) {
        const ATTEMPTS: usize = 3;
        for j in (0..block.ncols()).filter(|j| dependent[*j]) {
            dense::column_mut(block.as_mut(), j).fill(0.0);
            for _ in 0..ATTEMPTS {
                if let Some(unit) = self.fresh(block) {
                    block.as_mut().subcols_mut(j, 1).copy_from(&unit);
                    break;
                }
            }
        }
    }

    /// What OP makes of a random direction outside V and a block, at unit length and outside them too; none where nothing is left.
    ///
    /// The direction leaves V before OP is applied. Of one that has parts along the lowest modes OP would leave little else: where the
    /// last modes lie 10⁸ times higher, or move dofs of little mass, they would be taken for rounding.
    fn fresh(&mut self, block: &Mat<f64>) -> Option<Mat<f64>> {
        let mut direction = Mat::zeros(self.vectors.nrows(), 1);
        self.random.fill(direction.as_mut());
        self.problem.deflate(direction.as_mut());
        let least = OUTSIDE * mass_norm(self.problem.mass, &direction);
        let direction = self.unit_component(direction, block, least)?;
        let mut image = product(self.problem.mass, direction.as_ref());
        self.apply(&mut image);
        // A θ below the rounding of OP is that of an infinite eigenvalue.
        self.unit_component(image, block, ROUNDING * f64::EPSILON * self.largest_diagonal())
    }

    /// The part of a vector M-orthogonal to V and to the block, at unit length; none where no more than `least` of it is left.
    fn unit_component(&self, mut vector: Mat<f64>, block: &Mat<f64>, least: f64) -> Option<Mat<f64>> {
        for pass in 0..3 {
            for basis in [self.v(), block.as_ref()] {
                let c = dense::gram(basis, product(self.problem.mass, vector.as_ref()).as_ref());
                dense::add_product(vector.as_mut(), -1.0, basis, c.as_ref());
            }
            let length = mass_norm(self.problem.mass, &vector);
            if length.is_nan() || length <= if pass == 0 { least } else { MIN_ORTHOGONAL_SHARE } {
                return None;
            }
            vector.as_mut().col_mut(0).iter_mut().for_each(|value| *value /= length);
        }
        Some(vector)
    }
}

/// Whether a column lost so much to those before it that M times it, which was carried along, lost digits; `r` is their triangle.
fn shrinks(r: &Mat<f64>) -> bool {
    (0..r.ncols()).any(|j| r[(j, j)] < SHRINKS * dense::norm(dense::column(r.as_ref(), j)))
}

/// Columns of V before a restart: four times the wanted ones and eight blocks converge fifty modes without one.
fn capacity_for(n_wanted: usize, block: usize, n: usize) -> usize {
    (4 * n_wanted + 8 * block).min(n)
}
