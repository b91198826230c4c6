//! ARPACK-NG behind the same operator: a second eigensolver that shares nothing with [`super::lanczos`] but P, K and M.
//!
//! ```text
//! OP = s P (K − σM)⁻¹ Pᵀ M   n × n     symmetric in the M-inner product; s a power of two, see `TARGET`
//! P  = I − [Q X] [Q X]ᵀM               takes out the rigid-body modes Q and the modes X found so far
//! V                          n × ncv   the basis of one sweep, OP V ≈ V T; θ = s/(λ − σ)
//! ```
//! A single start vector contains one copy of a multiple eigenvalue; other copies appear only by rounding. Modes are therefore
//! found in sweeps: each deflates what the ones before have found, and the search ends when the largest θ of a sweep
//! lies beyond the wanted ones. Infinite eigenvalues have θ = 0 and are never returned.
//!
//! ARPACK keeps state between calls in static variables: the lock [`STATE`] lets one search run at a time in the whole
//! process.

mod sweep;

use std::sync::{Mutex, PoisonError};

use faer::{Mat, MatMut, MatRef};

use super::problem::{EigenWork, Eigenpairs, Interval, Problem, Wanted, are_clustered, is_above, mass_norm};
use super::ritz::{RESIDUAL_FLOOR, ROUNDING, TOLERANCE};
use super::rows_with_mass;
use crate::dense;
use crate::error::{Error, Result};
use crate::random::SplitMix64;
use crate::sparse::product;

use sweep::{Call, Request, Sweep};

static STATE: Mutex<()> = Mutex::new(());

/// (2⁻⁵³)^⅔, below which ARPACK measures residuals absolutely.
const ARPACK_FLOOR: f64 = 2.309_9e-11;
/// Where s puts the largest θ. ARPACK takes a pair at a residual of TOLERANCE · max(θ, ARPACK_FLOOR); with the largest θ
/// here, the floor is [`RESIDUAL_FLOOR`] ε times the largest θ, as in the Lanczos iteration.
const TARGET: f64 = TOLERANCE * ARPACK_FLOOR / (RESIDUAL_FLOOR * f64::EPSILON);
/// Modes asked for beyond the wanted ones, and the least a sweep asks for.
const SPARE: usize = 4;
/// Modes asked for first in a band; what has been found is doubled after that.
const FIRST_IN_BAND: usize = 16;
/// ARPACK's status for a start vector without use.
const BAD_START: i32 = -9;
/// ARPACK's status for a basis that could not be built to its full width.
const NO_BASIS: i32 = -9999;
/// ARPACK's status for a restart that found no direction to leave out.
const NO_SHIFTS: i32 = 3;

/// Finds the wanted eigenpairs, with the meaning of [`super::lanczos::lanczos`].
///
/// # Errors
/// [`Error::Arpack`] with ARPACK's own status.
pub(super) fn arpack(problem: Problem<'_>, wanted: Wanted, seed: u64) -> Result<Eigenpairs> {
    alone(|| Search::new(problem, seed).run(wanted))
}

/// Finds the eigenpairs between two shifts, with the meaning of [`super::lanczos::lanczos_between`].
///
/// # Errors
/// [`Error::Arpack`] with ARPACK's own status.
pub(super) fn arpack_between(problem: Problem<'_>, interval: Interval, seed: u64) -> Result<Eigenpairs> {
    alone(|| Search::new(problem, seed).run_between(interval))
}

/// Runs a search while no other runs.
fn alone(search: impl FnOnce() -> Result<Eigenpairs> + Send) -> Result<Eigenpairs> {
    // A thread that waits inside a parallel product takes up other work, possibly another search, which would wait for
    // the lock for ever. Threads of its own have no other work.
    let threads = rayon::ThreadPoolBuilder::new().num_threads(rayon::current_num_threads()).build();
    let threads = threads.map_err(|_| Error::OutOfMemory { what: "the threads of ARPACK" })?;
    threads.install(|| {
        let _alone = STATE.lock().unwrap_or_else(PoisonError::into_inner);
        search()
    })
}

/// Everything found so far.
struct Search<'a> {
    problem: Problem<'a>,
    random: SplitMix64,
    /// Number of finite eigenvalues, at most.
    n_finite: usize,
    /// [Q X], the modes found so far behind the rigid-body modes.
    taken: Mat<f64>,
    /// M [Q X].
    mass_taken: Mat<f64>,
    /// 1/(λ − σ) of each column of X.
    theta: Vec<f64>,
    /// s, once it is known.
    scale: Option<f64>,
    work: EigenWork,
}

impl<'a> Search<'a> {
    fn new(problem: Problem<'a>, seed: u64) -> Self {
        let [q, mass_q] = problem.deflated;
        Self {
            problem,
            random: SplitMix64::new(seed),
            n_finite: rows_with_mass(problem.mass).saturating_sub(q.ncols()),
            taken: q.to_owned(),
            mass_taken: mass_q.to_owned(),
            theta: Vec::new(),
            scale: None,
            work: EigenWork::default(),
        }
    }

    fn run(mut self, wanted: Wanted) -> Result<Eigenpairs> {
        loop {
            let n_found = self.theta.len();
            let n_asked = match wanted {
                Wanted::Count(count) => (count + SPARE).saturating_sub(n_found).max(SPARE),
                Wanted::UpTo(_) => n_found.max(FIRST_IN_BAND),
            };
            self.sweep(n_asked)?;
            // All that is still missing has a θ no larger than the largest one this sweep has found.
            let complete_above = self.theta[n_found..].iter().copied().reduce(f64::max);
            if let Some(found) = self.answer(wanted, complete_above) {
                return Ok(found);
            }
        }
    }

    /// Sweeps until the interval is full or the nearest pair of a sweep lies beyond both of its ends.
    fn run_between(mut self, interval: Interval) -> Result<Eigenpairs> {
        let sigma = self.problem.operator.shift();
        let reach = (interval.to - sigma).max(sigma - interval.from);
        loop {
            let n_found = self.theta.len();
            let lambda: Vec<f64> = self.theta.iter().map(|theta| sigma + 1.0 / theta).collect();
            let inside: Vec<usize> = (0..n_found).filter(|j| interval.holds(lambda[*j])).collect();
            if inside.len() < interval.count {
                self.sweep(interval.count - inside.len() + SPARE)?;
            }
            // What is still missing then lies no nearer to the shift than the nearest pair of the sweep.
            if !self.theta[n_found..].iter().any(|theta| 1.0 / theta.abs() <= reach) {
                return Ok(Eigenpairs {
                    values: inside.iter().map(|j| lambda[*j]).collect(),
                    vectors: self.vectors(&inside),
                    next: None,
                    work: self.work,
                });
            }
        }
    }

    /// The modes with these numbers in the order they were found.
    fn vectors(&self, modes: &[usize]) -> Mat<f64> {
        let n_deflated = self.problem.deflated[0].ncols();
        Mat::from_fn(self.taken.nrows(), modes.len(), |i, j| self.taken[(i, n_deflated + modes[j])])
    }

    /// The problem with everything taken out that has been found.
    fn remaining(&self) -> Problem<'_> {
        Problem { deflated: [self.taken.as_ref(), self.mass_taken.as_ref()], ..self.problem }
    }

    /// Replaces M x by OP x, without s.
    fn apply(&mut self, block: MatMut<'_, f64>) {
        self.work.solves += 1;
        self.work.steps += 1;
        self.remaining().apply(block);
    }

    /// A random vector after one application of OP, at unit length, and how long OP makes it, negative where it turns it
    /// round; none where only rounding is left.
    fn start(&mut self) -> Result<Option<(Mat<f64>, f64)>> {
        let mass = self.problem.mass;
        let mut vector = Mat::zeros(mass.rows(), 1);
        self.random.fill(vector.as_mut());
        self.remaining().deflate(vector.as_mut());
        let (mut length, mut sign) = (mass_norm(mass, &vector), 1.0);
        let largest = self.theta.iter().fold(0.0, |max: f64, theta| max.max(theta.abs()));
        for _ in 0..2 {
            vector.as_mut().col_mut(0).iter_mut().for_each(|value| *value /= length);
            let momentum = product(mass, vector.as_ref());
            let mut image = momentum.clone();
            self.apply(image.as_mut());
            let stretched = mass_norm(mass, &image);
            if !stretched.is_finite() {
                return Err(Error::Arpack { status: BAD_START, converged: self.theta.len() });
            }
            if stretched <= ROUNDING * f64::EPSILON * largest {
                return Ok(None);
            }
            sign = dense::gram(momentum.as_ref(), image.as_ref())[(0, 0)].signum();
            (vector, length) = (image, stretched);
        }
        vector.as_mut().col_mut(0).iter_mut().for_each(|value| *value /= length);
        Ok(Some((vector, sign * length)))
    }

    /// Finds up to `n_asked` more modes, at least one unless none is left.
    fn sweep(&mut self, n_asked: usize) -> Result<()> {
        let room = self.n_finite.saturating_sub(self.theta.len());
        if room == 0 {
            return Ok(());
        }
        let Some((start, stretch)) = self.start()? else {
            return Ok(());
        };
        let scale = *self.scale.get_or_insert_with(|| 2f64.powi((TARGET / stretch.abs()).log2().round() as i32));
        if room == 1 {
            // The last direction left is the mode; ARPACK wants two.
            self.take(start.as_ref(), &[stretch]);
            return Ok(());
        }
        // Half of what is left, so that restarts keep room to clear the basis of rounding.
        let mut sweep = Sweep::new(start, n_asked.min(room / 2), room)?;
        match self.drive(&mut sweep, scale) {
            // Rows with mass are more than M has rank, and the basis has come to its end before.
            Err(Error::Arpack { status: NO_BASIS, .. }) if (1..room).contains(&sweep.n_vectors()) => {
                self.n_finite = self.theta.len() + sweep.n_vectors();
                return self.sweep(n_asked);
            }
            // The whole of what seems to be left is the basis, and less than that has mass.
            Err(Error::Arpack { status: NO_SHIFTS, .. }) if n_asked >= room / 2 => {
                self.n_finite -= 1;
                return self.sweep(n_asked);
            }
            driven => driven?,
        }
        self.work.restarts += sweep.n_restarts();
        let (reciprocals, vectors) = sweep.eigenpairs()?;
        let theta: Vec<f64> = reciprocals.iter().map(|reciprocal| 1.0 / (reciprocal * scale)).collect();
        self.take(vectors.as_ref(), &theta);
        Ok(())
    }

    /// Answers the requests of a run until it is done.
    fn drive(&mut self, sweep: &mut Sweep, scale: f64) -> Result<()> {
        while let Some(Call { request, source, target }) = sweep.next()? {
            let source = Mat::from_fn(source.len(), 1, |i, _| source[i]);
            let mut result = match request {
                Request::Mass | Request::Operator => product(self.problem.mass, source.as_ref()),
                Request::OperatorOfProduct => source,
            };
            if request != Request::Mass {
                self.apply(result.as_mut());
                result.as_mut().col_mut(0).iter_mut().for_each(|value| *value *= scale);
            }
            target.copy_from_slice(dense::column(result.as_ref(), 0));
        }
        Ok(())
    }

    fn take(&mut self, vectors: MatRef<'_, f64>, theta: &[f64]) {
        let mut vectors = vectors.to_owned();
        self.remaining().deflate(vectors.as_mut());
        self.mass_taken =
            dense::side_by_side(self.mass_taken.as_ref(), product(self.problem.mass, vectors.as_ref()).as_ref());
        self.taken = dense::side_by_side(self.taken.as_ref(), vectors.as_ref());
        self.theta.extend_from_slice(theta);
    }

    /// The wanted pairs, once all of them and the one beyond are known; all pairs once none is missing.
    fn answer(&self, wanted: Wanted, complete_above: Option<f64>) -> Option<Eigenpairs> {
        let mut order: Vec<usize> = (0..self.theta.len()).collect();
        order.sort_by(|a, b| self.theta[*b].total_cmp(&self.theta[*a]));
        let sigma = self.problem.operator.shift();
        let lambda: Vec<f64> = order.iter().map(|j| sigma + 1.0 / self.theta[*j]).collect();
        let beyond = match wanted {
            Wanted::Count(count) => count,
            Wanted::UpTo(limit) => lambda.iter().position(|lambda| is_above(*lambda, limit)).unwrap_or(lambda.len()),
        };
        let mut count = beyond.min(lambda.len());
        while count > 0 && count < lambda.len() && are_clustered(lambda[count - 1], lambda[count]) {
            count += 1;
        }
        let n_complete = match complete_above {
            Some(theta) => order.iter().take_while(|j| self.theta[**j] > theta).count(),
            None => lambda.len(),
        };
        if count > n_complete || (count == lambda.len() && complete_above.is_some()) {
            return None;
        }
        Some(Eigenpairs {
            vectors: self.vectors(&order[..count]),
            next: lambda.get(count).copied(),
            values: lambda[..count].to_vec(),
            work: self.work,
        })
    }
}
