//! Axes: where a value lies and what is written next to it.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use crate::number;

/// More labels than this crowd an axis.
const LABELS: f64 = 7.0;

/// An axis in plotting units: the value itself, or its decadic logarithm.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// What is drawn, with its unit.
    pub(super) title: String,
    pub(super) low: f64,
    pub(super) high: f64,
    /// Positions in plotting units and their labels.
    pub(super) ticks: Vec<(f64, String)>,
    is_logarithmic: bool,
}

impl Axis {
    /// From `low` to `high` as they are.
    pub(super) fn linear(title: &str, low: f64, high: f64) -> Self {
        let high = if high > low { high } else { low + 1.0 };
        let step = nice_step((high - low) / LABELS);
        let decimals = usize::try_from(-number::decade(step)).unwrap_or(0);
        let first = (low / step).ceil() as i64;
        let last = (high / step * (1.0 + 1e-12)).floor() as i64;
        let ticks = (first..=last).map(|k| k as f64 * step).map(|at| (at, minus(&format!("{at:.decimals$}"))));
        Self { title: title.to_owned(), low, high, ticks: ticks.collect(), is_logarithmic: false }
    }

    /// Whole numbers from `low` to `high`, with half a step of room on either side.
    pub(super) fn whole(title: &str, low: usize, high: usize) -> Self {
        let step = nice_step(((high - low) as f64 / 12.0).max(1.0)).max(1.0) as usize;
        let mut ticks: Vec<usize> = (low..=high).filter(|number| number.is_multiple_of(step)).collect();
        if !ticks.contains(&low) && ticks.first().is_none_or(|first| first - low > step / 2) {
            ticks.insert(0, low);
        }
        let ticks = ticks.into_iter().map(|number| (number as f64, number.to_string())).collect();
        let (low, high) = (low as f64 - 0.7, high as f64 + 0.7);
        Self { title: title.to_owned(), low, high, ticks, is_logarithmic: false }
    }

    /// Logarithmic over whole decades around the positive ones of `values`; absent where there are none.
    pub(super) fn decades(title: &str, values: impl Iterator<Item = f64>) -> Option<Self> {
        let (low, high) = positive_range(values)?;
        let (low, high) = (low.log10().floor(), (high.log10() * (1.0 + 1e-12)).ceil());
        let high = high.max(low + 1.0);
        let stride = ((high - low) / LABELS).ceil().max(1.0) as i64;
        let ticks = (low as i64..=high as i64).filter(|k| (k - high as i64) % stride == 0);
        let ticks = ticks.map(|k| (k as f64, power_of_ten(k))).collect();
        Some(Self { title: title.to_owned(), low, high, ticks, is_logarithmic: true })
    }

    /// Logarithmic from the smallest to the largest positive one of `values`, labelled in plain numbers.
    pub(super) fn frequencies(title: &str, values: impl Iterator<Item = f64>) -> Option<Self> {
        let (low, high) = positive_range(values)?;
        let (low, high) = if high > low { (low, high) } else { (low / 2.0, high * 2.0) };
        let decades = (low.log10().floor() as i32)..=(high.log10().ceil() as i32);
        let multiples: &[f64] = match (high / low).log10() {
            span if span < 1.5 => &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0],
            span if span < 3.5 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let ticks = decades.flat_map(|k| multiples.iter().map(move |multiple| multiple * 10.0_f64.powi(k)));
        let ticks = ticks.filter(|value| (low..=high).contains(value));
        let label = |value: f64| {
            if number::decade(value) < 6 {
                minus(&number::quantity(value, 3))
            } else {
                power_of_ten(number::decade(value).into())
            }
        };
        let ticks = ticks.map(|value| (value.log10(), label(value))).collect();
        Some(Self { title: title.to_owned(), low: low.log10(), high: high.log10(), ticks, is_logarithmic: true })
    }

    /// Where `value` is drawn; what lies beyond the ends is drawn at them.
    pub(super) fn place(&self, value: f64) -> f64 {
        let place = match (self.is_logarithmic, value > 0.0) {
            (true, true) => value.log10(),
            (true, false) => self.low,
            (false, _) => value,
        };
        place.clamp(self.low, self.high)
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value - self.low) / (self.high - self.low);
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.iter().map(|(at, _)| *at).collect() }
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(at: &f64) -> String {
        at.to_string()
    }

    fn format_ext(&self, at: &f64) -> String {
        let near = |tick: &&(f64, String)| (tick.0 - at).abs() <= 1e-9 * (self.high - self.low);
        self.ticks.iter().find(near).map(|(_, label)| label.clone()).unwrap_or_default()
    }
}

/// 1, 2 or 5 times a power of ten, not below `step`.
fn nice_step(step: f64) -> f64 {
    let power = 10.0_f64.powi(number::decade(step));
    let multiple = [1.0, 2.0, 5.0, 10.0].into_iter().find(|multiple| multiple * power >= step * (1.0 - 1e-12));
    multiple.unwrap_or(10.0) * power
}

fn positive_range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|value| *value > 0.0 && value.is_finite()).fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((value.min(low), value.max(high))),
    })
}

/// `10⁻¹²`.
pub(in crate::report::html) fn power_of_ten(exponent: i64) -> String {
    const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let sign = if exponent < 0 { "⁻" } else { "" };
    let digits = exponent.unsigned_abs().to_string();
    let raised = digits.bytes().map(|digit| SUPERSCRIPTS[usize::from(digit - b'0') % 10]);
    format!("10{sign}{}", raised.collect::<String>())
}

/// With the sign that is as wide as a plus.
fn minus(number: &str) -> String {
    number.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn ticks_stand_at_round_numbers() {
        assert_eq!(labels(&Axis::linear("", 0.0, 1.0)), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&Axis::whole("", 1, 5)), ["1", "2", "3", "4", "5"]);
        assert_eq!(labels(&Axis::whole("", 1, 50)), ["1", "5", "10", "15", "20", "25", "30", "35", "40", "45", "50"]);
        let decades = Axis::decades("", [3e-13, 2e-10, 0.0].into_iter()).expect("positive values");
        assert_eq!(labels(&decades), ["10⁻¹³", "10⁻¹²", "10⁻¹¹", "10⁻¹⁰", "10⁻⁹"]);
        let hertz = Axis::frequencies("", [12.0, 900.0].into_iter()).expect("positive values");
        assert_eq!(labels(&hertz), ["20", "50", "100", "200", "500"]);
    }

    #[test]
    fn values_beyond_an_axis_are_drawn_at_its_end() {
        let axis = Axis::decades("", [1e-3, 1.0].into_iter()).expect("positive values");
        assert_eq!((axis.place(0.0), axis.place(1e9), axis.place(1e-2)), (-3.0, 0.0, -2.0));
        assert!(Axis::decades("", [0.0, f64::NAN].into_iter()).is_none());
    }
}
