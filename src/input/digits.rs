//! How many decimal digits the values of a matrix carry, or how many decimals.
//!
//! A value that went through a text of d digits is a double whose shortest decimal form has at most d digits, whatever
//! the text it was read from looks like now: `84695.512820513002` is the double nearest to the fourteen digits
//! `84695.512820513`. A computed double needs sixteen or seventeen. So the shortest forms of a sample are counted.
//!
//! The rule, and its limits:
//!
//! - Values that are all numbers of a type of two bytes are of 3 digits, see [`super::half_precision`].
//! - Values that are all single precision numbers, or texts of such, are single precision: 7, see [`super::single_precision`].
//! - d is the number of digits that 99 of 100 sampled values do not exceed. With d above 15 the data are binary: 17.
//! - d from 7 to 15 is taken as the precision of the source where three different values have more than six digits, unless they are exact
//!   by design: sums of short numbers, or multiples of a half, a quarter or an eighth, see [`super::exact`]. One or two such values among
//!   short ones are what a soft spring makes of them.
//! - d up to 6 is otherwise a source of that few digits only if the values look rounded *relative to their size*: many different
//!   ones, over more than a decade, where those of the lower decades need d digits as often as those of the highest. Of five and six
//!   digits fewer are enough where three in four need them all: short numbers seldom do.
//! - Values in fixed point, such as `%.4f`, have one last decimal and digits by their size. D is the number of decimals that 99 of 100
//!   different values do not exceed. Nine in ten of rounded values have D decimals, whatever their size, and nine in ten of those
//!   with few digits have d digits, whatever theirs: more values with D decimals than with d digits, two thirds of all at least,
//!   are fixed point. With d above 6 the short numbers without D decimals do not count.
//! - Up to 6 digits, or above 15, fixed point is believed only of 20 different values with a decimal after the point, whose last
//!   decimals are six different digits at least. Halves and quarters end with a 5, multiples of 0.2 with even digits. So whole numbers
//!   up to 999999, springs of 2 and −1 and lumped masses of 0.25 are exact: 17. A computed double has 16 or 17 digits; above 15, a tenth
//!   of the values must have fewer. Whole numbers of 16 digits are believed, too, next to 20 different ones of 7 to 15 digits.
//! - A text in a fixed format or in fields of a fixed width shows its digits or decimals, see [`super::written`].
//!
//! Not seen: entries that were rounded to zero and left out; whole numbers below 10⁶ that were rounded (`%.0f`); fewer values than these.

use std::collections::BTreeSet;

use rayon::prelude::*;
use serde::Serialize;

use super::decimal::{Decimal, Sampled};
use super::exact::{MAX_EXACT_DIGITS, is_exact};
use super::half_precision::{HALF_DIGITS, is_half_precision};
use super::single_precision::{SINGLE_DIGITS, Single, single_precision};
use super::written::{MAX_DECIMAL_DIGITS, MIN_DISTINCT, SAMPLE, Written};
use crate::number::{counted, decimals};
use crate::sparse::TripletBlocks;

/// Digits that any double needs at most.
const DOUBLE_DIGITS: u32 = 17;
/// Different values, in the lower decades, that data of few digits must have to be taken for rounded.
const MIN_DISTINCT_SHORT: usize = 20;
/// Fewer are enough of five digits and more, where three in four use them all.
const MIN_DISTINCT_FULL: usize = 8;
const LONGEST_SHORT: std::ops::RangeInclusive<u32> = 5..=6;
/// Fewer are enough for modes. Eighths from −1 to 1, an exact grid, have seven different values below the highest decade. Tenths up to one
/// have nine, and look the same as values that were rounded to one decimal.
const MIN_DISTINCT_OF_MODES: usize = 8;
/// Different last decimals of rounded values: 18 numbers without a pattern have fewer with a chance of one in ten thousand.
const MIN_LAST_DECIMALS: usize = 6;

/// How many digits the source of some values had.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Digits {
    /// Significant decimal digits: 17 for binary data and for exact short numbers; of the largest values where `decimals` are known.
    #[serde(rename = "digits")]
    pub significant: u32,
    /// Decimals after the point that all values were rounded to, negative before it; none where digits are relative to each value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decimals: Option<i32>,
    /// What tells so.
    #[serde(rename = "digits_by", skip_serializing_if = "DigitsBy::is_values")]
    pub by: DigitsBy,
}

/// What tells how many digits values have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DigitsBy {
    /// The values, and the text they were written in.
    Values,
    /// All values are single precision numbers: seven digits whatever the format, and its decimals where it is fixed point.
    SinglePrecision,
    /// Numbers fill fields of a fixed width: each is known to the digits, or to the decimals where these are coarser.
    FieldWidth,
    /// The job states them.
    Job,
    /// Rigid-body motion: a stiffness that was condensed carries the rounding of the larger one.
    RigidMotion,
}

impl DigitsBy {
    fn is_values(&self) -> bool {
        *self == Self::Values
    }
}

impl Digits {
    /// Of numbers in double precision, and of exact ones.
    pub const DOUBLE: Self = Self::relative(DOUBLE_DIGITS);
    const SINGLE: Self = Self { by: DigitsBy::SinglePrecision, ..Self::relative(SINGLE_DIGITS) };

    /// Of so many digits, each value relative to itself.
    pub(super) const fn relative(significant: u32) -> Self {
        Self { significant, decimals: None, by: DigitsBy::Values }
    }

    /// As a job states them, each value relative to itself.
    pub(super) const fn stated(significant: u32) -> Self {
        Self { by: DigitsBy::Job, ..Self::relative(significant) }
    }

    /// As rigid-body motion shows a condensed stiffness to have, each value relative to itself.
    pub(super) const fn condensed(significant: u32) -> Self {
        Self { by: DigitsBy::RigidMotion, ..Self::relative(significant) }
    }

    /// Of values that are stored in a type of so many digits.
    pub(super) fn at_most(self, stored: u32) -> Self {
        Self { significant: self.significant.min(stored), ..self }
    }

    /// Digits that each value has relative to itself: decimals that it was rounded to leave it all of them.
    pub fn of_each_value(self) -> u32 {
        match (self.decimals, self.by) {
            (Some(_), DigitsBy::Values) => DOUBLE_DIGITS,
            _ => self.significant,
        }
    }

    /// Half a unit of the last digit, relative to each value, and half a unit of the last decimal.
    pub fn half_a_unit(self) -> [f64; 2] {
        let relative = match self.of_each_value() {
            digits if digits < 16 => 0.5 * 10f64.powi(1 - digits as i32),
            _ => f64::EPSILON,
        };
        [relative, self.decimals.map_or(0.0, |decimals| 0.5 * 10f64.powi(-decimals))]
    }

    /// Sixteen digits are all that a number in double precision has.
    pub fn are_all(self) -> bool {
        self.significant >= 16 && self.decimals.is_none()
    }

    /// `7 digits`, `4 decimals`, `7 digits and 4 decimals` where either may hold, `17 digits as the job states`.
    pub fn in_words(self) -> String {
        let digits = counted(self.significant, "digit", "digits");
        match (self.decimals.map(decimals), self.by) {
            (_, DigitsBy::Job) => format!("{digits} as the job states"),
            (_, DigitsBy::RigidMotion) => format!("{digits} as rigid-body motion shows"),
            (Some(decimals), DigitsBy::SinglePrecision | DigitsBy::FieldWidth) => format!("{digits} and {decimals}"),
            (Some(decimals), DigitsBy::Values) => decimals,
            (None, _) => digits,
        }
    }

    /// With what the format of a text shows.
    pub(super) fn with(self, written: Option<Written>) -> Self {
        match written {
            Some(Written::Digits(digits)) => Self { significant: self.significant.min(digits), ..self },
            Some(Written::Decimals(decimals)) if self.by == DigitsBy::Values => {
                Self { decimals: Some(self.decimals.unwrap_or(decimals).min(decimals)), ..self }
            }
            Some(Written::Fields { digits, decimals }) => {
                Self { significant: self.significant.min(digits), decimals, by: DigitsBy::FieldWidth }
            }
            _ => self,
        }
    }
}

/// Significant decimal digits, or decimals, of the source of these values.
///
/// Looks at about 2000 values spread over the slice; zeros do not count.
pub fn digits_of(values: &[f64]) -> Digits {
    digits_of_sample(spread(values.len()).map(|at| values[at]), MIN_DISTINCT_SHORT)
}

/// [`digits_of`] the values of modes that one program computed: one by itself may have too few different values to tell. Springs and lumped
/// masses are short by design, and eigenvectors hardly ever are, so that fewer values tell.
pub(super) fn digits_of_modes(columns: &[Vec<f64>]) -> Digits {
    let n = columns.first().map_or(0, Vec::len);
    digits_of_sample(spread(n * columns.len()).map(|at| columns[at / n][at % n]), MIN_DISTINCT_OF_MODES)
}

/// [`digits_of`] the values of entries in blocks.
pub(super) fn digits_of_blocks(entries: &TripletBlocks) -> Digits {
    let mut blocks = entries.blocks.iter();
    let (mut block, mut start): (&[f64], usize) = (&[], 0);
    // Positions rise, so that each block is gone into once.
    let values = spread(entries.len()).map(|at| {
        while at - start >= block.len() {
            start += block.len();
            block = blocks.next().map_or(&[], |next| &next.values);
        }
        block[at - start]
    });
    digits_of_sample(values, MIN_DISTINCT_SHORT)
}

fn digits_of_sample(values: impl Iterator<Item = f64>, least: usize) -> Digits {
    let counted = values.filter(|value| value.is_finite() && *value != 0.0);
    let sample: Vec<Sampled> = counted.map(Sampled::of).collect();
    if sample.is_empty() {
        return Digits::DOUBLE;
    }
    if is_half_precision(&sample) {
        return Digits::relative(HALF_DIGITS);
    }
    let mut counts: Vec<u32> = sample.iter().map(|sampled| sampled.decimal.n_digits).collect();
    counts.sort_unstable();
    let digits = counts[(counts.len() * 99).div_ceil(100) - 1];
    if let Some(Single { decimals }) = single_precision(&sample, digits) {
        return Digits { decimals, ..Digits::SINGLE };
    }
    let distinct: BTreeSet<Decimal> = sample.iter().map(|sampled| sampled.decimal).collect();
    let is_of_few = match digits {
        _ if digits <= MAX_EXACT_DIGITS => is_rounded(&distinct, digits, least),
        _ if digits <= MAX_DECIMAL_DIGITS => n_long(&distinct) >= MIN_DISTINCT && !is_exact(&distinct, digits),
        _ => false,
    };
    let relative = if is_of_few { Digits::relative(digits) } else { Digits::DOUBLE };
    match fixed_point(&distinct, digits, relative) {
        Some(decimals) => Digits { decimals: Some(decimals), ..Digits::relative(digits.min(MAX_DECIMAL_DIGITS)) },
        None => relative,
    }
}

/// How many of the values are of one size, at most. Equal numbers round equally.
pub(super) fn most_alike(entries: &TripletBlocks) -> usize {
    let mut sizes: Vec<u64> = Vec::with_capacity(entries.len());
    let values = entries.blocks.iter().flat_map(|block| &block.values);
    sizes.extend(values.filter(|value| **value != 0.0).map(|value| value.abs().to_bits()));
    sizes.par_sort_unstable();
    sizes.chunk_by(|a, b| a == b).map(<[_]>::len).max().unwrap_or(0)
}

/// Equally spaced positions of so many values, from the first to near the last.
fn spread(n_values: usize) -> impl Iterator<Item = usize> {
    let n_sampled = n_values.min(SAMPLE);
    (0..n_sampled).map(move |k| (k as u128 * n_values as u128 / n_sampled as u128) as usize)
}

/// Different values that short numbers are not.
fn n_long(distinct: &BTreeSet<Decimal>) -> usize {
    let long = distinct.iter().filter(|decimal| decimal.n_digits > MAX_EXACT_DIGITS);
    long.map(|decimal| decimal.mantissa).collect::<BTreeSet<_>>().len()
}

/// Whether numbers of at most `digits` digits look rounded relative to their size: below the highest decade, too, most
/// use all the digits. Of rounded numbers nine in ten do; numbers on a fixed grid have fewer the smaller they are. `least` is how many
/// different numbers it takes, or fewer where their digits are as many as short numbers have at most.
fn is_rounded(distinct: &BTreeSet<Decimal>, digits: u32, least: usize) -> bool {
    let top = distinct.last().map_or(0, |decimal| decimal.exponent);
    let lower: BTreeSet<(u64, u32)> = distinct
        .iter()
        .filter(|decimal| decimal.exponent < top)
        .map(|decimal| (decimal.mantissa, decimal.n_digits))
        .collect();
    let n_full = lower.iter().filter(|(_, n_digits)| *n_digits == digits).count();
    let are_full = LONGEST_SHORT.contains(&digits) && lower.len() >= MIN_DISTINCT_FULL && 4 * n_full >= 3 * lower.len();
    are_full || lower.len() >= least && 2 * n_full > lower.len()
}

/// Decimals of values in fixed point that need `digits`; `relative` is what they are known to where they are not in fixed point.
fn fixed_point(distinct: &BTreeSet<Decimal>, digits: u32, relative: Digits) -> Option<i32> {
    let is_of_few = relative != Digits::DOUBLE;
    let mut decimals: Vec<i32> = distinct.iter().map(|decimal| decimal.n_decimals()).collect();
    decimals.sort_unstable();
    let decimals = decimals[(decimals.len() * 99).div_ceil(100) - 1];
    // Larger numbers have as many digits as a double has, and no more decimals than these leave.
    let short = || distinct.iter().filter(|decimal| decimal.n_digits <= MAX_DECIMAL_DIGITS);
    let is_full = |decimal: &&Decimal| decimal.n_decimals() == decimals;
    let full = || short().filter(is_full);
    // A regular mesh gives round numbers, 140000000 beside 157297777.78. Such numbers do not show decimals, unless all digits are few.
    let tells =
        |decimal: &&Decimal| digits <= MAX_EXACT_DIGITS || decimal.n_digits > MAX_EXACT_DIGITS || is_full(decimal);
    let n_full_digits = short().filter(|decimal| decimal.n_digits == digits).count();
    let is_seldom_full = 3 * full().count() < 2 * short().filter(tells).count();
    if is_seldom_full || (is_of_few && full().count() <= n_full_digits) {
        return None;
    }
    if is_of_few && digits > MAX_EXACT_DIGITS {
        return Some(decimals);
    }
    let last: BTreeSet<u64> = full().map(|decimal| decimal.last_digit()).collect();
    let n_short = short().count();
    let is_believed = distinct.len() >= MIN_DISTINCT_SHORT && last.len() >= MIN_LAST_DECIMALS;
    let is_short = digits <= MAX_DECIMAL_DIGITS || (10 * n_short >= distinct.len() && n_short >= MIN_DISTINCT_SHORT);
    // Computed numbers of these sizes have decimals.
    let is_rounded_whole =
        digits > MAX_DECIMAL_DIGITS && short().filter(|d| d.n_digits > MAX_EXACT_DIGITS).count() >= MIN_DISTINCT_SHORT;
    ((decimals > 0 || is_rounded_whole) && is_believed && is_short).then_some(decimals)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of all sizes without a pattern.
    fn scattered(n: usize) -> Vec<f64> {
        let value = |k: usize| ((k as f64 + 1.0) * 0.618_033_988_749_894_9).fract() * 10_f64.powi((k % 9) as i32 - 3);
        (0..n).map(value).collect()
    }

    /// Single precision numbers.
    fn singles() -> Vec<f64> {
        scattered(500).iter().map(|value| f64::from(*value as f32)).collect()
    }

    fn printed(values: &[f64], n_digits: usize) -> Vec<f64> {
        let rounded = |value: &f64| format!("{value:.*e}", n_digits - 1).parse().expect("a number");
        values.iter().map(rounded).collect()
    }

    /// Stiffnesses of a frame of equal beams: half of them are round, and the others repeating decimals.
    #[test]
    fn fixed_point_shows_beside_round_numbers() {
        let of_beams = [
            1.4e8,
            1.26e6,
            8.4e3,
            2.8e8,
            3.045e6,
            2.03e4,
            1.008e7,
            5.04e5,
            1.68e4,
            1.218e6,
            1.12e4,
            2.24e5,
            1416.0e6 / 9.0,
            5.6e8 / 3.0,
            8.12e4 / 3.0,
            8.96e6 / 3.0,
            1.624e6 / 3.0,
            64.96e6 / 9.0,
            75e3 / 19.0,
            1e5 / 19.0,
            15e4 / 19.0,
            1.376_8e6 / 19.0,
            1.949_9e6 / 19.0,
            2.118_4e6 / 19.0,
            642_215e3 / 3.0,
        ];
        for n_decimals in [0, 2, 3] {
            let fixed: Vec<f64> =
                of_beams.iter().map(|x| format!("{x:.n_decimals$}").parse().expect("a number")).collect();
            assert_eq!(digits_of(&fixed).decimals, Some(n_decimals as i32), "{n_decimals}");
        }
        let relative = digits_of(&printed(&of_beams, 9));
        assert_eq!((relative.decimals, relative.significant), (None, 9));
    }

    #[test]
    fn computed_values_carry_all_digits() {
        assert_eq!(digits_of(&scattered(5000)), Digits::DOUBLE);
        // A beam: a few short numbers among those of all digits are no grid that the others lie on.
        let beam = [
            3.2e6,
            6.4e6,
            3.2e3,
            6.4e3,
            54_716.443_431_176_966,
            5_349.444_286_121_401,
            350_185.237_959_532_6,
            700_370.475_919_065_2,
            23_498.888_572_242_806,
            11_749.444_286_121_403,
        ];
        assert_eq!(digits_of(&beam), Digits::DOUBLE);
        // Sums of short numbers, as arithmetic leaves them: springs of hundredths, one of them stiff.
        let springs: Vec<f64> = (0..30).map(|i| if i == 1 { 700.0 } else { 0.3 + 0.01 * f64::from(i) }).collect();
        let chain: Vec<f64> = springs.iter().copied().chain(springs.windows(2).map(|two| two[0] + two[1])).collect();
        assert_eq!(digits_of(&chain), Digits::DOUBLE);
    }

    #[test]
    fn printed_values_carry_the_digits_of_the_print() {
        for n_digits in 3..=15 {
            assert_eq!(digits_of(&printed(&scattered(5000), n_digits)), Digits::relative(n_digits as u32));
        }
    }

    #[test]
    fn a_few_full_values_among_printed_ones_do_not_count() {
        let mut values = printed(&scattered(2000), 10);
        values[77] = std::f64::consts::PI;
        assert_eq!(digits_of(&values), Digits::relative(10));
    }

    #[test]
    fn exact_short_values_are_exact() {
        let integers: Vec<f64> = (0..2000).map(|k| f64::from(k * k % 99_991)).collect();
        let quarters: Vec<f64> = (0..2000).map(|k| f64::from(k * k % 9973) / 4.0).collect();
        let fifths: Vec<f64> = (0..2000).map(|k| f64::from(k) / 5.0).collect();
        let few: Vec<f64> = (1..20).map(|k| f64::from(k * k) / 100.0).collect();
        let exact = [vec![2.0, -1.0, 2.0], vec![0.25; 50], vec![0.0; 5], vec![], integers, quarters, fifths, few];
        for values in exact {
            assert_eq!(digits_of(&values), Digits::DOUBLE, "{:?}", &values[..values.len().min(3)]);
        }
    }

    /// Springs of 1000, 2.5, 0.25 and 10⁴ and their sums; springs of quarters up to 10⁵; of 1, 3 and 10¹⁰.
    #[test]
    fn exact_values_of_seven_digits_and_more_are_exact() {
        let sums = vec![-10000.0, -1000.0, -2.5, -0.25, 2.75, 1002.5, 10000.25, 11000.0];
        let quarters: Vec<f64> = (0..200).map(|k| f64::from(k * 7919 % 400_000) / 4.0 + 1e5).collect();
        let far = vec![1.0, 3.0, 4.0, 1e10, 10_000_000_001.0, 10_000_000_003.0];
        for values in [sums, quarters, far] {
            assert_eq!(digits_of(&values), Digits::DOUBLE, "{:?}", &values[..4]);
        }
        // Thirds and what a short number makes of them, and tenths of which a few are halves.
        assert_ne!(digits_of(&[0.3333333, 0.5, 0.8333333, 1.0, 0.6666667, 1.3333333]), Digits::DOUBLE);
        let tenths: Vec<f64> = (0..20).map(|k| f64::from(12_345 + k * 70_001) / 10.0).collect();
        assert_eq!(digits_of(&tenths).decimals, Some(1));
    }

    /// Modes of a small symmetric part have few different values; a grid of eighths, or springs, are still exact.
    #[test]
    fn fewer_values_of_modes_tell() {
        let lower =
            [1.91e-12, 2.47e-12, 7e-12, 3.96e-11, 4.27e-11, 9.85e-10, 1.01e-9, 5.88e-4, 1.56e-3, 0.0954, 0.116, 0.212];
        let mode = [&lower[..], &[1.0, -3.77, 2.08]].concat();
        assert_eq!(digits_of(&mode), Digits::DOUBLE);
        assert_eq!(digits_of_modes(&[mode[..7].to_vec(), mode[7..14].to_vec()]), Digits::relative(3));
        let eighths: Vec<f64> = (-8..=8).map(|k| f64::from(k) / 8.0).collect();
        assert_eq!(digits_of_modes(&[eighths]), Digits::DOUBLE);
    }

    #[test]
    fn one_long_constant_is_no_rounding() {
        assert_eq!(digits_of(&[1_234_567.5, -1_234_567.5, 2_469_135.0]), Digits::DOUBLE);
        // Springs of thousands, and one of 0.005 to the ground.
        let springs = [1000.0, 2000.0, 1500.0, 3000.0, 1200.0, 3500.0, 2500.0, 4000.0, 4500.005, -1500.0, -3000.0];
        assert_eq!(digits_of(&springs), Digits::DOUBLE);
    }

    /// Sizes from the last decimal up to more digits than a double has.
    #[test]
    fn values_in_fixed_point_carry_its_decimals() {
        for n_decimals in [1_usize, 2, 4, 7, 9] {
            for size in [1.0, 1e3, 1e7] {
                let fixed = |value: &f64| format!("{:.n_decimals$}", value * size).parse().expect("a number");
                let values: Vec<f64> = scattered(2000).iter().map(fixed).collect();
                let found = digits_of(&values);
                assert_eq!(found.decimals, Some(n_decimals as i32), "%.{n_decimals}f of {size:e}: {found:?}");
            }
        }
        // Whole numbers of many digits, and multiples of a thousand.
        for (unit, decimals) in [(1.0, 0), (1e3, -3)] {
            let values: Vec<f64> = scattered(2000).iter().map(|value| (value * 1e4).round() * unit).collect();
            assert_eq!(digits_of(&values).decimals, Some(decimals));
        }
    }

    /// As numpy's `str` and C++ write them, in which ties may go either way, in fixed point, and few numbers in nine to thirteen digits.
    #[test]
    fn single_precision_shows_in_whatever_text() {
        for size in [1.0, 1e-9, 1e10] {
            let single = |value: &f64| (value * size) as f32;
            let values: Vec<f64> = scattered(500).iter().map(|value| f64::from(single(value))).collect();
            for (n_decimals, largest) in [(1, 1e8), (3, 1e6), (6, 1e4)] {
                let fixed = |value: &f64| {
                    let single = (value / 1e5 * largest / size) as f32;
                    format!("{single:.n_decimals$}").parse::<f64>().expect("a number")
                };
                let found = digits_of(&values.iter().map(fixed).collect::<Vec<_>>());
                let expected = Digits { decimals: Some(n_decimals as i32), ..Digits::SINGLE };
                assert_eq!(found, expected, "%.{n_decimals}f up to {largest:e}");
            }
            for n_digits in [9, 10, 13] {
                let few = printed(&values[100..108], n_digits);
                assert_eq!(digits_of(&few), Digits::SINGLE, "{n_digits} digits, {size:e}: {few:?}");
            }
        }
        // 1595731.25 is a tie, and 2^-21 has a shortest form that is not its nearest of eight digits.
        let as_text = |value: &f64| (*value as f32).to_string().parse().expect("a number");
        let shortest: Vec<f64> = scattered(500).iter().map(as_text).collect();
        let ties = vec![1_595_731.2, 1_595_731.3, 4.7683716e-7, 342_810.62, 342_810.63];
        assert_eq!(digits_of(&[shortest, ties].concat()), Digits::SINGLE);
        // A subnormal number has fewer bits, and is single precision all the same.
        let tiny = -f64::from(f32::from_bits(0x001f_7d3b));
        assert_eq!(digits_of(&printed(&[&singles(), &[tiny][..]].concat(), 9)), Digits::SINGLE);
        // Doubles in nine digits, and in a format that single precision fills to the last digit.
        assert_eq!(digits_of(&printed(&scattered(500), 9)), Digits::relative(9));
        let tenths: Vec<f64> = (0..64).map(|k| f64::from(2 + 777_777 * k) / 10.0).collect();
        assert_eq!(digits_of(&tenths).decimals, Some(1));
    }

    /// What is left where sums cancel has few bits, and is single precision all the same.
    #[test]
    fn residues_of_cancellation_hide_no_single_precision() {
        let stiff = scattered(40).into_iter().map(|value| f64::from((value * 1e9) as f32));
        let residues = (1..200).map(|k| f64::from(k) * 2f64.powi(-46));
        assert_eq!(digits_of(&stiff.chain(residues).collect::<Vec<_>>()), Digits::SINGLE);
    }

    /// In SI units stiffnesses are whole numbers above 2²⁴ that need ten digits.
    #[test]
    fn single_precision_values_carry_seven_digits() {
        for size in [1.0, 1e-9, 1e10] {
            let single: Vec<f32> = scattered(500).iter().map(|&value| (value * size) as f32).collect();
            let wide = |value: &f32| f64::from(*value);
            let shortest = |value: &f32| value.to_string().parse::<f64>().expect("a number");
            assert_eq!(digits_of(&single.iter().map(wide).collect::<Vec<_>>()), Digits::SINGLE, "{size:e}");
            assert_eq!(digits_of(&single.iter().map(shortest).collect::<Vec<_>>()), Digits::SINGLE, "{size:e}");
            for n_digits in [9, 10, 12] {
                let wide: Vec<f64> = single.iter().map(wide).collect();
                assert_eq!(digits_of(&printed(&wide, n_digits)), Digits::SINGLE, "{n_digits} digits of {size:e}");
            }
        }
        // Of a regular mesh: four numbers.
        let few = [3.7e10_f32, 1.1e10, 2.7e9, 6.1e8].map(|value| f64::from(value / 3.0));
        assert_eq!(digits_of(&few), Digits::SINGLE);
        // Whole numbers that single precision holds are as whole as others.
        let whole: Vec<f64> = (0..2000).map(|k| f64::from(k * 7919 % 16_000_000)).collect();
        assert_eq!(digits_of(&whole).decimals, Some(0));
    }
}
