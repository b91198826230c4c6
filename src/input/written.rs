//! What a text shows of the format that wrote its numbers.

use std::collections::BTreeSet;

/// Lines, or values, that are looked at.
pub(super) const SAMPLE: usize = 2000;
/// The most digits that every decimal fraction keeps in a double.
pub(super) const MAX_DECIMAL_DIGITS: u32 = 15;
/// Different values that use all their digits, without which none are taken for rounded.
pub(super) const MIN_DISTINCT: usize = 3;
/// Different values of a fixed format that never ends with a zero: the chance that none of so many does is one in two.
const MIN_DISTINCT_WITHOUT_ZEROS: usize = 6;
/// Different values of such a format of five digits and more: numbers that are exact have fewer.
const MIN_DISTINCT_OF_MANY_DIGITS: usize = 4;
const MANY_DIGITS: u32 = 5;
/// The fewest digits of a fixed format.
const MIN_FIXED_DIGITS: u32 = 3;
/// The fewest decimals of a fixed point that few numbers show: one is what halves need.
const MIN_DECIMALS: usize = 2;
/// Different last decimals of numbers that were rounded.
const MIN_LAST_DECIMALS: usize = 4;

/// What a fixed format writes of every number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Written {
    /// Significant digits.
    Digits(u32),
    /// Decimals after the point.
    Decimals(i32),
}

/// What the first lines of entries show.
pub(super) fn written(text: &[u8]) -> Option<Written> {
    digits(text).map(Written::Digits).or_else(|| decimals(text).map(Written::Decimals))
}

/// The last word of each of the first lines.
fn numbers(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let lines = text.split(|byte| *byte == b'\n').take(SAMPLE);
    lines.map(|line| line.trim_ascii().rsplit(u8::is_ascii_whitespace).next().unwrap_or_default())
}

/// Digits that a fixed format wrote of every number: of `1.31e-02` three, where all of the first lines have as many, trailing zeros
/// counted, and several different numbers use them all. Few different numbers show no pattern in their values, this shows in the text.
///
/// Numbers that need fewer digits than their format writes, those of springs and lumped masses, are exact. Numbers that are written as
/// short as they can be have no zeros at their end, and a format without any is believed where there are many numbers.
fn digits(text: &[u8]) -> Option<u32> {
    let (mut full, mut n_with_zeros) = (BTreeSet::new(), 0);
    let mut n_digits = None;
    for number in numbers(text) {
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
    let n_needed = match n_with_zeros {
        0 if n_digits < MANY_DIGITS => MIN_DISTINCT_WITHOUT_ZEROS,
        0 => MIN_DISTINCT_OF_MANY_DIGITS,
        _ => MIN_DISTINCT,
    };
    let is_fixed = (MIN_FIXED_DIGITS..=MAX_DECIMAL_DIGITS).contains(&n_digits) && full.len() >= n_needed;
    is_fixed.then_some(n_digits)
}

/// Decimals that fixed point wrote of every number: of `12.870` three, where all of the first lines have as many and no exponent,
/// trailing zeros counted.
///
/// Numbers that need fewer decimals are exact: three in five of different numbers must use the last one, six at least, and end with
/// four different digits that are not all even. Halves, quarters and multiples of 0.2 do not.
fn decimals(text: &[u8]) -> Option<i32> {
    let mut n_decimals = None;
    let mut distinct: BTreeSet<&[u8]> = BTreeSet::new();
    for number in numbers(text) {
        let number = number.strip_prefix(b"-").unwrap_or(number);
        if !number.first().is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.') {
            continue;
        }
        let point = number.iter().position(|byte| *byte == b'.')?;
        let after = &number[point + 1..];
        if !after.iter().all(u8::is_ascii_digit) || *n_decimals.get_or_insert(after.len()) != after.len() {
            return None;
        }
        if number.iter().any(|byte| (b'1'..=b'9').contains(byte)) {
            distinct.insert(number);
        }
    }
    let full: Vec<u8> =
        distinct.iter().filter_map(|number| number.last().copied()).filter(|last| *last != b'0').collect();
    let last: BTreeSet<u8> = full.iter().copied().collect();
    let is_rounded = full.len() >= MIN_DISTINCT_WITHOUT_ZEROS
        && 5 * full.len() >= 3 * distinct.len()
        && last.len() >= MIN_LAST_DECIMALS
        && last.iter().any(|last| (last - b'0') % 2 == 1);
    let n_decimals = n_decimals.filter(|n_decimals| *n_decimals >= MIN_DECIMALS && is_rounded)?;
    i32::try_from(n_decimals).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fixed_format_shows_however_few_numbers_there_are() {
        let text = b"1 1 1.31e-02\n2 2 6.54e-03\n2 1 -3.27e-03\n3 3 0.00e+00\n";
        assert_eq!(digits(text), Some(3));
        // As Fortran writes it.
        assert_eq!(digits(b"1 1  0.1312E-01\n2 2  0.6543E+02\n3 3  0.9999D+00\n2 1 0.2500E+01\n"), Some(4));
        // The parts of a regular mesh: four numbers.
        assert_eq!(digits(b"1 1 5.4514e-03\n2 1 2.7257e-03\n2 2 1.3628e-03\n3 1 6.8142e-04\n"), Some(5));
        // Exact numbers in a format with room to spare, too few numbers, numbers as short as they can be, and all their digits.
        assert_eq!(digits(b"1 1 2.5000e+00\n2 2 1.2500e-01\n3 3 -1.0000e+00\n4 4 7.5000e+01\n"), None);
        assert_eq!(digits(b"1 1 1.31e-02\n2 2 6.54e-03\n"), None);
        assert_eq!(digits(b"1 1 1.31e-02\n2 2 6.5e-03\n3 3 2.27e-01\n"), None);
        assert_eq!(
            digits(b"1 1 1.3100000000000001e-02\n2 2 6.5400000000000003e-03\n3 3 2.2700000000000001e-01\n"),
            None
        );
        assert_eq!(digits(b"1 1 1.25e0\n2 2 3.75e0\n3 3 6.25e1\n"), None);
        assert_eq!(digits(b"1 1 1e0\n2 2 2e0\n3 3 5e-1\n2 1 -4e0\n"), None);
        assert_eq!(digits(b"1 1 0.0131\n2 2 0.0654\n3 3 0.0227\n"), None);
    }

    #[test]
    fn fixed_point_shows_where_its_last_decimals_are_used() {
        let lumped =
            b"1 1 0.0123\n2 2 0.0245\n2 1 -0.0491\n3 3 0.0982\n4 4 0.1964\n5 5 0.3927\n6 5 -0.0000\n6 6 0.3930\n";
        assert_eq!(written(lumped), Some(Written::Decimals(4)));
        for exact in [
            &b"1 1 0.500\n2 2 0.250\n3 3 0.125\n4 4 0.375\n5 5 0.625\n6 6 0.875\n7 7 1.125\n"[..],
            b"1 1 0.25\n2 2 0.75\n3 3 1.25\n4 4 1.75\n5 5 2.25\n6 6 2.75\n",
            b"1 1 1.12\n2 2 0.14\n3 3 1.26\n4 4 1.78\n5 5 2.22\n6 6 2.72\n",
            b"1 1 1000.\n2 2 2000.\n3 3 1333.\n4 4 1777.\n5 5 1999.\n6 6 1212.\n",
            b"1 1 1.5\n2 2 2.25\n3 3 1.333\n4 4 1.777\n5 5 1.999\n6 6 1.212\n",
            b"1 1 1.51\n2 2 2.27\n3 3 1.33\n4 4 1.79\n",
        ] {
            assert_eq!(written(exact), None, "{}", String::from_utf8_lossy(exact));
        }
    }
}
