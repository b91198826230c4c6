//! What `--quiet` says of checks and warnings that decide the exit code: a line for each.

use super::judging::Strictness;
use crate::error::Warning;
use crate::report::unmet_check;
use crate::verification::check::{Check, Verdict};

/// A line for each check that failed; where warnings count, also for each that warned and for each warning.
pub(super) fn unmet(checks: &[Check], warnings: &[Warning], strictness: Strictness) -> Vec<String> {
    let (least, warnings) = match strictness {
        Strictness::Normal => (Verdict::Fail, &[][..]),
        Strictness::Strict => (Verdict::Warn, warnings),
    };
    let counts = |check: &&Check| check.verdict() >= least;
    let checks = checks.iter().filter(counts).map(|check| format!("supel: {}", unmet_check(check)));
    checks.chain(warnings.iter().map(|Warning { code, message }| format!("supel: {code}: {message}"))).collect()
}
