//! Checks that count differences.

use crate::verification::check::{Check, Limits};

/// A check that counts flaws.
pub(crate) fn flaw(name: &'static str, equation: &'static str, flaws: &[String]) -> Check {
    Check {
        id: "M-26",
        name,
        equation,
        value: flaws.len() as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: (!flaws.is_empty()).then(|| flaws.join(", ")),
    }
}
