//! How many decimal digits the values of a matrix carry.
//!
//! A value that went through a text of d digits is a double whose shortest decimal form has at most d digits, whatever
//! the text it was read from looks like now: `84695.512820513002` is the double nearest to the fourteen digits
//! `84695.512820513`. A computed double needs sixteen or seventeen. So the shortest forms of a sample are counted.
//!
//! The rule, and its limits:
//!
//! - d is the number of digits that 99 of 100 sampled values do not exceed. With d above 15 the data are binary: 17;
//!   unless the values are all single precision numbers: 7.
//! - d from 7 to 15 is taken as the precision of the source. Values that are exact by design and need so many digits
//!   in *every* entry are taken for rounded; for this there must be three different ones.
//! - A text in a fixed scientific format shows its d, see [`written_digits`].
//! - d up to 6 is otherwise a source of that few digits only if the values look rounded *relative to their size*: many different
//!   ones, over more than a decade, where those of the lower decades need d digits as often as those of the highest.
//!   Integers and short decimal fractions (springs of 2 and −1, lumped masses of 0.25) fail this and are exact: 17.

use std::collections::BTreeSet;

/// Digits that any double needs at most.
const DOUBLE_DIGITS: u32 = 17;
/// Digits that a single precision number carries.
const SINGLE_DIGITS: u32 = 7;
/// The most digits that every decimal fraction keeps in a double.
const MAX_DECIMAL_DIGITS: u32 = 15;
/// The most digits that occur in exact data.
const MAX_EXACT_DIGITS: u32 = 6;
/// Size of the sample.
const SAMPLE: usize = 2000;
/// Different values that data of many digits must have to be taken for rounded.
const MIN_DISTINCT: usize = 3;
/// Different values of a fixed format that never ends with a zero: the chance that none of so many does is one in two.
const MIN_DISTINCT_WITHOUT_ZEROS: usize = 6;
/// The fewest digits of a fixed format.
const MIN_FIXED_DIGITS: u32 = 3;
/// Different values, in the lower decades, that data of few digits must have to be taken for rounded.
const MIN_DISTINCT_SHORT: usize = 20;

/// Significant decimal digits of the source of these values: 17 for binary data and for exact short numbers.
///
/// Looks at about 2000 values spread over the slice; zeros do not count.
pub fn significant_digits(values: &[f64]) -> u32 {
    let sample: Vec<f64> = spread(values).filter(|value| value.is_finite() && *value != 0.0).collect();
    if sample.is_empty() {
        return DOUBLE_DIGITS;
    }
    let mut counts: Vec<u32> = sample.iter().map(|&value| Decimal::of(value).n_digits).collect();
    counts.sort_unstable();
    let digits = counts[(counts.len() * 99).div_ceil(100) - 1];
    let distinct: BTreeSet<Decimal> = sample.iter().map(|&value| Decimal::of(value)).collect();
    let is_short = digits <= MAX_EXACT_DIGITS;
    if digits > MAX_DECIMAL_DIGITS {
        let is_single = sample.iter().all(|&value| f64::from(value as f32) == value);
        return if is_single { SINGLE_DIGITS } else { DOUBLE_DIGITS };
    }
    let is_from_text = if is_short { is_rounded(&distinct, digits) } else { n_mantissas(&distinct) >= MIN_DISTINCT };
    if is_from_text { digits } else { DOUBLE_DIGITS }
}

/// Digits that a fixed format wrote of every number: of `1.31e-02` three, where all of the first lines have as many, trailing zeros
/// counted, and several different numbers use them all. Few different numbers show no pattern in their values, this shows in the text.
///
/// Numbers that need fewer digits than their format writes, those of springs and lumped masses, are exact. Numbers that are written as
/// short as they can be have no zeros at their end, and a format without any is believed where there are many numbers.
pub(super) fn written_digits(text: &[u8]) -> Option<u32> {
    let (mut full, mut n_with_zeros) = (BTreeSet::new(), 0);
    let mut n_digits = None;
    for line in text.split(|byte| *byte == b'\n').take(SAMPLE) {
        let number = line.trim_ascii().rsplit(u8::is_ascii_whitespace).next().unwrap_or_default();
        let Some(end) = number.iter().position(|byte| b"eEdD".contains(byte)) else {
            // Comments and blank lines tell nothing, a number in another format does.
            if number.first().is_some_and(u8::is_ascii_digit) {
                return None;
            }
            continue;
        };
        let digits: Vec<u8> = number[..end].iter().copied().filter(u8::is_ascii_digit).collect();
        // Some formats begin with a zero before the point, which is none of the digits.
        let digits = if number.contains(&b'.') { digits.strip_prefix(b"0").unwrap_or(&digits) } else { &digits };
        if digits.iter().all(|digit| *digit == b'0') {
            n_with_zeros += usize::from(digits.len() > 1);
            continue;
        }
        if *n_digits.get_or_insert(digits.len()) != digits.len() {
            return None;
        }
        if digits.last() == Some(&b'0') {
            n_with_zeros += 1;
        } else {
            full.insert(digits.to_vec());
        }
    }
    let n_digits = u32::try_from(n_digits?).ok()?;
    let n_needed = if n_with_zeros > 0 { MIN_DISTINCT } else { MIN_DISTINCT_WITHOUT_ZEROS };
    let is_fixed = (MIN_FIXED_DIGITS..=MAX_DECIMAL_DIGITS).contains(&n_digits) && full.len() >= n_needed;
    is_fixed.then_some(n_digits)
}

/// Equally spaced values from the first to near the last.
fn spread(values: &[f64]) -> impl Iterator<Item = f64> {
    let n_sampled = values.len().min(SAMPLE);
    (0..n_sampled).map(move |k| values[(k as u128 * values.len() as u128 / n_sampled as u128) as usize])
}

/// The shortest decimal form of the size of a number that reads back as the same double.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Decimal {
    exponent: i32,
    mantissa: u64,
    n_digits: u32,
}

impl Decimal {
    fn of(value: f64) -> Self {
        let text = format!("{:e}", value.abs());
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
        let digits = digits.trim_end_matches('0');
        Self {
            exponent: exponent.parse().unwrap_or(0),
            mantissa: digits.parse().unwrap_or(0),
            n_digits: digits.len() as u32,
        }
    }
}

fn n_mantissas(distinct: &BTreeSet<Decimal>) -> usize {
    distinct.iter().map(|decimal| decimal.mantissa).collect::<BTreeSet<_>>().len()
}

/// Whether numbers of at most `digits` digits look rounded relative to their size: below the highest decade, too, most
/// use all the digits. Of rounded numbers nine in ten do; numbers on a fixed grid have fewer the smaller they are.
fn is_rounded(distinct: &BTreeSet<Decimal>, digits: u32) -> bool {
    let top = distinct.last().map_or(0, |decimal| decimal.exponent);
    let lower: BTreeSet<(u64, u32)> = distinct
        .iter()
        .filter(|decimal| decimal.exponent < top)
        .map(|decimal| (decimal.mantissa, decimal.n_digits))
        .collect();
    let n_full = lower.iter().filter(|(_, n_digits)| *n_digits == digits).count();
    lower.len() >= MIN_DISTINCT_SHORT && 2 * n_full > lower.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of all sizes without a pattern.
    fn scattered(n: usize) -> Vec<f64> {
        let value = |k: usize| ((k as f64 + 1.0) * 0.618_033_988_749_894_9).fract() * 10_f64.powi((k % 9) as i32 - 3);
        (0..n).map(value).collect()
    }

    fn printed(values: &[f64], n_digits: usize) -> Vec<f64> {
        let rounded = |value: &f64| format!("{value:.*e}", n_digits - 1).parse().expect("a number");
        values.iter().map(rounded).collect()
    }

    #[test]
    fn a_fixed_format_shows_however_few_numbers_there_are() {
        let text = b"1 1 1.31e-02\n2 2 6.54e-03\n2 1 -3.27e-03\n3 3 0.00e+00\n";
        assert_eq!(written_digits(text), Some(3));
        // As Fortran writes it.
        assert_eq!(written_digits(b"1 1  0.1312E-01\n2 2  0.6543E+02\n3 3  0.9999D+00\n2 1 0.2500E+01\n"), Some(4));
        // Exact numbers in a format with room to spare, too few numbers, numbers as short as they can be, and all their digits.
        assert_eq!(written_digits(b"1 1 2.5000e+00\n2 2 1.2500e-01\n3 3 -1.0000e+00\n4 4 7.5000e+01\n"), None);
        assert_eq!(written_digits(b"1 1 1.31e-02\n2 2 6.54e-03\n"), None);
        assert_eq!(written_digits(b"1 1 1.31e-02\n2 2 6.5e-03\n3 3 2.27e-01\n"), None);
        assert_eq!(
            written_digits(b"1 1 1.3100000000000001e-02\n2 2 6.5400000000000003e-03\n3 3 2.2700000000000001e-01\n"),
            None
        );
        assert_eq!(written_digits(b"1 1 1.25e0\n2 2 3.75e0\n3 3 6.25e1\n"), None);
        assert_eq!(written_digits(b"1 1 1e0\n2 2 2e0\n3 3 5e-1\n2 1 -4e0\n"), None);
        assert_eq!(written_digits(b"1 1 0.0131\n2 2 0.0654\n3 3 0.0227\n"), None);
    }

    #[test]
    fn computed_values_carry_all_digits() {
        assert_eq!(significant_digits(&scattered(5000)), 17);
    }

    #[test]
    fn printed_values_carry_the_digits_of_the_print() {
        for n_digits in 3..=15 {
            assert_eq!(significant_digits(&printed(&scattered(5000), n_digits)), n_digits as u32);
        }
    }

    #[test]
    fn a_few_full_values_among_printed_ones_do_not_count() {
        let mut values = printed(&scattered(2000), 10);
        values[77] = std::f64::consts::PI;
        assert_eq!(significant_digits(&values), 10);
    }

    #[test]
    fn exact_short_values_are_exact() {
        let integers: Vec<f64> = (0..2000).map(|k| f64::from(k * k % 99_991)).collect();
        let hundredths: Vec<f64> = integers.iter().map(|value| value / 100.0).collect();
        for values in [vec![2.0, -1.0, 2.0], vec![0.25; 50], vec![0.0; 5], vec![], integers, hundredths] {
            assert_eq!(significant_digits(&values), 17, "{:?}", &values[..values.len().min(3)]);
        }
    }

    #[test]
    fn one_long_constant_is_no_rounding() {
        assert_eq!(significant_digits(&[1_234_567.5, -1_234_567.5, 2_469_135.0]), 17);
    }

    #[test]
    fn single_precision_values_carry_seven_digits() {
        let single: Vec<f64> = scattered(500).iter().map(|&value| f64::from(value as f32)).collect();
        assert_eq!(significant_digits(&single), 7);
    }
}
