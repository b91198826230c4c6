//! Whether numbers are single precision ones: as doubles, in decimals that are long enough to show it, or in fixed point.
//!
//! A number is a form of the single precision number nearest to it where it is that number, its shortest decimal form, its form of as many
//! digits as the text has, or its form in fixed point. A decimal with the step h to the next one of its length is such a form by chance
//! with a share of h/u, u being the distance of single precision numbers there: of nine digits one in ten to a hundred, of eight next to
//! all, of thirteen one in a million. The chances of all different numbers, multiplied, must be below one in a hundred. That is enough:
//! texts of eight and nine digits are rare but for those of single precision, and a text of nine digits that is taken for it by chance has
//! bars a hundred times too wide and none too small. Numbers of up to seven digits tell nothing, nor do quarters below 2²⁴ and numbers that
//! need few of the 24 bits, which are exact in whatever precision.

use std::collections::{BTreeMap, BTreeSet};

use super::decimal::{Decimal, Sampled};
use super::written::{MAX_DECIMAL_DIGITS, MIN_DISTINCT};

/// Digits that a single precision number carries.
pub(super) const SINGLE_DIGITS: u32 = 7;
/// The most digits that a form of a double has.
const MAX_DIGITS: u32 = 17;
/// Chance below which numbers are no forms of single precision numbers without having been such.
const CHANCE: f64 = 1e-2;
/// Share of the largest number up to which others are what was left where sums in double precision cancel: they have few bits.
const RESIDUE: f64 = 64.0 * f64::EPSILON;
/// Half a unit of the last digit, and room for rounding.
const HALF: f64 = 0.5 + 1e-6;

/// Single precision numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Single {
    /// Decimals that fixed point left of them.
    pub(super) decimals: Option<i32>,
}

/// Whether values, which need at most `digits` digits but for a few, are single precision numbers.
pub(super) fn single_precision(sample: &[Sampled], digits: u32) -> Option<Single> {
    if digits <= SINGLE_DIGITS && !sample.iter().any(|sampled| sampled.decimal.n_digits > SINGLE_DIGITS) {
        return None;
    }
    if sample.iter().all(|sampled| is_single(sampled.value)) {
        return believed_as_doubles(sample, digits).then_some(Single { decimals: None });
    }
    let is_unlikely = |n_least: usize, least_step: f64| {
        let chances = chances(sample, least_step);
        chances.len() >= n_least && chances.iter().product::<f64>() <= CHANCE
    };
    let in_fixed_point = in_fixed_point(sample).filter(|(_, step)| is_unlikely(MIN_DISTINCT, *step)).map(|(of, _)| of);
    let is_printed = || is_unlikely(1, 0.0) && sample.iter().all(|sampled| is_printed(*sampled, digits));
    in_fixed_point.or_else(|| is_printed().then_some(Single { decimals: None }))
}

/// What numbers are if they are single precision ones in fixed point, as all of them may be. Decimals count where they take more from the
/// smallest number than single precision does. With them goes the step of the last one.
fn in_fixed_point(sample: &[Sampled]) -> Option<(Single, f64)> {
    let short = sample.iter().map(|sampled| sampled.decimal).filter(|decimal| decimal.n_digits <= MAX_DECIMAL_DIGITS);
    let decimals = short.map(Decimal::n_decimals).max()?;
    let last = 10f64.powi(-decimals);
    let is_fixed = |value: f64| {
        let rounding = f64::EPSILON * value.abs();
        let on_grid = (value / last).round() * last;
        (value - on_grid).abs() <= 2.0 * rounding && (value - f64::from(value as f32)).abs() <= HALF * last + rounding
    };
    let least = sample.iter().fold(f64::INFINITY, |least, sampled| least.min(sampled.value.abs()));
    let found = Single { decimals: (gap(least as f32) < last).then_some(decimals) };
    sample.iter().all(|sampled| is_fixed(sampled.value)).then_some((found, last))
}

fn is_single(value: f64) -> bool {
    f64::from(value as f32) == value
}

/// Whether a number is a decimal form of a single precision number: the shortest, or one of `digits`.
fn is_printed(Sampled { value, decimal }: Sampled, digits: u32) -> bool {
    let single = value as f32;
    let n_decimals = digits.min(MAX_DIGITS) as usize - 1;
    let is_shortest = || {
        // Programs break ties between two forms of one length either way.
        let shortest = Decimal::of_text(&format!("{:e}", single.abs()));
        shortest.n_digits == decimal.n_digits && (value - f64::from(single)).abs() <= HALF * step(decimal)
    };
    let is_of_text = || format!("{:.n_decimals$e}", f64::from(single)).parse() == Ok(value);
    is_single(value) || (single.is_finite() && single != 0.0 && (is_shortest() || is_of_text()))
}

/// Whole numbers and quarters that are exact in single precision whatever they are.
fn is_short(value: f64) -> bool {
    (4.0 * value).fract() == 0.0 && value.abs() < 2f64.powi(24)
}

/// The fraction bits of the single precision number nearest to a value.
fn fraction(value: f64) -> u32 {
    (value as f32).to_bits() & ((1 << 23) - 1)
}

/// Numbers that are short by themselves end with many zeros among the 24 bits.
fn uses_all_bits(fraction: u32) -> bool {
    fraction.trailing_zeros() <= 4
}

/// Whether there are enough different numbers that single precision holds by no chance. One double in 2²⁹ is such a number, and one number
/// of 10¹⁰ with ten digits in a thousand.
fn believed_as_doubles(sample: &[Sampled], digits: u32) -> bool {
    let values = || sample.iter().map(|sampled| sampled.value);
    let largest = values().fold(0.0f64, |largest, value| largest.max(value.abs()));
    let whole = values().filter(|value| value.abs() > RESIDUE * largest);
    let fractions: BTreeSet<u32> = whole.map(fraction).collect();
    let n_long = fractions.iter().filter(|fraction| uses_all_bits(**fraction)).count();
    let least = if digits <= MAX_DECIMAL_DIGITS { MIN_DISTINCT } else { 1 };
    // What cancels in the sums of a regular mesh leaves numbers of few bits, too.
    digits > SINGLE_DIGITS && n_long >= least.max(fractions.len() / 4) && !values().all(is_short)
}

/// The distance of a number to the next one of as many digits.
fn step(decimal: Decimal) -> f64 {
    10f64.powi(-decimal.n_decimals())
}

/// The distance of a positive number to the next one.
fn gap(single: f32) -> f64 {
    f64::from(single.next_up()) - f64::from(single)
}

/// The chances of the different numbers that tell something to be forms of single precision numbers without having been such, where forms
/// are no closer to each other than a step.
fn chances(sample: &[Sampled], least_step: f64) -> Vec<f64> {
    let mut chances: BTreeMap<u32, f64> = BTreeMap::new();
    for (value, decimal) in sample.iter().map(|sampled| (sampled.value.abs(), sampled.decimal)) {
        let single = value as f32;
        let tells = decimal.n_digits > SINGLE_DIGITS && uses_all_bits(fraction(value)) && !is_short(value);
        if tells && single.is_normal() {
            let of_fraction = chances.entry(fraction(value)).or_insert(1.0);
            *of_fraction = of_fraction.min(step(decimal).max(least_step) / gap(single));
        }
    }
    chances.into_values().collect()
}
