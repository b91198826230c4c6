//! Ritz pairs: which of them have converged and answer the request.

use faer::Mat;

use super::problem::{Interval, Wanted, are_clustered, is_above};

/// Residual ‖OP x − θx‖ over θ at which a pair is taken: the Rayleigh quotient then errs by its square, and the backward
/// error, which is this times λ over the largest one at most, stays below the limit of measure M-01.
pub(super) const TOLERANCE: f64 = 1e-13;
/// The residual at which the pair beyond the wanted ones is taken, of which only λ is used.
const NEXT_TOLERANCE: f64 = 1e-4;
/// The residual of that pair over its distance from the last wanted one.
const SHARE_OF_DISTANCE: f64 = 0.1;
/// Rounding of OP in units of ε times its largest eigenvalue: a θ below it is that of an infinite eigenvalue.
pub(super) const ROUNDING: f64 = 16.0;
/// Residuals in the same units that need not fall further.
pub(crate) const RESIDUAL_FLOOR: f64 = 16.0;

/// What an iteration looks for.
#[derive(Clone, Copy)]
pub(super) enum Goal {
    Lowest(Wanted),
    Between(Interval),
}

/// Ritz pairs in descending |θ|: those nearest the shift first, which is ascending λ for a shift below the spectrum.
pub(super) struct Ritz {
    pub(super) theta: Vec<f64>,
    pub(super) s: Mat<f64>,
    pub(super) residuals: Vec<f64>,
    /// Residuals that need not fall further; what is extracted from the basis is corrected by the rest.
    floor: f64,
}

impl Ritz {
    /// Pairs of an operator whose largest θ is rounded to ε of itself.
    pub(super) fn new(theta: Vec<f64>, s: Mat<f64>, residuals: Vec<f64>) -> Self {
        let floor = RESIDUAL_FLOOR * f64::EPSILON * theta.first().copied().unwrap_or(0.0).abs();
        Self { theta, s, residuals, floor }
    }

    /// These pairs where products with M are rounded to ε of terms that are so many times as large as what is left of them.
    pub(super) fn beneath_terms(self, cancellation: f64) -> Self {
        Self { floor: self.floor * cancellation.max(1.0), ..self }
    }

    pub(super) fn lambda(&self, j: usize, sigma: f64) -> f64 {
        sigma + 1.0 / self.theta[j]
    }

    /// Pairs that are not infinite eigenvalues: θ above the rounding of OP.
    pub(super) fn n_finite(&self) -> usize {
        let floor = ROUNDING * f64::EPSILON * self.theta.first().copied().unwrap_or(0.0).abs();
        self.theta.iter().take_while(|theta| theta.abs() > floor).count()
    }

    pub(super) fn is_converged(&self, j: usize) -> bool {
        self.residuals[j] <= (TOLERANCE * self.theta[j].abs()).max(self.floor)
    }

    pub(super) fn same_cluster(&self, a: usize, b: usize, sigma: f64) -> bool {
        are_clustered(self.lambda(a, sigma), self.lambda(b, sigma))
    }

    /// A number of leading pairs, and the rest of the cluster that it would cut, as far as that shows.
    fn to_end_of_cluster(&self, mut count: usize, sigma: f64) -> usize {
        let n_finite = self.n_finite();
        while count > 0 && count < n_finite && self.same_cluster(count - 1, count, sigma) {
            count += 1;
        }
        count
    }

    /// Numbers of the pairs that answer a goal, or none while it is not answered.
    pub(super) fn answer(&self, goal: Goal, sigma: f64) -> Option<Vec<usize>> {
        match goal {
            Goal::Lowest(wanted) => self.count_wanted(wanted, sigma).map(|count| (0..count).collect()),
            Goal::Between(interval) => self.inside(interval, sigma),
        }
    }

    /// How many leading pairs a goal is about, converged or not.
    pub(super) fn n_asked(&self, goal: Goal, sigma: f64) -> usize {
        match goal {
            Goal::Lowest(Wanted::Count(count)) => self.to_end_of_cluster(count, sigma),
            Goal::Lowest(Wanted::UpTo(limit)) => {
                (0..self.n_finite()).take_while(|j| !is_above(self.lambda(*j, sigma), limit)).count()
            }
            Goal::Between(interval) => self.n_within_reach(interval, sigma),
        }
    }

    /// How many pairs answer the request, or none while the request is not answered.
    fn count_wanted(&self, wanted: Wanted, sigma: f64) -> Option<usize> {
        let n_finite = self.n_finite();
        let count = self.to_end_of_cluster(
            match wanted {
                Wanted::Count(count) => count,
                Wanted::UpTo(limit) => (0..n_finite).find(|j| is_above(self.lambda(*j, sigma), limit))?,
            },
            sigma,
        );
        let settled = count < n_finite
            && (0..count).all(|j| self.is_converged(j))
            && (self.is_converged(count) || self.residuals[count] <= self.most_of_next(count));
        settled.then_some(count)
    }

    /// The residual at which the pair beyond `count` wanted ones is taken. In a chain of near eigenvalues it decides where the cluster ends,
    /// and is known to a share of its distance from the last wanted one.
    fn most_of_next(&self, count: usize) -> f64 {
        let next = self.theta[count].abs();
        let distance = count.checked_sub(1).map_or(next, |last| self.theta[last].abs() - next);
        (NEXT_TOLERANCE * next).min(SHARE_OF_DISTANCE * distance)
    }

    /// The pairs inside an interval, once they have converged and either all of them are there or a pair further from the
    /// shift than both ends has converged too: the space then holds nothing more of the interval.
    fn inside(&self, interval: Interval, sigma: f64) -> Option<Vec<usize>> {
        let n_finite = self.n_finite();
        let reach = (interval.to - sigma).max(sigma - interval.from);
        let inside: Vec<usize> = (0..n_finite).filter(|j| interval.holds(self.lambda(*j, sigma))).collect();
        let is_beyond = |j: &usize| 1.0 / self.theta[*j].abs() > reach;
        let sees_beyond =
            || (0..n_finite).find(is_beyond).is_some_and(|j| self.residuals[j] <= NEXT_TOLERANCE * self.theta[j].abs());
        let settled = inside.iter().all(|j| self.is_converged(*j)) && (inside.len() >= interval.count || sees_beyond());
        settled.then_some(inside)
    }

    /// Leading pairs no further from the shift than the ends of an interval.
    fn n_within_reach(&self, interval: Interval, sigma: f64) -> usize {
        let reach = (interval.to - sigma).max(sigma - interval.from);
        (0..self.n_finite()).take_while(|j| 1.0 / self.theta[*j].abs() <= reach).count()
    }
}
