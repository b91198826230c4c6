//! Ritz pairs: which of them have converged and answer the request.

use faer::Mat;

use super::eigenproblem::{Wanted, are_clustered};

/// Residual ‖OP x − θx‖ over θ at which a pair is taken: the Rayleigh quotient then errs by its square, and the backward
/// error, which is this times λ over the largest one at most, stays below the limit of measure M-01.
pub(super) const TOLERANCE: f64 = 1e-13;
/// The same for the pair beyond the wanted ones, of which only λ is used.
const NEXT_TOLERANCE: f64 = 1e-4;
/// Rounding of OP in units of ε times its largest eigenvalue: a θ below it is that of an infinite eigenvalue.
pub(super) const ROUNDING: f64 = 16.0;
/// Residuals in the same units that need not fall further; the correction in [`Basis::extract`] takes up the rest.
pub(super) const RESIDUAL_FLOOR: f64 = 16.0;

/// Ritz pairs in descending θ, that is ascending λ.
pub(super) struct Ritz {
    pub(super) theta: Vec<f64>,
    pub(super) s: Mat<f64>,
    pub(super) residuals: Vec<f64>,
}

impl Ritz {
    pub(super) fn lambda(&self, j: usize, sigma: f64) -> f64 {
        sigma + 1.0 / self.theta[j]
    }

    /// Pairs that are not infinite eigenvalues: θ above the rounding of OP.
    pub(super) fn n_finite(&self) -> usize {
        let floor = ROUNDING * f64::EPSILON * self.theta.first().copied().unwrap_or(0.0);
        self.theta.iter().take_while(|theta| **theta > floor).count()
    }

    pub(super) fn is_converged(&self, j: usize) -> bool {
        self.residuals[j] <= (TOLERANCE * self.theta[j]).max(RESIDUAL_FLOOR * f64::EPSILON * self.theta[0])
    }

    pub(super) fn same_cluster(&self, a: usize, b: usize, sigma: f64) -> bool {
        are_clustered(self.lambda(a, sigma), self.lambda(b, sigma))
    }

    /// How many pairs answer the request, or none while the request is not answered.
    pub(super) fn count_wanted(&self, wanted: Wanted, sigma: f64) -> Option<usize> {
        let n_finite = self.n_finite();
        let mut count = match wanted {
            Wanted::Count(count) => count,
            Wanted::UpTo(limit) => (0..n_finite).find(|j| self.lambda(*j, sigma) > limit)?,
        };
        while count > 0 && count < n_finite && self.same_cluster(count - 1, count, sigma) {
            count += 1;
        }
        let settled = count < n_finite
            && (0..count).all(|j| self.is_converged(j))
            && self.residuals[count] <= NEXT_TOLERANCE * self.theta[count];
        settled.then_some(count)
    }
}
