//! What the checks look at: a result, what was measured of it, and the modes that there are.

use crate::certification::band::Completed;
use crate::certification::claims::Claims;
use crate::certification::judgement::Judged;
use crate::certification::measured::Measured;
use crate::certification::pair::PairKind;
use crate::dense::{self, NOISE_FACTOR};
use crate::modes::Component;
use crate::number::quantity;
use crate::verification::check::Limits;

/// What the checks look at.
pub(super) struct Subject<'a> {
    pub(super) component: Component<'a>,
    pub(super) claims: &'a Claims,
    pub(super) measured: &'a Measured,
    pub(super) judged: &'a Judged,
    pub(super) completed: &'a Completed,
}

/// The largest of some values, with the pair it belongs to.
pub(super) fn worst(values: impl IntoIterator<Item = (usize, f64)>) -> (f64, Option<usize>) {
    let mut worst = (0.0, None);
    for (pair, value) in values {
        if dense::worse(value, worst.0) {
            worst = (value, Some(pair));
        }
    }
    worst
}

/// A value of one pair, judged by limits of its own.
#[derive(Clone, Copy)]
pub(super) struct OfPair {
    pub(super) claim: usize,
    pub(super) value: f64,
    pub(super) limits: Limits,
    pub(super) fail_above: f64,
}

impl OfPair {
    /// The value that is worst compared with its limits, one that fails before all that warn; none of no pairs.
    pub(super) fn worst(values: impl IntoIterator<Item = Self>) -> Option<Self> {
        let share = |of_pair: &Self| of_pair.value / of_pair.limits.value();
        let fails = |of_pair: &Self| of_pair.value.is_nan() || of_pair.value > of_pair.fail_above;
        let is_worse = |next: &Self, worst: &Self| match (fails(next), fails(worst)) {
            (true, false) => true,
            (false, true) => false,
            _ => dense::worse(share(next), share(worst)),
        };
        values.into_iter().reduce(|worst, next| if is_worse(&next, &worst) { next } else { worst })
    }
}

impl Subject<'_> {
    /// The numbers of pairs of some kinds, from zero.
    pub(super) fn of_kinds(&self, kinds: &[PairKind]) -> Vec<usize> {
        (0..self.claims.count()).filter(|claim| kinds.contains(&self.judged.pairs[*claim].kind)).collect()
    }

    /// Pairs that are modes, or should be.
    pub(super) fn elastic(&self) -> Vec<usize> {
        let is_rigid = |claim: &usize| self.judged.pairs[*claim].mode_hz == Some(0.0);
        let of_kinds = self.of_kinds(&[PairKind::Mode, PairKind::Inexact]);
        of_kinds.into_iter().filter(|claim| !is_rigid(claim)).collect()
    }

    /// What the digits of a shape leave of a measure that is relative to its terms.
    pub(super) fn of_digits(&self, claim: usize) -> f64 {
        let rounding = self.claims.shape_rounding[claim];
        if rounding > f64::EPSILON { NOISE_FACTOR * rounding } else { 0.0 }
    }

    /// What they leave of a measure of some pairs at most.
    pub(super) fn of_digits_of(&self, claims: &[usize]) -> f64 {
        claims.iter().map(|claim| self.of_digits(*claim)).fold(0.0, f64::max)
    }

    pub(super) fn name(&self, claim: usize) -> String {
        let pair = &self.judged.pairs[claim];
        let hertz = pair.stated_hz.unwrap_or(pair.shape_hz);
        format!("mode {} at {} Hz", pair.number, quantity(hertz, 6))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What fails is not passed over for what is further beyond a smaller limit and warns.
    #[test]
    fn a_pair_that_fails_is_the_worst() {
        let limits = |data: f64| Limits { engineering: 1e-4, arithmetic: 0.0, data };
        let fails = OfPair { claim: 0, value: 2e-2, limits: limits(1.9e-2), fail_above: 1e-2 };
        let warns = OfPair { claim: 1, value: 9e-4, limits: limits(0.0), fail_above: 1e-3 };
        for pairs in [[fails, warns], [warns, fails]] {
            assert_eq!(OfPair::worst(pairs).expect("a pair").claim, 0);
        }
        let worse = OfPair { claim: 2, value: 3e-2, ..fails };
        assert_eq!(OfPair::worst([fails, warns, worse]).expect("a pair").claim, 2);
    }
}
