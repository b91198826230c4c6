//! Ranges of the numbers of a job.
//!
//! Lengths, masses, frequencies and shares of damping are multiplied with each other, squared among them, before they meet stiffness and mass.
//! Four factors between 1e-48 and 1e48 stay between 1e-192 and 1e192, which leaves more than a hundred powers of ten on either
//! side for stiffness and mass. Coordinates in files have the same range, in powers of two (E-NODE-RANGE).

use crate::error::{Error, Result};

/// The smallest size of a number that is multiplied with others.
pub(super) const SMALLEST: f64 = 1e-48;
/// The largest one.
pub(super) const LARGEST: f64 = 1e48;

/// The most significant digits that a number in double precision needs.
pub(super) const MAX_DIGITS: usize = 17;

const POSITIVE: &str = "a positive number";
const SIZE: &str = "a positive number between 1e-48 and 1e48";
const DIGITS: &str = "a whole number from 1 to 17";
const FINITE: &str = "a finite number";
const COORDINATE: &str = "coordinates of at most 1e48 in size";

/// A number that is only compared with others.
pub(super) fn positive(key: &str, value: f64) -> Result<()> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(number(key.to_owned(), value, POSITIVE)) }
}

/// A number that is multiplied with others.
pub(super) fn size(key: &str, value: f64) -> Result<()> {
    positive(key, value)?;
    if (SMALLEST..=LARGEST).contains(&value) { Ok(()) } else { Err(number(key.to_owned(), value, SIZE)) }
}

/// A number of either sign that is multiplied with others.
pub(super) fn not_zero(key: &str, value: f64) -> Result<()> {
    let expected = "a number of either sign, of at most 1e48 in size and not zero";
    if value != 0.0 && value.abs() <= LARGEST { Ok(()) } else { Err(number(key.to_owned(), value, expected)) }
}

/// A number of significant digits.
pub(super) fn digits(key: &str, value: usize) -> Result<()> {
    if (1..=MAX_DIGITS).contains(&value) { Ok(()) } else { Err(number(key.to_owned(), value as f64, DIGITS)) }
}

pub(super) fn not_negative(key: &str, value: f64) -> Result<()> {
    if value.is_finite() && value >= 0.0 { Ok(()) } else { Err(number(key.to_owned(), value, "zero or more")) }
}

/// A number that is multiplied with others and may be zero.
pub(super) fn not_large(key: &str, value: f64) -> Result<()> {
    not_negative(key, value)?;
    if value <= LARGEST { Ok(()) } else { Err(number(key.to_owned(), value, "a number of at most 1e48")) }
}

pub(super) fn finite(key: &str, values: &[f64; 3]) -> Result<()> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(value) => Err(number(key.to_owned(), *value, FINITE)),
        None => Ok(()),
    }
}

/// A point from which distances are taken.
pub(super) fn point(key: &str, values: &[f64; 3]) -> Result<()> {
    finite(key, values)?;
    match values.iter().find(|value| value.abs() > LARGEST) {
        Some(value) => Err(number(key.to_owned(), *value, COORDINATE)),
        None => Ok(()),
    }
}

/// A vector with a direction: finite and not zero.
pub(super) fn direction(key: &str, vector: &[f64; 3]) -> Result<()> {
    finite(key, vector)?;
    if vector.iter().all(|component| *component == 0.0) {
        return Err(number(key.to_owned(), 0.0, "a vector with a direction"));
    }
    Ok(())
}

pub(super) fn number(key: String, value: f64, expected: &'static str) -> Error {
    Error::JobNumber { key, value, expected }
}
