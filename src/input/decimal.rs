//! Decimal forms of numbers.

/// The shortest decimal form of the size of a number that reads back as the same double.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Decimal {
    /// Power of ten of the first digit.
    pub(crate) exponent: i32,
    /// The digits, without zeros at their end, as a whole number.
    pub(super) mantissa: u64,
    pub(crate) n_digits: u32,
}

impl Decimal {
    pub(crate) fn of(value: f64) -> Self {
        Self::of_text(&format!("{:e}", value.abs()))
    }

    /// Of a number as `{:e}` writes it.
    pub(super) fn of_text(text: &str) -> Self {
        let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
        let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
        let digits = digits.trim_end_matches('0');
        Self {
            exponent: exponent.parse().unwrap_or(0),
            mantissa: digits.parse().unwrap_or(0),
            n_digits: digits.len() as u32,
        }
    }

    /// Decimals after the point, negative where the number ends with zeros before it.
    pub(crate) fn n_decimals(self) -> i32 {
        self.n_digits as i32 - 1 - self.exponent
    }

    pub(super) fn last_digit(self) -> u64 {
        self.mantissa % 10
    }

    /// The number, to a few units of rounding.
    pub(super) fn size(self) -> f64 {
        let decimals = self.n_decimals();
        let power = 10f64.powi(decimals.abs());
        if decimals > 0 { self.mantissa as f64 / power } else { self.mantissa as f64 * power }
    }
}

/// A number of a sample with its decimal form, which takes long to make.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampled {
    pub(super) value: f64,
    pub(super) decimal: Decimal,
}

impl Sampled {
    pub(super) fn of(value: f64) -> Self {
        Self { value, decimal: Decimal::of(value) }
    }
}
