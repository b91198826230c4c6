//! Whether directions are told by the numbers that make them, or are what rounding left of a line.
//!
//! ```text
//! |off| ≤ √3 (2 off) (1/|a| + 1/|b|)    by which the sine of the angle between two differences of points may be wrong
//! ```

use super::decimal::Decimal;
use crate::dofs::{Axes, spanned, unit};

/// Roundings of a coordinate: its own as a double, and those of a sum of four products with a sine or cosine each.
const ROUNDINGS: f64 = 8.0;
/// A decimal number of so many digits and more looks rounded: a field of eight characters has room for six beside a point and a sign.
const ROUNDED_FROM: u32 = 6;
/// Sine below which directions may be one in a text of few digits. A larger angle was meant, however short the points are apart.
const NARROW: f64 = 1e-3;

/// By how much coordinates may be off.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Off {
    /// By rounding of doubles.
    rounding: f64,
    /// By what the digits of the text leave open.
    digits: f64,
}

impl Off {
    /// Of numbers of a text.
    pub(super) fn of_text(numbers: &[f64]) -> Self {
        let largest = numbers.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
        let digits = numbers.iter().map(|number| half_unit(*number)).fold(0.0, f64::max);
        Self { rounding: ROUNDINGS * f64::EPSILON * largest, digits }
    }

    /// Of a point that is read in a system elsewhere: `digits` is what its own numbers leave open.
    pub(super) fn of_point(point: [f64; 3], origin: [f64; 3], digits: f64) -> Self {
        let size = |point: [f64; 3]| point.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
        Self { rounding: ROUNDINGS * f64::EPSILON * (size(point) + size(origin)), digits }
    }

    /// Of both.
    pub(super) fn or(self, other: Self) -> Self {
        Self { rounding: self.rounding.max(other.rounding), digits: self.digits.max(other.digits) }
    }

    /// Right-handed axes as [`spanned`] makes them of two differences of such points; none where the directions may be one.
    pub(super) fn spanned(self, first: [f64; 3], second: [f64; 3]) -> Option<Axes> {
        let axes = spanned(first, second)?;
        let towards = unit(second);
        let sine: f64 = (0..3).map(|i| axes[1][i] * towards[i]).sum();
        let per_off = angle_per_off(first) + angle_per_off(second);
        let is_told = sine > per_off * self.rounding && sine > (per_off * self.digits).min(NARROW);
        is_told.then_some(axes)
    }

    /// Whether a difference of two such points has a direction beyond its rounding.
    pub(super) fn tells(self, line: [f64; 3]) -> bool {
        angle_per_off(line) * self.rounding < 1.0
    }
}

/// By which angle a difference of two points may be turned, for each unit that their coordinates are off.
fn angle_per_off(line: [f64; 3]) -> f64 {
    2.0 * 3f64.sqrt() / line.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Half a unit of the last digit of a number that looks rounded; nothing for others, which are as they are meant.
pub(super) fn half_unit(number: f64) -> f64 {
    let decimal = Decimal::of(number);
    if decimal.n_digits < ROUNDED_FROM { 0.0 } else { 0.5 * 10f64.powi(-decimal.n_decimals()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn are_told(points: [[f64; 3]; 3]) -> bool {
        let between = |to: [f64; 3]| std::array::from_fn(|i| to[i] - points[0][i]);
        Off::of_text(points.as_flattened()).spanned(between(points[1]), between(points[2])).is_some()
    }

    #[test]
    fn points_in_line_but_for_their_digits_span_nothing() {
        for points in [
            [[0.1, -0.2, 0.3], [0.2, 0.1, 0.9], [0.3, 0.4, 1.5]],
            [[0.0; 3], [0.333333, 0.666667, 1.0], [0.666667, 1.333333, 2.0]],
            [[0.0; 3], [0.00333333, 0.00666667, 0.01], [0.00666667, 0.0133333, 0.02]],
            [[1e5 + 0.1, 0.3, 0.7], [1e5 + 0.2, 0.6, 1.4], [1e5 + 0.3, 0.9, 2.1]],
            [[1.0; 3], [1.0, 1.0, 1.0 + f64::EPSILON], [2.0, 1.0, 1.0]],
            [[0.0; 3]; 3],
        ] {
            assert!(!are_told(points), "{points:?}");
        }
    }

    #[test]
    fn points_that_are_meant_apart_span_axes() {
        for points in [
            [[0.1, -0.2, 0.3], [0.2, 0.1, 0.9], [1.0, 0.3, 0.1]],
            // One unit of the last digit apart, at a right angle.
            [[100.001, 0.0, 0.0], [100.001, 0.0, 0.001], [100.002, 0.0, 0.0]],
            [[0.0; 3], [0.0, 0.0, 1.0], [1e-3, 0.0, 1.0]],
            [[0.0; 3], [1e-9, 0.0, 0.0], [0.0, 1e-9, 0.0]],
        ] {
            assert!(are_told(points), "{points:?}");
        }
    }
}
