//! Ranges of the numbers of a job.

use crate::error::{Error, Result};

const POSITIVE: &str = "a positive number";
const FINITE: &str = "a finite number";

pub(super) fn positive(key: &str, value: f64) -> Result<()> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(number(key.to_owned(), value, POSITIVE)) }
}

pub(super) fn not_negative(key: &str, value: f64) -> Result<()> {
    if value.is_finite() && value >= 0.0 { Ok(()) } else { Err(number(key.to_owned(), value, "zero or more")) }
}

pub(super) fn finite(key: &str, values: &[f64; 3]) -> Result<()> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(value) => Err(number(key.to_owned(), *value, FINITE)),
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
