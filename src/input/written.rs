//! What a text shows of the format that wrote its numbers.

use std::collections::{BTreeMap, BTreeSet};

use super::decimal::Decimal;
use super::exact::are_sums;

/// Lines, or values, that are looked at.
pub(super) const SAMPLE: usize = 2000;
/// The most digits that every decimal fraction keeps in a double.
pub(super) const MAX_DECIMAL_DIGITS: u32 = 15;
/// Different values that use all their digits, without which none are taken for rounded.
pub(super) const MIN_DISTINCT: usize = 3;
/// Different values of a fixed format that never ends with a zero: the chance that none of so many does is one in two.
const MIN_DISTINCT_WITHOUT_ZEROS: usize = 6;
/// Different values of a format of five digits and more, of which one at least uses all of them: numbers that are exact have fewer digits.
const MIN_DISTINCT_OF_MANY_DIGITS: usize = 4;
const MANY_DIGITS: u32 = 5;
/// The most formats that the numbers of a file are written in.
const MOST_FORMATS: usize = 3;
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
    /// As many characters as a field has: each number is known to one of the two.
    Fields {
        /// Significant digits.
        digits: u32,
        /// Decimals after the point.
        decimals: Option<i32>,
    },
}

/// What the first lines of entries show.
pub(super) fn written(text: &[u8]) -> Option<Written> {
    let of_digits = digits(text).or_else(|| general(text)).map(Written::Digits);
    of_digits.or_else(|| decimals(text).map(Written::Decimals)).or_else(|| fields(text))
}

/// The last word of each of the first lines.
fn numbers(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let lines = text.split(|byte| *byte == b'\n').take(SAMPLE);
    lines.map(|line| line.trim_ascii().rsplit(u8::is_ascii_whitespace).next().unwrap_or_default())
}

/// Digits that a fixed format wrote of every number: of `1.31e-02` three, where all of the first lines have as many, trailing zeros
/// counted, and several different numbers use them all. Few different numbers show no pattern in their values, this shows in the text.
/// Where the lines are of two or three formats, of other digits off the diagonal for instance, each has to be one, and the shortest counts.
///
/// Numbers that need fewer digits than their format writes, those of springs and lumped masses, are exact, and so are sums of such. Numbers
/// that are written as short as they can be have no zeros at their end, and a format without any is believed where there are many numbers.
fn digits(text: &[u8]) -> Option<u32> {
    let mut formats: BTreeMap<usize, Scientific> = BTreeMap::new();
    let mut n_zeros = 0;
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
            n_zeros += usize::from(digits.len() > 1);
            continue;
        }
        let format = formats.entry(digits.len()).or_default();
        format.distinct.extend(value(number).map(Decimal::of));
        if digits.last() == Some(&b'0') {
            format.n_with_zeros += 1;
        } else {
            format.full.insert(digits.to_vec());
        }
    }
    let mut formats =
        formats.into_iter().filter_map(|(n_digits, format)| Some((u32::try_from(n_digits).ok()?, format)));
    let (first, others): (_, Vec<_>) = (formats.next()?, formats.collect());
    let is_fixed = match others.is_empty() {
        true => Scientific { n_with_zeros: first.1.n_with_zeros + n_zeros, ..first.1 }.is_fixed(first.0),
        false => {
            let all = || std::iter::once(&first).chain(&others);
            // Numbers as short as they can be have several lengths, too, and no zeros at their end.
            let has_zeros = all().any(|(_, format)| format.n_with_zeros > 0);
            others.len() < MOST_FORMATS
                && has_zeros
                && all().all(|(n_digits, format)| format.is_one_of_several(*n_digits))
        }
    };
    is_fixed.then_some(first.0)
}

/// What numbers in scientific notation of one number of digits show.
#[derive(Default)]
struct Scientific {
    /// The digits of those that end with no zero.
    full: BTreeSet<Vec<u8>>,
    n_with_zeros: usize,
    distinct: BTreeSet<Decimal>,
}

impl Scientific {
    /// Whether they are all in this format, and rounded by it.
    fn is_fixed(&self, n_digits: u32) -> bool {
        let is_enough = match self.n_with_zeros {
            _ if self.full.len() >= MIN_DISTINCT_WITHOUT_ZEROS => true,
            0 if n_digits < MANY_DIGITS => false,
            _ if n_digits >= MANY_DIGITS && self.distinct.len() >= MIN_DISTINCT_OF_MANY_DIGITS => !self.full.is_empty(),
            n_with_zeros => n_with_zeros > 0 && self.full.len() >= MIN_DISTINCT,
        };
        (MIN_FIXED_DIGITS..=MAX_DECIMAL_DIGITS).contains(&n_digits) && is_enough && !are_sums(&self.distinct, n_digits)
    }

    /// Whether they are so next to others in another one.
    fn is_one_of_several(&self, n_digits: u32) -> bool {
        self.full.len() >= MIN_DISTINCT_WITHOUT_ZEROS && self.is_fixed(n_digits)
    }
}

/// Decimals that fixed point wrote of every number: of `12.870` three, where all of the first lines have as many and no exponent,
/// trailing zeros counted; the fewest where the lines are of two or three formats, each of which has to be one.
///
/// Numbers that need fewer decimals are exact: three in five of different numbers must use the last one, six at least, and end with
/// four different digits that are not all even. Halves, quarters and multiples of 0.2 do not.
fn decimals(text: &[u8]) -> Option<i32> {
    let mut formats: BTreeMap<usize, BTreeSet<&[u8]>> = BTreeMap::new();
    for number in numbers(text) {
        let number = number.strip_prefix(b"-").unwrap_or(number);
        if !number.first().is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.') {
            continue;
        }
        let point = number.iter().position(|byte| *byte == b'.')?;
        let after = &number[point + 1..];
        if !after.iter().all(u8::is_ascii_digit) {
            return None;
        }
        let format = formats.entry(after.len()).or_default();
        if number.iter().any(|byte| (b'1'..=b'9').contains(byte)) {
            format.insert(number);
        }
    }
    let is_fixed = match formats.len() {
        1 => formats.values().all(rounded_to_last),
        2..=MOST_FORMATS => {
            let has_zeros = formats.values().flatten().any(|number| number.last() == Some(&b'0'));
            has_zeros && formats.values().all(rounded_to_last)
        }
        _ => false,
    };
    let n_decimals = formats.into_keys().next().filter(|n_decimals| *n_decimals >= MIN_DECIMALS && is_fixed)?;
    i32::try_from(n_decimals).ok()
}

/// Whether different numbers in fixed point look rounded to their last decimal.
fn rounded_to_last(distinct: &BTreeSet<&[u8]>) -> bool {
    let full: Vec<u8> =
        distinct.iter().filter_map(|number| number.last().copied()).filter(|last| *last != b'0').collect();
    let last: BTreeSet<u8> = full.iter().copied().collect();
    full.len() >= MIN_DISTINCT_WITHOUT_ZEROS
        && 5 * full.len() >= 3 * distinct.len()
        && last.len() >= MIN_LAST_DECIMALS
        && last.iter().any(|last| (last - b'0') % 2 == 1)
}

/// Digits of the general format, `%.6g`, in which streams of C++ write: numbers with more digits before the point than it keeps have an exponent.
///
/// `5.16923e+06` is longer than `5169230`, so that nobody wrote it who writes numbers as short as they can be. The format keeps no more digits
/// than the least of these exponents, and cuts zeros at the end. Several different numbers have to use all of them, and be no sums of short ones.
/// Of fewer than five digits it has to be that exponent which says that there are no more: `1.25e+06` may have been written with six.
fn general(text: &[u8]) -> Option<u32> {
    let (mut distinct, mut n_whole, mut least_power) = (BTreeSet::new(), 0, i32::MAX);
    for number in numbers(text).filter(|number| number.iter().any(u8::is_ascii_digit)) {
        let number = number.strip_prefix(b"-").unwrap_or(number);
        let (mantissa, power) = match number.iter().position(|byte| *byte == b'e') {
            Some(end) => (&number[..end], Some(std::str::from_utf8(&number[end + 1..]).ok()?)),
            None => (number, None),
        };
        let point = mantissa.iter().position(|byte| *byte == b'.');
        let is_cut = point.is_none() || !matches!(mantissa.last(), Some(b'0' | b'.'));
        if !is_cut || !mantissa.iter().all(|byte| byte.is_ascii_digit() || *byte == b'.') {
            return None;
        }
        match power {
            Some(power) => {
                let power: i32 = power.starts_with(['+', '-']).then(|| power.parse().ok())??;
                let n_shortest = mantissa.len().saturating_sub(1).max(usize::try_from(power).unwrap_or(0) + 1);
                if power >= 0 && number.len() > n_shortest {
                    least_power = least_power.min(power);
                }
            }
            None => n_whole = n_whole.max(point.unwrap_or(mantissa.len())),
        }
        distinct.extend(value(number).map(Decimal::of));
    }
    let n_digits = distinct.iter().map(|decimal| decimal.n_digits).max()?;
    let n_full = distinct.iter().filter(|decimal| decimal.n_digits == n_digits).count();
    let is_known = n_digits >= MANY_DIGITS || n_digits as i32 == least_power;
    let is_kept = is_known && least_power < i32::MAX && n_digits as i32 <= least_power && n_whole <= n_digits as usize;
    let is_general = is_kept && (MIN_FIXED_DIGITS..=MAX_DECIMAL_DIGITS).contains(&n_digits) && n_full >= MIN_DISTINCT;
    (is_general && !are_sums(&distinct, n_digits)).then_some(n_digits)
}

/// A number that fills its field.
struct Filling {
    size: f64,
    /// Digits from the first one that is not zero.
    digits: u32,
    /// Decimals of its last digit, as if it had no exponent.
    decimals: i32,
}

impl Filling {
    fn of(number: &[u8]) -> Option<Self> {
        let end = number.iter().position(|byte| b"eEdD".contains(byte)).unwrap_or(number.len());
        let (mantissa, power) = (&number[..end], number.get(end + 1..));
        let exponent = power.map_or(Some(0), |power| std::str::from_utf8(power).ok()?.parse::<i32>().ok())?;
        let after = mantissa.iter().position(|byte| *byte == b'.').map_or(0, |point| mantissa.len() - point - 1);
        let digits = mantissa.iter().filter(|byte| byte.is_ascii_digit()).skip_while(|byte| **byte == b'0').count();
        let decimals = i32::try_from(after).ok()?.checked_sub(exponent)?;
        Some(Self { size: value(number)?.abs(), digits: u32::try_from(digits).ok()?, decimals })
    }
}

/// The value of a number that is neither zero nor infinite.
fn value(number: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(number).ok()?.replace(['d', 'D'], "e");
    text.parse().ok().filter(|value: &f64| value.is_normal())
}

/// What fields of one width leave of numbers that fill them, with as many digits as there is room for: `-.002467` and `.0605571` of eight
/// characters.
///
/// Numbers of as many digits, or decimals, are longer with a sign and shorter where they end with zeros, one in ten of them. So fields are
/// believed where three in five of the different numbers have the largest length, six at least, whose digits and decimals both differ, in
/// a quarter of them at least, and half of which do not end with zeros: of a regular mesh many numbers are round, and fill their fields with
/// zeros. The digits and decimals of which one holds for each are those that leave the least of all numbers open.
fn fields(text: &[u8]) -> Option<Written> {
    let words: BTreeSet<&[u8]> = numbers(text).filter(|number| value(number).is_some()).collect();
    let width = words.iter().map(|number| number.len()).max()?;
    let full: Vec<&[u8]> = words.iter().copied().filter(|number| number.len() == width).collect();
    let filling: Vec<Filling> = full.iter().filter_map(|number| Filling::of(number)).collect();
    let differ = |of: &dyn Fn(&Filling) -> i32| {
        let mut counts: BTreeMap<i32, usize> = BTreeMap::new();
        filling.iter().for_each(|number| *counts.entry(of(number)).or_default() += 1);
        counts.values().all(|count| 4 * count <= 3 * filling.len())
    };
    let last: BTreeSet<u64> = full.iter().filter_map(|number| Some(Decimal::of(value(number)?).last_digit())).collect();
    let n_zeros = filling.iter().filter(|number| Decimal::of(number.size).n_digits < number.digits).count();
    let is_filled = filling.len() >= MIN_DISTINCT_WITHOUT_ZEROS
        && 5 * filling.len() >= 3 * words.len()
        && 2 * n_zeros <= filling.len()
        && last.len() >= MIN_LAST_DECIMALS
        && differ(&|number| number.digits as i32)
        && differ(&|number| number.decimals);
    if !is_filled {
        return None;
    }
    let choices: BTreeSet<i32> = filling.iter().map(|number| number.decimals).collect();
    let open = |decimals: Option<i32>| {
        let is_coarser = |number: &&Filling| decimals.is_none_or(|decimals| number.decimals < decimals);
        let digits = filling.iter().filter(is_coarser).map(|number| number.digits).min().unwrap_or(u32::MAX);
        let (share, least) =
            (10f64.powf(-f64::from(digits)), decimals.map_or(0.0, |decimals| 0.1 * 10f64.powi(-decimals)));
        (filling.iter().map(|number| (share * number.size).max(least)).sum::<f64>(), digits, decimals)
    };
    let choices = std::iter::once(None).chain(choices.into_iter().map(Some)).map(open);
    let (_, digits, decimals) = choices.min_by(|a, b| a.0.total_cmp(&b.0))?;
    match decimals {
        Some(decimals) if digits > MAX_DECIMAL_DIGITS => Some(Written::Decimals(decimals)),
        _ => (digits <= MAX_DECIMAL_DIGITS).then_some(Written::Fields { digits, decimals }),
    }
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
        // One number that uses all of five digits, and is no sum of shorter ones as 100.25 is.
        assert_eq!(digits(b"1 1 1.0600e-06\n2 2 1.2720e-01\n3 3 2.1200e-06\n4 4 9.5399e-06\n"), Some(5));
        assert_eq!(digits(b"1 1 1.0000e+02\n2 2 2.5000e-01\n3 3 1.0025e+02\n4 4 5.0000e-01\n"), None);
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

    /// What streams of C++ write of a regular grillage, and what nobody rounded.
    #[test]
    fn the_general_format_shows_by_exponents_that_nobody_needs() {
        let of = |numbers: &[&str]| -> Vec<u8> {
            numbers.iter().enumerate().flat_map(|(k, text)| format!("{} 1 {text}\n", k + 1).into_bytes()).collect()
        };
        let streamed = ["-5.16923e+06", "-4.30769e+06", "-1.8144e+06", "1.26e+07", "-145152", "229152", "3.03692e+07"];
        assert_eq!(written(&of(&streamed)), Some(Written::Digits(6)));
        // Seven digits before the point, zeros that the format cuts, exponents without a sign, and numbers that are as short so.
        for other in ["1234567", "2.50", "3.5e7"] {
            assert_eq!(written(&of(&[&streamed[..], &[other]].concat())), None, "{other}");
        }
        assert_eq!(written(&of(&["5.16923e+16", "4.30769e+16", "3.03692e+17", "1.26e+17", "2.29152e+16"])), None);
        // Springs that are exact, by a format of more digits than they need; and three digits that it cut the others to.
        assert_eq!(written(&of(&["1.25e+06", "3.75e+06", "2.25e+06", "-5e+06", "40000"])), None);
        assert_eq!(written(&of(&["1.26e+03", "3.71e+06", "2.25e+04", "-5e+06", "400"])), Some(Written::Digits(3)));
        // Two different numbers of all digits, and sums of short ones.
        assert_eq!(written(&of(&["5.16923e+06", "1.26e+07", "4.30769e+06", "84000"])), None);
        assert_eq!(
            written(&of(&["1.00025e+06", "2.00025e+06", "3.00025e+06", "1e+06", "2e+06", "3e+06", "250"])),
            None
        );
    }

    /// Six digits on the diagonal and four off it; as many, as short as they can be.
    #[test]
    fn the_shortest_of_several_formats_counts() {
        let value = |k: usize| (1.7 * (k as f64 + 1.0)).sin() * 10f64.powi(k as i32 % 5);
        let of = |text: &dyn Fn(usize, f64) -> String| -> Vec<u8> {
            (0..60).flat_map(|k| format!("{} {} {}\n", k + 1, k / 2 + 1, text(k, value(k))).into_bytes()).collect()
        };
        let scientific = of(&|k, value| if k % 3 == 0 { format!("{value:.5e}") } else { format!("{value:.3e}") });
        assert_eq!(written(&scientific), Some(Written::Digits(4)));
        let fixed = of(&|k, value| if k % 3 == 0 { format!("{value:.6}") } else { format!("{value:.3}") });
        assert_eq!(written(&fixed), Some(Written::Decimals(3)));
        let shortest = of(&|k, value| {
            let rounded: f64 = format!("{value:.*e}", if k % 3 == 0 { 5 } else { 3 }).parse().expect("a number");
            format!("{rounded:e}")
        });
        assert_eq!(written(&shortest), None);
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

    /// Of a frame of beams: most entries of a mass are small, and the longest numbers have the fewest digits.
    #[test]
    fn fields_of_one_width_show_where_digits_and_decimals_vary() {
        let eight: &[u8] = b"1 1 0.157\n2 2 .1749429\n4 4 .0000171\n5 3 -.002467\n5 5 .0000449\n6 2 .0024671\n11 5 -.000034\n12 2 -.001458\n\
            14 8 .0605571\n15 15 .3498857\n17 15 -1.3e-18\n7 7 0.314\n";
        assert_eq!(written(eight), Some(Written::Decimals(6)));
        let large: &[u8] = b"1 1 1.2346e+9\n2 2 123456.787\n3 3 -1.234e+10\n4 4 -98765.432\n5 5 7.6543e+8\n6 6 1234567.81\n7 7 -2345678.9\n8 8 12345.6783\n";
        assert_eq!(written(large), Some(Written::Fields { digits: 4, decimals: None }));
        // Of a frame of equal beams: round numbers fill their fields with zeros.
        let regular: &[u8] = b"1 1 22400.0000000\n2 2 6770391.98727\n3 3 630000.000000\n4 4 -140000000.00\n5 5 81884.3210008\n\
            6 6 925.422802421\n7 7 -935820.81143\n8 8 9559.11250286\n9 9 -.00000000173\n10 10 8400.00000000\n11 11 -63000.000000\n\
            12 12 9584.36481047\n13 13 3385195.99364\n";
        assert_eq!(written(regular), Some(Written::Fields { digits: 11, decimals: Some(11) }));
        for other in [
            // Seven digits, which a sign and a decade make longer; fixed point; doubles.
            &b"1 1 1.234567\n2 2 -12.34567\n3 3 .1234568\n4 4 -765.4321\n5 5 12345.67\n6 6 -.7654321\n7 7 1.357913\n8 8 -2.468024\n"[..],
            b"1 1 0.001234\n2 2 0.123457\n3 3 0.012346\n4 4 0.765432\n5 5 0.000351\n6 6 0.234567\n",
            b"1 1 0.12345678901234567\n2 2 -0.1234567890123456\n3 3 12.345678901234567\n4 4 1.2345678901234567\n5 5 123.45678901234567\n6 6 -7.654321098765433\n",
        ] {
            assert!(!matches!(written(other), Some(Written::Fields { .. })), "{:?}", written(other));
        }
    }
}
