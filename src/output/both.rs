//! Superelement and report of one run.

use supel_runtime::Superelement;

use super::results::Results;
use super::{report as body, superelement};
use crate::error::Result;
use crate::report::{Report, RunFacts};

/// The superelement and its report.
///
/// # Errors
/// A result that the file format refuses, such as a value that is not finite; a solve that did not come down to rounding.
pub fn output(results: &Results<'_>) -> Result<(Superelement, Report)> {
    results.evidence.factor.refinement()?;
    let body = body::body(results);
    let superelement = superelement::superelement(results, body.verdict_of_reduction())?;
    let run = RunFacts { work: results.work(), ..Default::default() };
    Ok((superelement, Report { body, run }))
}
