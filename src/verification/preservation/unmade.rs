//! Comparisons that were meant to be made and that the arithmetic could not make: M-33.
//!
//! A comparison that costs too much, or that the model has no place for, is left out and told. One that has no answer says
//! something of the matrices, so that it counts.

use super::super::check::{Check, Limits};
use crate::error::Error;

/// A comparison that could not be made.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmade {
    /// What was to be compared.
    pub what: String,
    /// Whether the reduced matrices have no answer: both are without energy in one motion, or negative there.
    pub is_of_reduced: bool,
}

impl Unmade {
    /// A comparison that ended with an error.
    pub(super) fn of(what: &str, error: &Error) -> Self {
        Self { what: what.to_owned(), is_of_reduced: matches!(error, Error::DenseEigen { .. }) }
    }
}

/// M-33; none where every comparison was made.
pub fn unmade_check(unmade: &[Unmade]) -> Option<Check> {
    let listed: Vec<&str> = unmade.iter().map(|unmade| unmade.what.as_str()).collect();
    (!unmade.is_empty()).then(|| Check {
        id: "M-33",
        name: "comparisons with the full model were made",
        equation: "comparisons that the matrices have no answer for",
        value: unmade.len() as f64,
        limits: Limits::default(),
        fail_above: Check::NEVER,
        worst: Some(listed.join("; ")),
    })
}
