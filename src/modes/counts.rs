//! Where Sturm counts are taken, so that intervals hold as many modes as they should.
//!
//! N(λ), the number of eigenvalues below λ, grows about like a power of λ: 1/2 along a bar, 1 in a plate, 3/2 in a solid. Between
//! two counts it is interpolated as such a power, beyond the last one continued; each further count corrects the next place.

use super::boundary_problem::BoundaryProblem;
use super::finite::above_all;
use crate::eigen::{ElasticCount, ratios};
use crate::error::{Error, Result};

/// How far a shift is moved that lies on an eigenvalue, relatively.
const OFF: f64 = 1e-3;
/// The power of λ that N grows with, where counts do not tell.
const POWER: f64 = 1.0;
/// More modes than asked for that the interval above them may hold: a share, and as many as cost as much to find as a count.
const EXCESS: (f64, usize) = (0.05, 8);
/// The share of an interval by which it may be larger or smaller than the others.
const UNEVEN: f64 = 0.25;

/// Half way in frequency, where modes lie more evenly than in λ.
pub(super) fn middle(from: f64, to: f64) -> f64 {
    (0.5 * (from.max(0.0).sqrt() + to.sqrt())).powi(2)
}

impl ElasticCount {
    /// The shift and the number of eigenvalues below it.
    pub(super) fn place(self) -> (f64, usize) {
        (self.inertia.sigma, self.n_elastic)
    }
}

/// Counts between a shift whose count is known and another.
pub(super) struct Counts<'a> {
    problem: &'a BoundaryProblem<'a>,
    lower: (f64, usize),
    /// Ascending.
    counts: Vec<ElasticCount>,
    /// Factorisations they took.
    pub n_taken: usize,
}

impl<'a> Counts<'a> {
    /// Nothing but two ends.
    pub(super) fn between(problem: &'a BoundaryProblem<'a>, lower: (f64, usize), upper: ElasticCount) -> Self {
        Self { problem, lower, counts: vec![upper], n_taken: 0 }
    }

    /// Counts from zero up to one with more than `n_modes` modes below it, but not many more, or with all modes there are.
    ///
    /// # Errors
    /// As [`BoundaryProblem::count_below`].
    pub(super) fn up_to(problem: &'a BoundaryProblem<'a>, n_modes: usize) -> Result<Self> {
        /// Counts that interpolation takes; after them intervals are halved.
        const INTERPOLATED: usize = 12;
        const STEPS: usize = 60;
        let mut counts = Self { problem, lower: (0.0, 0), counts: Vec::new(), n_taken: 0 };
        let ratios = ratios(problem.modal());
        let top = above_all(problem);
        let excess = (EXCESS.0 * n_modes as f64) as usize + EXCESS.1;
        let is_above = |end: &ElasticCount| end.n_elastic > n_modes || end.inertia.sigma >= top;
        let target = n_modes as f64 + 0.5 * excess as f64;
        // λ of plane and solid meshes grows at least linearly in the number of the mode.
        let share = n_modes as f64 / problem.modal().mass.rows() as f64;
        let mut sigma = ratios.get(ratios.len() / 2).copied().unwrap_or(1.0) * share;
        for step in 0..STEPS {
            match counts.take(sigma) {
                Ok(_) => {}
                Err(Error::SturmPivot) => {
                    sigma *= 1.0 + OFF;
                    continue;
                }
                Err(error) => return Err(error),
            }
            let n_below = counts.counts.partition_point(|end| !is_above(end));
            let below = n_below.checked_sub(1).map_or(0.0, |last| counts.counts[last].inertia.sigma);
            sigma = match counts.counts.get(n_below).map(|end| end.place()) {
                Some((to, n)) if n <= n_modes + excess || to < (1.0 + OFF) * below => break,
                Some((to, _)) if step >= INTERPOLATED => middle(below, to),
                _ => counts.expected_at(target).min(top),
            };
        }
        let n_below = counts.counts.partition_point(|end| !is_above(end));
        counts.counts.truncate(n_below + 1);
        Ok(counts)
    }

    /// The last of the counts: the upper end.
    pub(super) fn last(&self) -> Option<ElasticCount> {
        self.counts.last().copied()
    }

    /// Cuts what lies below the last count into `n_parts` parts of about as many eigenvalues each, and above them one without any
    /// where the last count is far up; gives the counts between them.
    ///
    /// # Errors
    /// No memory for a count.
    pub(super) fn cut_evenly(&mut self, n_parts: usize) -> Result<Vec<ElasticCount>> {
        let n_below = self.lower.1;
        let Some(last) = self.last() else { return Ok(Vec::new()) };
        let end = self.end_near(last)?;
        let part = (last.n_elastic - n_below) as f64 / n_parts as f64;
        let mut cuts: Vec<ElasticCount> = Vec::new();
        for place in 1..n_parts {
            let target = n_below as f64 + part * place as f64;
            let is_near = |count: &ElasticCount| (count.n_elastic as f64 - target).abs() <= UNEVEN * part;
            // A count nearby serves; a first one corrects the place of a second.
            for _ in 0..2 {
                if self.counts.iter().any(is_near) || self.take_near(self.expected_at(target), |_| true)?.is_none() {
                    break;
                }
            }
            let distance = |count: &&ElasticCount| (count.n_elastic as f64 - target).abs();
            let inner = self.counts.iter().filter(|count| count.n_elastic < last.n_elastic);
            let nearest = inner.min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let is_further = |count: &&ElasticCount| cuts.last().is_none_or(|last| last.n_elastic < count.n_elastic);
            cuts.extend(nearest.filter(|count| distance(count) <= 0.5 * part).filter(is_further).copied());
        }
        cuts.extend(Some(end).filter(|end| end.inertia.sigma < last.inertia.sigma));
        Ok(cuts)
    }

    /// A count with as many eigenvalues below it as the last one has, and not much further up than the highest of them: a shift
    /// inside an interval that holds its eigenvalues at one end alone hardly tells them apart.
    fn end_near(&mut self, last: ElasticCount) -> Result<ElasticCount> {
        // A count half way in frequency lies at a quarter of the shift.
        const NEAR: f64 = 5.0;
        const STEPS: usize = 60;
        let mut end = last;
        if last.n_elastic == self.lower.1 {
            return Ok(end);
        }
        for _ in 0..STEPS {
            let n_fewer = self.counts.partition_point(|count| count.n_elastic < last.n_elastic);
            let below = n_fewer.checked_sub(1).map_or(self.lower.0, |fewer| self.counts[fewer].inertia.sigma);
            end = self.counts[n_fewer];
            let sigma = end.inertia.sigma;
            if sigma <= NEAR * below || self.take_near(middle(below, sigma), |_| true)?.is_none() {
                break;
            }
        }
        Ok(end)
    }

    /// A count at a shift or near it, between the counts on either side; none where every place lies on an eigenvalue.
    ///
    /// # Errors
    /// No memory for a count.
    pub(super) fn take_near(&mut self, sigma: f64, is_clear: impl Fn(f64) -> bool) -> Result<Option<ElasticCount>> {
        const PLACES: [f64; 5] = [0.0, -0.12, 0.12, -0.24, 0.24];
        let above = self.counts.partition_point(|count| count.inertia.sigma <= sigma);
        let from = above.checked_sub(1).map_or(self.lower.0, |below| self.counts[below].inertia.sigma);
        let to = self.counts.get(above).map_or(sigma, |above| above.inertia.sigma);
        for place in PLACES {
            let room = if place < 0.0 { sigma - from } else { to - sigma };
            let sigma = sigma + place * room;
            if !is_clear(sigma) {
                continue;
            }
            match self.take(sigma) {
                Ok(count) => return Ok(Some(count)),
                Err(Error::SturmPivot | Error::ModesMissing { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(None)
    }

    /// Takes a count and keeps it, if it is one: between those on either side.
    fn take(&mut self, sigma: f64) -> Result<ElasticCount> {
        self.n_taken += 1;
        let count = self.problem.count_below(sigma)?;
        let place = self.counts.partition_point(|other| other.inertia.sigma < sigma);
        let below = place.checked_sub(1).map_or(self.lower.1, |before| self.counts[before].n_elastic);
        let above = self.counts.get(place).map_or(usize::MAX, |after| after.n_elastic);
        if !(below..=above).contains(&count.n_elastic) {
            return Err(Error::SturmPivot);
        }
        self.counts.insert(place, count);
        Ok(count)
    }

    /// The shift below which so many eigenvalues are expected.
    fn expected_at(&self, target: f64) -> f64 {
        let above = self.counts.partition_point(|count| (count.n_elastic as f64) < target);
        let place = |at: usize| self.counts.get(at).map(|count| count.place());
        let lower = above.checked_sub(1).and_then(place).unwrap_or(self.lower);
        match place(above) {
            Some(upper) => between(lower, upper, target),
            None => lower.0 * Self::growth(target, lower, above.checked_sub(2).and_then(place)),
        }
    }

    /// How many times λ grows from the last count to where so many eigenvalues are expected, by what it and the one before tell.
    fn growth(target: f64, last: (f64, usize), before: Option<(f64, usize)>) -> f64 {
        const MIN_GROWTH: f64 = 1.2;
        const MAX_GROWTH: f64 = 16.0;
        let power = match before {
            // There may be no more.
            Some(before) if before.1 == last.1 => 0.0,
            Some(before) if before.1 > 0 => power(before, last),
            _ => POWER,
        };
        if last.1 == 0 { MAX_GROWTH } else { (target / last.1 as f64).powf(1.0 / power).clamp(MIN_GROWTH, MAX_GROWTH) }
    }
}

/// The power of λ with which N grows from one count to another.
fn power(lower: (f64, usize), upper: (f64, usize)) -> f64 {
    (upper.1 as f64 / lower.1 as f64).ln() / (upper.0 / lower.0).ln()
}

/// The shift between two counts below which so many eigenvalues are expected; off both by a tenth of what lies between.
fn between(lower: (f64, usize), upper: (f64, usize), target: f64) -> f64 {
    const OFF_ENDS: f64 = 0.1;
    let power = if lower.1 > 0 && lower.1 < upper.1 { power(lower, upper) } else { POWER };
    let sigma = upper.0 * (target / upper.1 as f64).powf(1.0 / power);
    let room = OFF_ENDS * (upper.0 - lower.0);
    sigma.clamp(lower.0 + room, upper.0 - room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_is_followed_exactly() {
        // N = 100 λ^(3/2) is 10⁵ at λ = 100.
        let n = |lambda: f64| (100.0 * lambda.powf(1.5)).round() as usize;
        let (lower, upper) = ((1.0, n(1.0)), (400.0, n(400.0)));
        let sigma = between(lower, upper, 1e5);
        // Both counts are whole numbers already.
        assert!((sigma / 100.0 - 1.0).abs() < 1e-12, "{sigma}");
        assert!((power(lower, upper) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn a_place_is_off_both_ends() {
        assert_eq!(between((0.0, 0), (10.0, 1000), 1.0), 1.0, "a tenth, not a thousandth");
        assert_eq!(between((5.0, 10), (10.0, 10), 10.0), 9.5, "no power without growth");
        assert_eq!(between((5.0, 0), (10.0, 8), 2.0), 5.5);
    }
}
