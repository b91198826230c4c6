//! Powers of two taken out of K and M.

use crate::error::{Error, Result};
use crate::sparse::SparseMatrix;
use crate::sparse::diagonal;

/// Largest and smallest exponents: what is left at the upper end takes the sums of many entries, at the lower end entries
/// of a 10⁻¹⁸ th of the largest with all their digits.
const EXPONENTS: std::ops::RangeInclusive<i32> = -960..=1000;
/// Exponents of the ratio of K to M. No sums are made of it: what is left at the upper end, 2¹⁵, takes eigenvalues above the ratio
/// of the largest entries; frequencies that leave the range all the same are refused where they are written.
const RATIOS: std::ops::RangeInclusive<i32> = -960..=1008;

/// Exponents of the powers of two taken out of K and M.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scaling {
    /// K = 2^stiffness · K_scaled.
    pub stiffness: i32,
    /// M = 2^mass · M_scaled.
    pub mass: i32,
}

impl Scaling {
    /// Scales both matrices by powers of two, so that their largest diagonal entries lie in [1, 2).
    ///
    /// # Errors
    /// Numbers, or frequencies made of them, near the ends of the range of double precision.
    pub(super) fn take_out(stiffness: &mut SparseMatrix, mass: &mut SparseMatrix) -> Result<Self> {
        let (stiffness_exponent, mass_exponent) = rayon::join(|| scale_to_unit(stiffness), || scale_to_unit(mass));
        let scaling = Self { stiffness: stiffness_exponent, mass: mass_exponent };
        let ratio = scaling.stiffness - scaling.mass;
        // Next to one huge entry the others may fall below what the range holds with all digits.
        let least = |matrix: &SparseMatrix| {
            let positive = diagonal(matrix).into_iter().filter(|value| *value > 0.0);
            positive.fold(f64::INFINITY, f64::min)
        };
        let smallest = least(stiffness).min(least(mass));
        let smallest = if smallest.is_finite() { binary_exponent(smallest) } else { 0 };
        let sizes = [
            ("the stiffness", scaling.stiffness, EXPONENTS),
            ("the mass", scaling.mass, EXPONENTS),
            ("the ratio of stiffness to mass, the square of a frequency,", ratio, RATIOS),
            ("the smallest diagonal entry, relative to the largest,", smallest, EXPONENTS),
        ];
        match sizes.into_iter().find(|(_, exponent, range)| !range.contains(exponent)) {
            Some((what, exponent, _)) => Err(Error::UnitRange { what, exponent }),
            None => Ok(scaling),
        }
    }

    /// Factor from a scaled stiffness to the user's.
    pub fn stiffness_unit(&self) -> f64 {
        2f64.powi(self.stiffness)
    }

    /// Factor from a scaled mass to the user's.
    pub fn mass_unit(&self) -> f64 {
        2f64.powi(self.mass)
    }

    /// Factor from a scaled mass-normalised shape to the user's: one over the root of the mass unit, exact for an even
    /// exponent.
    pub fn shape_unit(&self) -> f64 {
        let root = 2f64.powi(-self.mass.div_euclid(2));
        if self.mass.rem_euclid(2) == 0 { root } else { root * std::f64::consts::FRAC_1_SQRT_2 }
    }

    /// The circular frequency of a scaled eigenvalue in rad/s; that of a negative one is negative.
    pub fn omega(&self, lambda: f64) -> f64 {
        (lambda * self.eigenvalue_unit()).abs().sqrt().copysign(lambda)
    }

    /// The frequency of a scaled eigenvalue in Hz; that of a negative one is negative.
    pub fn hertz(&self, lambda: f64) -> f64 {
        self.omega(lambda) / std::f64::consts::TAU
    }

    /// The scaled eigenvalue of a frequency in Hz.
    pub fn eigenvalue(&self, frequency_hz: f64) -> f64 {
        let omega = std::f64::consts::TAU * frequency_hz;
        omega * omega / self.eigenvalue_unit()
    }

    /// Factor from a scaled eigenvalue to the user's (rad/s)².
    pub fn eigenvalue_unit(&self) -> f64 {
        2f64.powi(self.stiffness - self.mass)
    }
}

/// Divides by the power of two that brings the largest diagonal entry into [1, 2); returns its exponent.
fn scale_to_unit(matrix: &mut SparseMatrix) -> i32 {
    let largest = diagonal(&*matrix).iter().fold(0.0f64, |max, value| max.max(value.abs()));
    if largest == 0.0 {
        return 0;
    }
    let exponent = binary_exponent(largest);
    // Two factors, because 2^-exponent itself can leave the range of a double.
    let (half, rest) = (2f64.powi(-(exponent / 2)), 2f64.powi(-(exponent - exponent / 2)));
    for value in matrix.data_mut() {
        *value = *value * half * rest;
    }
    exponent
}

/// ⌊log₂ x⌋ of a positive number, from its bits: a logarithm rounds up just below a power of two.
fn binary_exponent(x: f64) -> i32 {
    const MANTISSA_BITS: u32 = 52;
    const BIAS: i32 = 1023;
    // Below the normal numbers the exponent sits in the leading zeros of the mantissa; a factor lifts it out of there.
    if x < f64::MIN_POSITIVE {
        return binary_exponent(x * 2f64.powi(64)) - 64;
    }
    (x.to_bits() >> MANTISSA_BITS) as i32 - BIAS
}
