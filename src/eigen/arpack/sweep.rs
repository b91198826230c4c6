//! One run of ARPACK-NG by reverse communication.
//!
//! # Safety
//! The only unsafe calls are `dsaupd_c` and `dseupd_c`. [`Sweep`] owns every array they read or write, at the lengths
//! their documentation asks for (resid n, V n · ncv, workd 3n, workl ncv² + 8 ncv, iparam and ipntr 11, d and select
//! ncv), none of which changes length between the calls. The caller lets one run at a time.
#![allow(unsafe_code)]

use std::ffi::{c_char, c_int};

use faer::Mat;

use crate::dense;
use crate::eigen::ritz::TOLERANCE;
use crate::error::{Error, Result};

/// Columns of V at least: a narrower basis needs many restarts to tell close eigenvalues apart.
const MIN_BASIS: usize = 40;
/// Restarts after which a run fails with status 1.
const MAX_RESTARTS: c_int = 300;

/// What ARPACK asks its caller for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Request {
    /// y = OP x.
    Operator,
    /// y = OP x from M x.
    OperatorOfProduct,
    /// y = M x.
    Mass,
}

/// A request with what it is made of and where its answer goes.
pub(super) struct Call<'a> {
    pub(super) request: Request,
    pub(super) source: Vec<f64>,
    pub(super) target: &'a mut [f64],
}

/// One run of ARPACK by reverse communication, with all its arrays.
pub(super) struct Sweep {
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
    pub(super) fn new(start: Mat<f64>, nev: usize, room: usize) -> Result<Self> {
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
    pub(super) fn next(&mut self) -> Result<Option<Call<'_>>> {
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

    pub(super) fn n_restarts(&self) -> usize {
        usize::try_from(self.iparam[2]).unwrap_or(0)
    }

    /// Vectors of the basis where it could not be built to its full width.
    pub(super) fn n_vectors(&self) -> usize {
        usize::try_from(self.iparam[4]).unwrap_or(0)
    }

    fn n_converged(&self) -> usize {
        usize::try_from(self.iparam[4].min(self.nev)).unwrap_or(0)
    }

    fn failure(&self) -> Error {
        Error::Arpack { status: self.info, converged: self.n_converged() }
    }

    /// 1/θ and x of the converged pairs.
    pub(super) fn eigenpairs(mut self) -> Result<(Vec<f64>, Mat<f64>)> {
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

/// What ARPACK does by itself, and the search around it: where they differ, which is right and why.
#[cfg(test)]
mod tests {
    use faer::MatMut;
    use supel_models::{Ends, Model, spring, spring_spectrum};

    use super::*;
    use crate::eigen::Factored;
    use crate::eigen::arpack::{STATE, arpack};
    use crate::eigen::problem::{Problem, Wanted};
    use crate::factor::{Analysis, Cholesky};
    use crate::random::SplitMix64;
    use crate::sparse::Pencil;
    use crate::sparse::{SparseMatrix, product};

    /// K and M of copies of a model that do not touch, times a factor each.
    fn copies(model: &Model, n_copies: usize, factors: [f64; 2]) -> [SparseMatrix; 2] {
        let n = model.n * n_copies;
        let matrix = |entries: &[(u32, u32, f64)], factor: f64| {
            let mut rows = vec![std::collections::BTreeMap::new(); n];
            for copy in 0..n_copies {
                for (i, j, value) in entries {
                    let (i, j) = (*i as usize + copy * model.n, *j as usize + copy * model.n);
                    rows[i].insert(j as u32, factor * value);
                    rows[j].insert(i as u32, factor * value);
                }
            }
            let pointers = std::iter::once(0).chain(rows.iter().scan(0, |sum, row| {
                *sum += row.len();
                Some(*sum)
            }));
            let entries = rows.iter().flatten();
            let (columns, values) = entries.map(|(col, value)| (*col, *value)).unzip();
            SparseMatrix::new((n, n), pointers.collect(), columns, values)
        };
        [matrix(&model.stiffness, factors[0]), matrix(&model.mass, factors[1])]
    }

    fn with_operator<T>(matrices: &[SparseMatrix; 2], sigma: f64, solve: impl FnOnce(Problem<'_>) -> T) -> T {
        let pencil = Pencil::new(&matrices[0], &matrices[1]);
        let analysis = Analysis::new(pencil).expect("memory");
        let factor = Cholesky::new(&analysis, pencil, sigma, &|dof| dof.to_string()).expect("definite");
        let nothing = Mat::zeros(pencil.mass.rows(), 0);
        let deflated = [nothing.as_ref(), nothing.as_ref()];
        solve(Problem { operator: &Factored::new(&factor, sigma), mass: pencil.mass, deflated })
    }

    /// λ as one run of ARPACK gives them, without s and without deflation: what `eigsh(K, nev, M, sigma)` does.
    fn plain(problem: Problem<'_>, nev: usize, seed: u64) -> Vec<f64> {
        let _alone = STATE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let n = problem.mass.rows();
        let mut start = Mat::zeros(n, 1);
        SplitMix64::new(seed).fill(start.as_mut());
        let mut sweep = Sweep::new(start, nev, n).expect("a run");
        let apply = |block: MatMut<'_, f64>| problem.operator.solve_in_place(block);
        while let Some(Call { request, source, target }) = sweep.next().expect("no failure") {
            let source = Mat::from_fn(n, 1, |i, _| source[i]);
            let mut result = match request {
                Request::Mass | Request::Operator => product(problem.mass, source.as_ref()),
                Request::OperatorOfProduct => source,
            };
            if request != Request::Mass {
                apply(result.as_mut());
            }
            target.copy_from_slice(dense::column(result.as_ref(), 0));
        }
        let (reciprocals, _) = sweep.eigenpairs().expect("pairs");
        // ARPACK returns σ + 1/θ for its own σ, which is zero here.
        let mut lambda: Vec<f64> = reciprocals.iter().map(|value| problem.operator.shift() + value).collect();
        lambda.sort_by(f64::total_cmp);
        lambda
    }

    fn worst(lambda: &[f64], exact: &[f64]) -> f64 {
        lambda.iter().zip(exact).map(|(found, exact)| (found / exact - 1.0).abs()).fold(0.0, f64::max)
    }

    /// ARPACK takes a pair at a residual of TOLERANCE · max(|θ|, 3.7e-11): where all θ are below that it ends after its first
    /// basis. The search scales θ.
    #[test]
    fn absolute_floor_that_stops_arpack_alone_does_not_stop_the_search() {
        let exact = spring_spectrum(400, Ends::Fixed);
        // Powers of two near 10¹² change no digit, but take θ from 1 to 10⁻²⁴.
        for unit in [1.0, 2f64.powi(40)] {
            let matrices = copies(&spring(400, Ends::Fixed), 1, [unit, 1.0 / unit]);
            let exact: Vec<f64> = exact.iter().map(|lambda| lambda * unit * unit).collect();
            with_operator(&matrices, -1e4 * exact[0], |problem| {
                let alone = worst(&plain(problem, 8, 1), &exact);
                let found = arpack(problem, Wanted::Count(8), 1).expect("converges");
                let searched = worst(&found.values, &exact);
                // Residuals of 1e-13 θ, 10⁴ λ₁ away.
                assert!(searched < 1e-9, "the search is off by {searched:e}");
                assert!(if unit == 1.0 { alone < 1e-9 } else { alone > 0.1 }, "ARPACK alone is off by {alone:e}");
            });
        }
    }

    /// A single start vector sees one copy of each eigenvalue and owes the others to rounding; seen from far all θ are nearly
    /// one, and it ends before they come. The search deflates what it has and looks again.
    #[test]
    fn copies_that_arpack_alone_misses_are_found_by_the_search() {
        let (n_copies, wanted) = (8, 5);
        let one = spring_spectrum(100, Ends::Fixed);
        let exact: Vec<f64> = one.iter().flat_map(|lambda| vec![*lambda; n_copies]).collect();
        let matrices = copies(&spring(100, Ends::Fixed), n_copies, [1.0, 1.0]);
        with_operator(&matrices, -1e3 * one[0], |problem| {
            let mut n_missed = 0;
            for seed in 0..16 {
                let alone = plain(problem, wanted, seed);
                n_missed += usize::from(worst(&alone, &exact) > 0.1);
                // What it does find are eigenvalues: no residual tells.
                let is_exact = |lambda: &f64| one.iter().any(|exact| (lambda / exact - 1.0).abs() < 1e-9);
                assert!(alone.iter().all(is_exact), "{alone:?}");
                let found = arpack(problem, Wanted::Count(wanted), seed).expect("converges");
                assert_eq!(found.values.len(), n_copies, "the cluster comes whole");
                assert!(worst(&found.values, &exact) < 1e-9, "{:?}", found.values);
            }
            // Which start vectors miss copies is for rounding to say, and that differs from processor to processor.
            assert!(n_missed > 0, "ARPACK alone finds all copies from every start");
        });
    }
}
