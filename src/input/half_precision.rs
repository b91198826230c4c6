//! Whether numbers are those of a type of two bytes: eleven bits in half precision, eight in bfloat16.
//!
//! Numbers of b bits at most are such where they use their bits whatever their size. Whole numbers and multiples of a quarter that need as
//! few lie on a grid: two binades below the largest they have two bits less.

use std::collections::BTreeSet;

use super::decimal::Sampled;

/// Bits of the numbers of such types, the leading one counted.
const BITS: std::ops::RangeInclusive<u32> = 8..=11;
/// Decimal digits that they carry: half a unit of eight bits is 4e-3 of a number, of three digits 5e-3.
pub(super) const HALF_DIGITS: u32 = 3;
/// Different numbers, two binades below the largest and further, that have to be there: on a grid none of them uses its bits.
const MIN_DISTINCT: usize = 20;
/// Below this size half precision has fewer bits for each number.
const LEAST_NORMAL: f64 = 1.0 / 16_384.0;

/// Whether values are of such a type: more than half of those that are not among the largest use all of their bits but one. Of rounded
/// numbers three in four do.
pub(super) fn is_half_precision(sample: &[Sampled]) -> bool {
    let sizes = || sample.iter().map(|sampled| sampled.value.abs());
    let most_bits = sizes().map(bits).max().unwrap_or(0);
    if !BITS.contains(&most_bits) {
        return false;
    }
    let largest = sizes().fold(0.0, f64::max);
    let is_lower = |size: &f64| *size >= LEAST_NORMAL && binade(*size) + 2 <= binade(largest);
    let lower: BTreeSet<u64> = sizes().filter(is_lower).map(f64::to_bits).collect();
    let n_full = lower.iter().filter(|size| bits(f64::from_bits(**size)) + 1 >= most_bits).count();
    lower.len() >= MIN_DISTINCT && 2 * n_full > lower.len()
}

/// Bits from the leading one to the last that is set, of a normal number.
fn bits(size: f64) -> u32 {
    f64::MANTISSA_DIGITS - (size.to_bits() | 1 << (f64::MANTISSA_DIGITS - 1)).trailing_zeros()
}

fn binade(size: f64) -> i32 {
    (size.to_bits() >> (f64::MANTISSA_DIGITS - 1)) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_half(values: impl Iterator<Item = f64>) -> bool {
        is_half_precision(&values.map(Sampled::of).collect::<Vec<_>>())
    }

    /// Numbers of all sizes without a pattern, rounded to so many bits.
    fn rounded(n_bits: u32) -> impl Iterator<Item = f64> {
        (1..400).map(move |k| {
            let value = (f64::from(k) * 0.618_033_988_749_894_9).fract() * 2f64.powi(k % 9 - 3);
            let unit = (value.log2().floor() + 1.0 - f64::from(n_bits)).exp2();
            (value / unit).round() * unit
        })
    }

    #[test]
    fn numbers_of_two_bytes_use_their_bits_whatever_their_size() {
        assert!(is_half(rounded(11)) && is_half(rounded(8)));
        assert!(!is_half(rounded(24)) && !is_half(rounded(53)));
    }

    #[test]
    fn whole_numbers_and_quarters_are_exact() {
        for unit in [1.0, 0.25, 1e3] {
            for limit in [200, 2000] {
                assert!(!is_half((1..300).map(|k| f64::from(k * 7919 % limit) * unit)), "{limit} of {unit}");
            }
        }
        assert!(!is_half([1000.0, 2.5, 0.25, 0.375].into_iter()) && !is_half(std::iter::empty()));
    }
}
