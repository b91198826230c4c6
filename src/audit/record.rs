//! What the file records of its making: that it is whole, and its verification when it was made (M-26).

use std::collections::BTreeMap;

use supel_runtime::{CheckSummary, Coordinate, Superelement, Verdict};

use super::content::Content;
use super::spectrum::condition;
use super::version::applied;
use crate::audit::flaw::flaw;
use crate::error::Result;
use crate::job::{Certify, Job};
use crate::verification::catalogue::{CATALOGUE, Entry, Recorded, entry};
use crate::verification::check::Check;
use crate::verification::preservation::AccuracyMeasure;

/// M-26: the bytes of the file are those that its content makes: nothing is hidden in it, the digest holds.
pub fn rewritten(superelement: &Superelement, bytes: &[u8]) -> Check {
    let is_same = superelement.to_bytes().is_ok_and(|sealed| sealed.bytes == bytes);
    let flaws = if is_same {
        Vec::new()
    } else {
        vec!["its content written again gives other bytes: another program wrote it, or it holds more".to_owned()]
    };
    flaw("file is whole", "1 where its content written again is not the file, else 0", &flaws)
}

/// M-26: a superelement that was written although a check failed still says so.
pub(super) fn verdicts(content: &Content<'_>) -> Check {
    let verification = &content.superelement.metadata().verification;
    let failed = verification.checks.iter().filter(|check| check.verdict == Verdict::Fail);
    let mut flaws: Vec<String> = failed.map(|check| format!("{} failed", check.id)).collect();
    if flaws.is_empty() && verification.verdict == Verdict::Fail {
        flaws.push("not verified".to_owned());
    }
    flaw("no check failed when it was made", "number of failed checks on record", &flaws)
}

/// M-26: the record is one of a reduction, its verdicts follow from its values, and the values that the file gives again are those.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn consistent(content: &Content<'_>) -> Result<Check> {
    let checks = &content.superelement.metadata().verification.checks;
    let mut flaws: Vec<String> = checks
        .iter()
        .filter(|check| !follows(check))
        .map(|check| format!("{} says {:?} of its value", check.id, check.verdict).to_lowercase())
        .collect();
    flaws.extend(bars(content, checks));
    flaws.extend(mass_condition(content, checks)?);
    flaws.extend(applied(content.superelement, of_version(content)));
    Ok(flaw("the checks on record agree with the file", "number of records missing or contradicted", &flaws))
}

/// A value within its limit passes, one past it does not, and what is not a number fails.
fn follows(check: &CheckSummary) -> bool {
    match (check.value, check.verdict) {
        (Some(value), Verdict::Pass) => value <= check.limit,
        (Some(value), Verdict::Warn | Verdict::Fail) => value > check.limit,
        (None, verdict) => verdict == Verdict::Fail,
    }
}

/// What a record of this version has, and those of other programs and versions need not.
pub(super) fn of_version(content: &Content<'_>) -> Vec<String> {
    /// What practice asks of M-09.
    const LIMIT: f64 = 1e-4;
    let checks = &content.superelement.metadata().verification.checks;
    let has_other_limit = checks.iter().any(|check| check.id == "M-09" && check.limit != LIMIT);
    let mut flaws = missing(content, checks);
    flaws.extend(has_other_limit.then(|| "M-09 has another limit".to_owned()));
    flaws
}

fn missing(content: &Content<'_>, checks: &[CheckSummary]) -> Vec<String> {
    let mut found: BTreeMap<&str, usize> = BTreeMap::new();
    checks.iter().for_each(|check| *found.entry(&check.id).or_default() += 1);
    let lacking = CATALOGUE.iter().filter(|entry| found.get(entry.id).copied().unwrap_or(0) < least(content, entry));
    let mut flaws: Vec<String> = lacking.map(|entry| format!("{} is missing", entry.id)).collect();
    flaws.extend(found.keys().filter(|id| entry(id).is_none()).map(|id| format!("{id} is no check")));
    flaws
}

/// How often a reduction like that of the file records a check at least.
fn least(content: &Content<'_>, entry: &Entry) -> usize {
    let certify = content.job().map(Job::certified);
    match entry.recorded {
        Recorded::Always(count) => count,
        Recorded::WithMass([with, without]) => {
            if content.has_mass() {
                with
            } else {
                without
            }
        }
        Recorded::WithConstraintModes => usize::from(!content.is_attached()),
        Recorded::WithCarryingInterface => usize::from(content.n_b > 0 && !content.is_attached()),
        Recorded::WithAttachmentModes(count) => {
            if content.is_attached() {
                count
            } else {
                0
            }
        }
        Recorded::WithCount => usize::from(matches!(certify, Some(Certify::Count | Certify::Full))),
        Recorded::WithResidualVector => {
            let mut columns = content.superelement.metadata().named_columns();
            usize::from(columns.any(|coordinate| matches!(coordinate, Coordinate::ResidualVector { .. })))
        }
        Recorded::WithUnseenModes => usize::from(content.superelement.metadata().unseen_modes().next().is_some()),
        Recorded::WithDamping => usize::from(content.job().is_some_and(Job::has_damping)),
        Recorded::WithAccepted(measure) => {
            let accept = content.job().map(Job::accepted).unwrap_or_default();
            let limit = match measure {
                AccuracyMeasure::Frequency => accept.frequency,
                AccuracyMeasure::Response => accept.response_db,
                AccuracyMeasure::InternalLoad => accept.internal_load,
                AccuracyMeasure::Static => accept.statics,
            };
            usize::from(limit.is_some())
        }
        Recorded::Sometimes => 0,
    }
}

/// M-09 is the largest share that the digits of the data have in an error bar, relative to its frequency.
fn bars(content: &Content<'_>, checks: &[CheckSummary]) -> Option<String> {
    /// What the residual of a mode adds to its bar, relative to the digits and in itself, where nothing is wrong.
    const RESIDUAL: [f64; 2] = [10.0, 1e-9];
    let record = checks.iter().find(|check| check.id == "M-09")?;
    let relative = content.superelement.metadata().named_columns().filter_map(|coordinate| {
        let (_, frequency_hz) = coordinate.mode()?;
        Some(coordinate.error_bar_hz().map_or(f64::INFINITY, |bar| bar / frequency_hz))
    });
    let largest = relative.fold(0.0, f64::max);
    // A bar that is not a number has no place in the file, nor has the value.
    let stated = record.value.unwrap_or(f64::INFINITY);
    let agrees = stated <= largest * (1.0 + 1e-9) && largest <= stated * RESIDUAL[0] + RESIDUAL[1];
    (!agrees).then(|| "M-09 is not that of the error bars".to_owned())
}

/// The last M-23 on record is the condition of M̂ with a diagonal near one.
fn mass_condition(content: &Content<'_>, checks: &[CheckSummary]) -> Result<Option<String>> {
    if !content.has_mass() {
        return Ok(None);
    }
    /// The powers of two that bring a diagonal near one depend on the units, by a factor of √2 each way: the condition by 4.
    const UNITS: f64 = 4.0;
    /// Where hardly a digit is left the value is a sign of that and no more.
    const LARGEST: f64 = 1e12;
    let Some(record) = checks.iter().rev().find(|check| check.id == "M-23") else { return Ok(None) };
    let found = condition(content)?.value;
    let agrees = record.value.is_some_and(|stated| (found / UNITS..=found * UNITS).contains(&stated));
    Ok((found < LARGEST && !agrees).then(|| "M-23 is not that of the mass".to_owned()))
}
