//! What `--quiet` says of checks that decide the exit code: a line for each.

use super::command::Strictness;
use crate::report::unmet_check;
use crate::verification::check::{Check, Verdict};

/// A line for each check that failed or, where warnings count, warned.
pub(super) fn unmet(checks: &[Check], strictness: Strictness) -> Vec<String> {
    let least = match strictness {
        Strictness::Normal => Verdict::Fail,
        Strictness::Strict => Verdict::Warn,
    };
    let counts = |check: &&Check| check.verdict() >= least;
    checks.iter().filter(counts).map(|check| format!("supel: {}", unmet_check(check))).collect()
}
