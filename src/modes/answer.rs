//! The result of a block Lanczos iteration: the pairs it was asked for, all there are, or those that have converged.

use faer::Mat;

use super::eigenproblem::{Eigenpairs, Interval, Wanted, is_above};
use super::lanczos::{Basis, MAX_RESTARTS};
use super::ritz::Ritz;
use crate::dense;
use crate::error::{Error, Result};

/// What an iteration looks for.
#[derive(Clone, Copy)]
pub(super) enum Goal {
    Lowest(Wanted),
    Between(Interval),
}

impl Basis<'_> {
    /// All pairs of an exhausted space, as far as wanted.
    pub(super) fn everything(&self, goal: Goal) -> Result<Eigenpairs> {
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
    pub(super) fn stalled(&self, goal: Goal) -> Result<Eigenpairs> {
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
    pub(super) fn extract(&self, ritz: &Ritz, taken: &[usize]) -> Eigenpairs {
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
