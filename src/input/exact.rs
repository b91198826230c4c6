//! Whether numbers of seven digits and more are exact by design, although they look rounded to so many digits.
//!
//! Rounded numbers have no relation to short ones, and use the last of their digits nine times in ten. Two relations tell numbers that
//! are exact:
//!
//! - *Sums of short numbers.* Springs of 10⁴ and 0.25 make an entry of 10000.25. A long number, of seven digits and more, is explained
//!   where it is the sum or difference of two others, of which one is short, of at most six digits and two fewer than the source would
//!   have, and the other one is not long or is explained itself. Numbers rounded to d digits are as short with a chance of one in a
//!   hundred. With m numbers, s of them short, 2ms sums are compared with 10^(d−1) numbers of d digits; ms ≤ 10^(d−3) leaves each long
//!   number a chance of one in fifty to be explained without being a sum. All of them have to be.
//! - *A binary unit.* Of numbers rounded to k decimals a share of 2^min(k, j) / 10^k are multiples of 2^−j: one in five are halves, and
//!   of those with two decimals one in 25 are quarters. Multiples of one number by powers of two count once. Half of the numbers may be
//!   sums of others; so the chance that all long ones are multiples must be below 10⁻⁸, which leaves 10⁻⁴ for half of them. That takes six
//!   quarters or twelve halves.

use std::collections::{BTreeMap, BTreeSet};

use super::decimal::Decimal;

/// The most digits of a number that counts as short.
pub(super) const MAX_EXACT_DIGITS: u32 = 6;
/// Digits that a short number has fewer than the source, and chance that a rounded number is as short as that, as a power of ten.
const SHORTER_BY: u32 = 2;
/// The most pairs of numbers that are looked at.
const MAX_PAIRS: usize = 100_000;
/// The smallest binary fraction that is looked for, as a power of one half.
const MAX_BINARY_DECIMALS: i32 = 3;
/// Chance below which long numbers are no multiples of a binary fraction without being exact.
const CHANCE: f64 = 1e-8;
/// How far a sum of two doubles may be from the double that is nearest to the sum of their decimals.
const SUM_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Whether numbers of at most `digits` digits, more than six, are exact.
pub(super) fn is_exact(distinct: &BTreeSet<Decimal>, digits: u32) -> bool {
    are_sums(distinct, digits) || have_binary_unit(distinct, digits)
}

fn is_long(decimal: &Decimal) -> bool {
    decimal.n_digits > MAX_EXACT_DIGITS
}

/// Whether all long numbers of a source of so many digits are sums of others and short ones. Of up to six digits, long are numbers that use
/// them all.
pub(super) fn are_sums(distinct: &BTreeSet<Decimal>, digits: u32) -> bool {
    let max_short = MAX_EXACT_DIGITS.min(digits.saturating_sub(SHORTER_BY));
    let is_long = |decimal: &Decimal| decimal.n_digits > MAX_EXACT_DIGITS.min(digits.saturating_sub(1));
    let sizes = |wanted: &dyn Fn(&Decimal) -> bool| -> Vec<f64> {
        let mut sizes: Vec<f64> =
            distinct.iter().filter(|decimal| wanted(decimal)).map(|decimal| decimal.size()).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        sizes
    };
    let short = sizes(&|decimal| decimal.n_digits <= max_short);
    let most = 10f64.powi(digits as i32 - 3).min(MAX_PAIRS as f64);
    if (short.len() * distinct.len()) as f64 > most {
        return false;
    }
    let mut known = sizes(&|decimal| !is_long(decimal));
    // A sum has as many digits as its longest part, or more: parts come first.
    let mut long: Vec<Decimal> = distinct.iter().copied().filter(|decimal| is_long(decimal)).collect();
    long.sort_unstable_by_key(|decimal| (decimal.n_digits, decimal.exponent, decimal.mantissa));
    for decimal in long {
        let sum = decimal.size();
        let holds = |size: f64, of: f64| {
            let tolerance = SUM_ROUNDING * (sum + of);
            let from = known.partition_point(|other| *other < size - tolerance);
            known.get(from).is_some_and(|other| *other <= size + tolerance)
        };
        if !short.iter().any(|part| holds((sum - part).abs(), *part) || holds(sum + part, *part)) {
            return false;
        }
        let at = known.partition_point(|other| *other < sum);
        known.insert(at, sum);
    }
    true
}

/// Whether all numbers are multiples of a half, a quarter or an eighth, and long ones are so by no chance of rounding.
fn have_binary_unit(distinct: &BTreeSet<Decimal>, digits: u32) -> bool {
    let is_multiple =
        |power: i32| distinct.iter().all(|decimal| (decimal.size() * f64::from(1 << power)).fract() == 0.0);
    let Some(power) = (0..=MAX_BINARY_DECIMALS).find(|power| is_multiple(*power)).filter(|power| *power > 0) else {
        return false;
    };
    let share = |decimals: i32| f64::from(1 << power.min(decimals)) / 10f64.powi(decimals);
    // By their odd factor, the chances of the number with the most decimals, had all been rounded to so many digits.
    let mut chances: BTreeMap<u64, f64> = BTreeMap::new();
    for decimal in distinct.iter().filter(|decimal| is_long(decimal)) {
        let multiple = (decimal.size() * f64::from(1 << power)) as u64;
        let chance = share((digits as i32 - 1 - decimal.exponent).max(0));
        let of_factor = chances.entry(multiple >> multiple.trailing_zeros()).or_insert(1.0);
        *of_factor = of_factor.min(chance);
    }
    let of_digits: f64 = chances.values().product();
    // Had all been rounded to the decimals that they have.
    let of_decimals = share(power).powi(chances.len() as i32);
    of_digits.max(of_decimals) <= CHANCE
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distinct(values: impl IntoIterator<Item = f64>) -> BTreeSet<Decimal> {
        values.into_iter().map(Decimal::of).collect()
    }

    #[test]
    fn long_numbers_are_sums_of_short_ones_or_are_not() {
        let are = |values: &[f64], digits| are_sums(&distinct(values.iter().copied()), digits);
        assert!(are(&[10000.25, 10000.0, 0.25, 2.5], 7));
        // A sum may be a part of another one, and a spring may stand in the matrix as a difference only.
        assert!(are(&[10000.25, 1010000.25, 1e6, 0.25, 10000.0], 9));
        assert!(are(&[100_000.5, 99_999.5, 0.5, 1e5], 7));
        assert!(!are(&[10000.25, 10000.0, 0.125, 2.5], 7));
        assert!(!are(&[0.3333333, 0.8333333, 0.5], 7));
        // Of five digits: 100.25 = 100 + 0.25, and nothing makes 95.399.
        assert!(are(&[100.25, 100.0, 0.25], 5));
        assert!(!are(&[95.399, 10.6, 21.2, 42.4], 5));
        // Too many numbers, of which chance makes sums.
        let many: Vec<f64> = (1..2000).map(f64::from).chain([1999.0001]).collect();
        assert!(!are(&many, 8));
    }

    #[test]
    fn binary_units_are_believed_of_as_many_numbers_as_chance_leaves_none() {
        let quarters = |n: i32| distinct((0..n).map(|k| f64::from(4 * 10_007 + 4001 * k) / 4.0 + 1e4));
        assert!(have_binary_unit(&quarters(40), 7));
        assert!(!have_binary_unit(&quarters(5), 7));
        // All that seven digits leave of numbers above 10⁶ are whole numbers.
        let whole = distinct((0..40).map(|k| f64::from(1_234_567 + 70_001 * k)));
        assert!(!have_binary_unit(&whole, 7));
        let above = distinct((0..40).map(|k| f64::from(1_234_567 + 70_001 * k)).chain([0.5]));
        assert!(!have_binary_unit(&above, 7));
    }
}
