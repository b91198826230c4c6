//! Natural frequencies of modes that another program computed: a number for each mode, in a file or in a list.
//!
//! Files have the formats of shapes, with the numbers in a column or in a row, or are text with one number on each line. In text a line
//! that begins with `#` or `%` is a comment.

use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};

use super::Allowance;
use super::banner::excerpt;
use super::decimal::Decimal;
use super::fortran::real;
use super::member::split_member;
use super::mode_formats::values_of_modes;
use super::mode_rounding::ModeRounding;
use super::source::read_error;
use super::table::{FirstLine, open_first_line};
use super::value_unit::ValueUnit;
use crate::error::{Error, Result};

const EXPECTED: &str = "a frequency on each line, or one line of them";
/// The longest line of a list.
const MAX_LINE_BYTES: u64 = 1 << 20;

/// Where the numbers of modes are.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueSource {
    /// In a file, or in a dataset of one as in `model.h5:/omega`.
    File(PathBuf),
    /// Here.
    List(Vec<f64>),
}

/// The numbers of modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeValues {
    /// What they are.
    pub unit: ValueUnit,
    /// One for each mode.
    pub numbers: Vec<f64>,
    /// What they may be off by.
    pub rounding: ModeRounding,
}

impl ModeValues {
    /// Numbers as they are typed or stored.
    pub(super) fn new(unit: ValueUnit, numbers: Vec<f64>) -> Self {
        let rounding = rounding_of(&numbers);
        Self { unit, numbers, rounding }
    }

    /// Reads the numbers of `n_modes` modes.
    ///
    /// # Errors
    /// [`Error::ValuesFormat`] for what is no number; [`Error::ValuesCount`] where there are more or fewer than modes; those of reading
    /// the file.
    pub fn read(unit: ValueUnit, source: &ValueSource, n_modes: usize, allowance: &Allowance) -> Result<Self> {
        let (numbers, path) = match source {
            ValueSource::List(numbers) => (numbers.clone(), None),
            ValueSource::File(path) => (of_file(path, n_modes, allowance)?, Some(path.clone())),
        };
        if numbers.len() != n_modes {
            return Err(Error::ValuesCount { path, found: numbers.len() as u64, n_modes });
        }
        Ok(Self::new(unit, numbers))
    }

    /// What the frequency of a mode may be off by, relative to it: that of an eigenvalue half as much as the number.
    pub fn rounding_of(&self, mode: usize) -> f64 {
        let ModeRounding { relative, absolute } = self.rounding;
        let number = self.numbers[mode].abs();
        let of_number = relative + if number > 0.0 { absolute / number } else { 0.0 };
        match self.unit {
            ValueUnit::Hertz | ValueUnit::RadPerSecond => of_number,
            ValueUnit::Eigenvalue => 0.5 * of_number,
        }
    }
}

/// Half a unit of the last digit of the number that has the most digits: those with fewer may end in zeros. Where more of the numbers
/// have the most decimals than have the most digits, and two thirds of all have them, they are in fixed point: half a unit of the last
/// decimal.
fn rounding_of(numbers: &[f64]) -> ModeRounding {
    /// Digits that are as good as binary.
    const ALL: u32 = 16;
    let written: Vec<Decimal> =
        numbers.iter().filter(|value| **value != 0.0).map(|value| Decimal::of(*value)).collect();
    let digits = written.iter().map(|decimal| decimal.n_digits).max().unwrap_or(ALL);
    if digits >= ALL {
        return ModeRounding { relative: f64::EPSILON, absolute: 0.0 };
    }
    let decimals = written.iter().map(|decimal| decimal.n_decimals()).max().unwrap_or(0);
    let n_full = written.iter().filter(|decimal| decimal.n_decimals() == decimals).count();
    let n_full_digits = written.iter().filter(|decimal| decimal.n_digits == digits).count();
    if decimals > 0 && n_full > n_full_digits && 3 * n_full >= 2 * written.len() {
        return ModeRounding { relative: f64::EPSILON, absolute: 0.5 * 10f64.powi(-decimals) };
    }
    ModeRounding { relative: 0.5 * 10f64.powi(1 - digits as i32), absolute: 0.0 }
}

fn of_file(path: &Path, n_modes: usize, allowance: &Allowance) -> Result<Vec<f64>> {
    let count = |found| Error::ValuesCount { path: Some(path.to_owned()), found, n_modes };
    let numbers = values_of_modes(path, n_modes, allowance).map_err(|error| match error {
        Error::ModesRows { found, .. } | Error::ModesColumns { found, .. } => count(found),
        Error::ModesFormat { path, line, found, .. } => Error::ValuesFormat { path, line, found, expected: EXPECTED },
        other => other,
    })?;
    numbers.map_or_else(|| of_text(&split_member(path).0, n_modes), Ok)
}

/// The numbers of a text: on lines of one each, or on one line.
fn of_text(path: &Path, n_modes: usize) -> Result<Vec<f64>> {
    let FirstLine { text, line, mut rest } = open_first_line(path, EXPECTED)?;
    let wrong = |line: u64, found: String| Error::ValuesFormat {
        path: path.to_owned(),
        line: Some(line),
        found: format!("`{found}`"),
        expected: EXPECTED,
    };
    let mut numbers = Vec::new();
    let mut is_column = true;
    let mut take = |text: &str, line: u64| -> Result<()> {
        let before = numbers.len();
        let is_separator = |c: char| c.is_ascii_whitespace() || c == ',' || c == ';';
        for field in text.split(is_separator).filter(|field| !field.is_empty()) {
            let value = real(field.as_bytes()).filter(|value| value.is_finite());
            numbers.push(value.ok_or_else(|| wrong(line, excerpt(field.as_bytes())))?);
        }
        let is_second = before > 0 && numbers.len() > before;
        is_column &= numbers.len() - before <= 1;
        if is_second && !is_column {
            return Err(wrong(line, excerpt(text.as_bytes())));
        }
        // A list goes on no longer than its modes: what is too much is counted, not kept.
        if numbers.len() > n_modes {
            return Err(Error::ValuesCount { path: Some(path.to_owned()), found: numbers.len() as u64, n_modes });
        }
        Ok(())
    };
    if !text.starts_with('#') {
        take(&text, line)?;
    }
    for at in line + 1.. {
        let mut bytes = Vec::new();
        let read = rest.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut bytes);
        match read.map_err(|error| read_error(path, error))? as u64 {
            0 => break,
            MAX_LINE_BYTES => {
                return Err(Error::LineTooLong { path: path.to_owned(), line: at, limit: MAX_LINE_BYTES as usize });
            }
            _ => {}
        }
        let text = String::from_utf8_lossy(bytes.trim_ascii()).into_owned();
        if !text.starts_with(['#', '%']) {
            take(&text, at)?;
        }
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_with_the_most_digits_tells_the_rounding() {
        let relative = |relative: f64| ModeRounding { relative, absolute: 0.0 };
        assert_eq!(rounding_of(&[316.37, 871.2]), relative(0.5e-4));
        assert_eq!(rounding_of(&[0.1 + 0.2]), relative(f64::EPSILON));
        assert_eq!(rounding_of(&[]), relative(f64::EPSILON));
        // The eigenvalue table of a program that writes five digits.
        assert_eq!(rounding_of(&[0.0, 250.11, 1265.4, 2.8093e4, 40.293]), relative(0.5e-4));
    }

    #[test]
    fn numbers_in_fixed_point_are_off_by_a_decimal() {
        let values = ModeValues::new(ValueUnit::Hertz, vec![2.3, 12.3, 87.1, 1316.4, 20.0]);
        assert_eq!(values.rounding, ModeRounding { relative: f64::EPSILON, absolute: 0.05 });
        assert_eq!(values.rounding_of(1), f64::EPSILON + 0.05 / 12.3);
        assert_eq!(
            ModeValues { unit: ValueUnit::Eigenvalue, ..values }.rounding_of(4),
            0.5 * (f64::EPSILON + 0.05 / 20.0)
        );
    }

    #[test]
    fn a_unit_gives_the_eigenvalue() {
        let omega = std::f64::consts::TAU * 3.0;
        assert_eq!(ValueUnit::Hertz.eigenvalue(3.0), omega * omega);
        assert_eq!(ValueUnit::RadPerSecond.eigenvalue(-2.0), -4.0);
        assert_eq!(ValueUnit::Eigenvalue.eigenvalue(5.0), 5.0);
    }
}
