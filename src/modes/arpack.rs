//! ARPACK-NG behind the same operator: a second eigensolver that shares nothing with [`super::lanczos`] but P, K and M.
//!
//! ```text
//! OP = s P (K − σM)⁻¹ Pᵀ M   n × n     symmetric in the M-inner product; s a power of two, see `TARGET`
//! P  = I − [Q X] [Q X]ᵀM               takes out the rigid-body modes Q and the modes X found so far
//! V                          n × ncv   the basis of one sweep, OP V ≈ V T; θ = s/(λ − σ)
//! ```
//! A single start vector sees one copy of a multiple eigenvalue and owes the others to rounding. Modes are therefore
//! found in sweeps: each deflates what the ones before have found, and the search ends when the largest θ of a sweep
//! lies beyond the wanted ones. Infinite eigenvalues have θ = 0 and are never returned.
//!
//! # Safety
//! The only unsafe calls are `dsaupd_c` and `dseupd_c`. [`Sweep`] owns every array they read or write, at the lengths
//! their documentation asks for (resid n, V n · ncv, workd 3n, workl ncv² + 8 ncv, iparam and ipntr 11, d and select
//! ncv), none of which changes length between the calls. ARPACK keeps state between calls in static variables: the lock
//! [`STATE`] lets one search run at a time in the whole process.
#![allow(unsafe_code)]

use std::ffi::{c_char, c_int};
use std::sync::{Mutex, PoisonError};

use faer::{Mat, MatMut, MatRef};

use super::eigenproblem::{EigenWork, Eigenpairs, Problem, Wanted, are_clustered, is_above, mass_norm};
use super::random::SplitMix64;
use super::ritz::{RESIDUAL_FLOOR, ROUNDING, TOLERANCE};
use crate::dense;
use crate::error::{Error, Result};
use crate::sparse::product;

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
/// Columns of V at least: a narrower basis needs many restarts to tell close eigenvalues apart.
const MIN_BASIS: usize = 40;
/// Restarts after which a sweep fails with status 1.
const MAX_RESTARTS: c_int = 300;
/// ARPACK's status for a start vector without use.
const BAD_START: i32 = -9;

/// Finds the wanted eigenpairs, with the meaning of [`super::lanczos::lanczos`].
///
/// # Errors
/// [`Error::Arpack`] with ARPACK's own status.
pub(super) fn arpack(problem: Problem<'_>, wanted: Wanted, seed: u64) -> Result<Eigenpairs> {
    // A thread that waits inside a parallel product takes up other work, possibly another search, which would wait for
    // the lock for ever. Threads of its own have no other work.
    let threads = rayon::ThreadPoolBuilder::new().num_threads(rayon::current_num_threads()).build();
    let threads = threads.map_err(|_| Error::OutOfMemory { what: "the threads of ARPACK" })?;
    threads.install(|| {
        let _alone = STATE.lock().unwrap_or_else(PoisonError::into_inner);
        Search::new(problem, seed).run(wanted)
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
        let rows_with_mass = problem.mass.outer_iterator().filter(|row| row.data().iter().any(|value| *value != 0.0));
        Self {
            problem,
            random: SplitMix64::new(seed),
            n_finite: rows_with_mass.count().saturating_sub(q.ncols()),
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

    /// The problem with everything taken out that has been found.
    fn remaining(&self) -> Problem<'_> {
        Problem { deflated: [self.taken.as_ref(), self.mass_taken.as_ref()], ..self.problem }
    }

    /// Replaces M x by OP x, without s.
    fn apply(&mut self, mut block: MatMut<'_, f64>) {
        self.work.solves += 1;
        self.work.steps += 1;
        let problem = self.remaining();
        problem.equilibrate(block.as_mut());
        problem.operator.solve_in_place(block.as_mut());
        problem.deflate(block);
    }

    /// A random vector after one application of OP, at unit length, and how long OP makes it; none where only rounding
    /// is left.
    fn start(&mut self) -> Result<Option<(Mat<f64>, f64)>> {
        let mass = self.problem.mass;
        let mut vector = Mat::zeros(mass.rows(), 1);
        self.random.fill(vector.as_mut());
        self.remaining().deflate(vector.as_mut());
        let mut length = mass_norm(mass, &vector);
        let largest = self.theta.iter().copied().fold(0.0, f64::max);
        for _ in 0..2 {
            vector.as_mut().col_mut(0).iter_mut().for_each(|value| *value /= length);
            let mut image = product(mass, vector.as_ref());
            self.apply(image.as_mut());
            let stretched = mass_norm(mass, &image);
            if !stretched.is_finite() {
                return Err(Error::Arpack { status: BAD_START, converged: self.theta.len() });
            }
            if stretched <= ROUNDING * f64::EPSILON * largest {
                return Ok(None);
            }
            (vector, length) = (image, stretched);
        }
        vector.as_mut().col_mut(0).iter_mut().for_each(|value| *value /= length);
        Ok(Some((vector, length)))
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
        let scale = *self.scale.get_or_insert_with(|| 2f64.powi((TARGET / stretch).log2().round() as i32));
        if room == 1 {
            // The last direction left is the mode; ARPACK wants two.
            self.take(start.as_ref(), &[stretch]);
            return Ok(());
        }
        // Half of what is left, so that restarts keep room to clear the basis of rounding.
        let mut sweep = Sweep::new(start, n_asked.min(room / 2), room)?;
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
        self.work.restarts += sweep.n_restarts();
        let (reciprocals, vectors) = sweep.eigenpairs()?;
        let theta: Vec<f64> = reciprocals.iter().map(|reciprocal| 1.0 / (reciprocal * scale)).collect();
        self.take(vectors.as_ref(), &theta);
        Ok(())
    }

    fn take(&mut self, vectors: MatRef<'_, f64>, theta: &[f64]) {
        let mut vectors = vectors.to_owned();
        self.remaining().deflate(vectors.as_mut());
        self.mass_taken =
            dense::beside(self.mass_taken.as_ref(), product(self.problem.mass, vectors.as_ref()).as_ref());
        self.taken = dense::beside(self.taken.as_ref(), vectors.as_ref());
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
        let n_rigid = self.problem.deflated[0].ncols();
        Some(Eigenpairs {
            vectors: Mat::from_fn(self.taken.nrows(), count, |i, j| self.taken[(i, n_rigid + order[j])]),
            next: lambda.get(count).copied(),
            values: lambda[..count].to_vec(),
            work: self.work,
        })
    }
}

/// What ARPACK asks its caller for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Request {
    /// y = OP x.
    Operator,
    /// y = OP x from M x.
    OperatorOfProduct,
    /// y = M x.
    Mass,
}

/// A request with what it is made of and where its answer goes.
struct Call<'a> {
    request: Request,
    source: Vec<f64>,
    target: &'a mut [f64],
}

/// One run of ARPACK by reverse communication, with all its arrays.
struct Sweep {
    n: usize,
    nev: c_int,
    ncv: c_int,
    ido: c_int,
    info: c_int,
    resid: Vec<f64>,
    v: Vec<f64>,
    workd: Vec<f64>,
    workl: Vec<f64>,
    iparam: [c_int; 11],
    ipntr: [c_int; 11],
}

/// The problem is a pencil, of which the eigenvalues of largest magnitude are wanted.
const PENCIL: *const c_char = c"G".as_ptr();
const LARGEST: *const c_char = c"LM".as_ptr();

impl Sweep {
    /// Prepares the search for `nev` pairs in a space of dimension `room`, of which nev is less.
    fn new(start: Mat<f64>, nev: usize, room: usize) -> Result<Self> {
        let n = start.nrows();
        let ncv = (2 * nev + 1).max(MIN_BASIS).min(room);
        let length = |value: usize| {
            c_int::try_from(value).map_err(|_| Error::OutOfMemory { what: "ARPACK, which counts in 32 bits" })
        };
        let mut iparam = [0; 11];
        // Exact shifts, at most so many restarts, blocks of one, mode 3: shift and invert.
        (iparam[0], iparam[2], iparam[3], iparam[6]) = (1, MAX_RESTARTS, 1, 3);
        length(n)?;
        length(ncv * ncv + 8 * ncv)?;
        Ok(Self {
            n,
            nev: length(nev)?,
            ncv: length(ncv)?,
            ido: 0,
            // The start vector is given.
            info: 1,
            resid: dense::column(start.as_ref(), 0).to_vec(),
            v: vec![0.0; n * ncv],
            workd: vec![0.0; 3 * n],
            workl: vec![0.0; ncv * ncv + 8 * ncv],
            iparam,
            ipntr: [0; 11],
        })
    }

    /// Runs ARPACK to its next request; none when it is done.
    fn next(&mut self) -> Result<Option<Call<'_>>> {
        // SAFETY: see the head of the file; every pointer is to an array of this object of the length ARPACK expects.
        unsafe {
            arpack_sys::dsaupd_c(
                &raw mut self.ido,
                PENCIL,
                self.n as c_int,
                LARGEST,
                self.nev,
                TOLERANCE,
                self.resid.as_mut_ptr(),
                self.ncv,
                self.v.as_mut_ptr(),
                self.n as c_int,
                self.iparam.as_mut_ptr(),
                self.ipntr.as_mut_ptr(),
                self.workd.as_mut_ptr(),
                self.workl.as_mut_ptr(),
                self.workl.len() as c_int,
                &raw mut self.info,
            );
        }
        let [x, y, mass_x] = [self.ipntr[0], self.ipntr[1], self.ipntr[2]].map(|at| (at as usize).saturating_sub(1));
        let (request, source) = match self.ido {
            -1 => (Request::Operator, x),
            1 => (Request::OperatorOfProduct, mass_x),
            2 => (Request::Mass, x),
            _ if self.info == 0 => return Ok(None),
            _ => return Err(self.failure()),
        };
        let source = self.workd[source..source + self.n].to_vec();
        Ok(Some(Call { request, source, target: &mut self.workd[y..y + self.n] }))
    }

    fn n_restarts(&self) -> usize {
        usize::try_from(self.iparam[2]).unwrap_or(0)
    }

    fn n_converged(&self) -> usize {
        usize::try_from(self.iparam[4].min(self.nev)).unwrap_or(0)
    }

    fn failure(&self) -> Error {
        Error::Arpack { status: self.info, converged: self.n_converged() }
    }

    /// 1/θ and x of the converged pairs.
    fn eigenpairs(mut self) -> Result<(Vec<f64>, Mat<f64>)> {
        let mut select = vec![0; self.ncv as usize];
        let mut reciprocals = vec![0.0; self.ncv as usize];
        let basis = self.v.as_mut_ptr();
        // SAFETY: as above, with the arrays dsaupd left; ARPACK documents that z may be the leading columns of v.
        unsafe {
            arpack_sys::dseupd_c(
                1,
                c"A".as_ptr(),
                select.as_mut_ptr(),
                reciprocals.as_mut_ptr(),
                basis,
                self.n as c_int,
                0.0,
                PENCIL,
                self.n as c_int,
                LARGEST,
                self.nev,
                TOLERANCE,
                self.resid.as_mut_ptr(),
                self.ncv,
                basis,
                self.n as c_int,
                self.iparam.as_mut_ptr(),
                self.ipntr.as_mut_ptr(),
                self.workd.as_mut_ptr(),
                self.workl.as_mut_ptr(),
                self.workl.len() as c_int,
                &raw mut self.info,
            );
        }
        let n_converged = self.n_converged();
        if self.info != 0 || n_converged == 0 {
            return Err(self.failure());
        }
        reciprocals.truncate(n_converged);
        let vectors = Mat::from_fn(self.n, n_converged, |i, j| self.v[j * self.n + i]);
        Ok((reciprocals, vectors))
    }
}
