//! Products and sums to twice the working precision.
//!
//! A number is an unevaluated sum of two doubles. The product of two doubles is such a sum exactly, by a fused
//! multiplication (Dekker 1971); sums follow Knuth. Their relative error is below 2⁻¹⁰⁰ of the terms summed.

use std::ops::{Add, Mul, Neg, Sub};

use rayon::prelude::*;

use crate::sparse::Leading;

/// Relative error of a product or a sum of two, far above the proved 2⁻¹⁰⁴.
pub(super) const UNIT: f64 = 7.9e-31;

/// A number of twice the working precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Double {
    pub(super) high: f64,
    low: f64,
}

impl From<f64> for Double {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// a · b without error.
pub(super) fn exact_product(a: f64, b: f64) -> Double {
    let high = a * b;
    Double { high, low: a.mul_add(b, -high) }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (s, e) = two_sum(self.high, other.high);
        let (t, f) = two_sum(self.low, other.low);
        let (s, e) = two_sum(s, e + t);
        let (high, low) = two_sum(s, e + f);
        Self { high, low }
    }
}

impl Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul<f64> for Double {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        let product = exact_product(self.high, factor);
        let (high, low) = two_sum(product.high, product.low + self.low * factor);
        Self { high, low }
    }
}

impl Double {
    /// The nearest double.
    pub(super) fn value(self) -> f64 {
        self.high + self.low
    }
}

/// A x and |A||x|.
pub(super) struct Product {
    pub(super) image: Vec<Double>,
    /// What the error of each row is relative to.
    pub(super) terms: Vec<f64>,
}

pub(super) fn product(matrix: Leading<'_>, x: &[f64]) -> Product {
    let row = |row: usize| {
        let (mut sum, mut terms) = (Double::default(), 0.0);
        for (col, value) in matrix.entries(row) {
            sum = sum + exact_product(value, x[col]);
            terms += (value * x[col]).abs();
        }
        (sum, terms)
    };
    let (image, terms) = (0..matrix.rows()).into_par_iter().map(row).unzip();
    Product { image, terms }
}

/// xᵀ y.
pub(super) fn dot(x: &[f64], y: &[Double]) -> Double {
    x.iter().zip(y).fold(Double::default(), |sum, (x, y)| sum + *y * *x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cancels_in_double_precision_is_kept() {
        let big = 1e16;
        let sum = Double::from(big) + Double::from(1.0) - Double::from(big);
        assert_eq!(sum.value(), 1.0);
        // (1 + ε)² − 1 − 2ε = ε².
        let one = 1.0 + f64::EPSILON;
        let rest = exact_product(one, one) - Double::from(1.0) - Double::from(2.0 * f64::EPSILON);
        assert_eq!(rest.value(), f64::EPSILON * f64::EPSILON);
    }
}
