//! Numbers of twice the working precision.
//!
//! A number is an unevaluated sum of two doubles. The product of two doubles is such a sum exactly, by a fused
//! multiplication (Dekker 1971); sums follow Knuth. Their relative error is below 2⁻¹⁰⁰ of the terms summed.

use std::iter::Sum;
use std::ops::{Add, Mul, Neg, Sub};

/// Relative error of a product or a sum of two, far above the proved 2⁻¹⁰⁴.
pub(crate) const UNIT: f64 = 7.9e-31;

/// A number of twice the working precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Twofold {
    pub(crate) high: f64,
    low: f64,
}

impl From<f64> for Twofold {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// a · b without error. Where the processor has a fused multiplication and the caller is compiled for it, it is one instruction.
#[inline(always)]
pub(crate) fn exact_product(a: f64, b: f64) -> Twofold {
    let high = a * b;
    Twofold { high, low: a.mul_add(b, -high) }
}

impl Add for Twofold {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (s, e) = two_sum(self.high, other.high);
        let (t, f) = two_sum(self.low, other.low);
        let (s, e) = two_sum(s, e + t);
        let (high, low) = two_sum(s, e + f);
        Self { high, low }
    }
}

impl Neg for Twofold {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Twofold {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul<f64> for Twofold {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        let product = exact_product(self.high, factor);
        let (high, low) = two_sum(product.high, product.low + self.low * factor);
        Self { high, low }
    }
}

impl Sum for Twofold {
    fn sum<I: Iterator<Item = Self>>(numbers: I) -> Self {
        numbers.fold(Self::default(), |sum, number| sum + number)
    }
}

impl Twofold {
    /// The nearest double.
    pub(crate) fn value(self) -> f64 {
        self.high + self.low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cancels_in_double_precision_is_kept() {
        let big = 1e16;
        let sum = Twofold::from(big) + Twofold::from(1.0) - Twofold::from(big);
        assert_eq!(sum.value(), 1.0);
        // (1 + ε)² − 1 − 2ε = ε².
        let one = 1.0 + f64::EPSILON;
        let rest = exact_product(one, one) - Twofold::from(1.0) - Twofold::from(2.0 * f64::EPSILON);
        assert_eq!(rest.value(), f64::EPSILON * f64::EPSILON);
    }
}
