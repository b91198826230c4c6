//! Whether what a job makes is there already, so that `supel reduce` has nothing to do.
//!
//! Whatever is not known to be unchanged counts as changed. The bytes of the inputs are compared by their digests, the outputs by the digest
//! of the superelement that each of them names. No stage of a reduction runs.

use std::path::Path;

use supel_runtime::{Generator, Superelement, Verdict};

use super::accompanying;
use super::judging::Strictness;
use crate::audit;
use crate::error::Result;
use crate::input;
use crate::job::{Job, WriteJob};
use crate::number::counted;
use crate::output::job_document;
use crate::plan::Plan;
use crate::report::{RecordedReport, RecordedVerdict, file_words, printable};
use crate::verification::check::Verdict as CheckVerdict;

/// Whether a job runs whose results are up to date.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Repetition {
    /// It does not.
    Skipped,
    /// It does.
    Forced,
}

/// By the flag `--force`.
impl From<bool> for Repetition {
    fn from(is_forced: bool) -> Self {
        if is_forced { Self::Forced } else { Self::Skipped }
    }
}

/// What a job asks for, made by an earlier run.
pub(super) struct MadeEarlier {
    report: RecordedReport,
    write: WriteJob,
}

/// Why a job has to run.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Stale {
    /// There is nothing yet, or nothing of this job.
    NotMade,
    /// Something else than the job has changed, which is worth a word.
    Because(String),
}

/// What a job asks for, where all of it is there and unchanged.
pub(super) fn made_earlier(job: &Job, strictness: Strictness) -> Result<MadeEarlier, Stale> {
    let path = job.write.superelement.as_path();
    let (superelement, bytes) = input::superelement(path).map_err(|_| Stale::NotMade)?;
    if !is_kept_job(job, &superelement).unwrap_or(false) {
        return Err(Stale::NotMade);
    }
    if !audit::is_of_this_version(&superelement) {
        let Generator { name, version, .. } = &superelement.metadata().generator;
        return Err(Stale::Because(format!("it was made by {name} {version}")));
    }
    let is_whole = audit::rewritten(&superelement, &bytes).verdict() == CheckVerdict::Pass;
    if !is_whole || superelement.metadata().verification.verdict == Verdict::Fail {
        return Err(Stale::NotMade);
    }
    let digest = superelement.to_bytes().map_err(|_| Stale::NotMade)?.digest;
    let report = report_of(&job.write, &digest)?;
    match (report.verdict(), strictness) {
        (RecordedVerdict::Verified, _) | (RecordedVerdict::Reserved { .. }, Strictness::Normal) => {}
        // The run says what failed, and what it makes of the file that is there.
        (RecordedVerdict::Reserved { .. }, Strictness::Strict) | (RecordedVerdict::Failed, _) => {
            return Err(Stale::NotMade);
        }
    }
    match input::changed_role(Plan::of(job).job(), &superelement.metadata().inputs) {
        Ok(None) => Ok(MadeEarlier { report, write: job.write.clone() }),
        Ok(Some(role)) => Err(Stale::Because(format!("the input {:?} has changed", file_words(&role)))),
        // The run meets the same error and reports it.
        Err(_) => Err(Stale::NotMade),
    }
}

/// Whether the job kept in a superelement is this one, every key of it. Both are compared as they are written.
fn is_kept_job(job: &Job, superelement: &Superelement) -> Option<bool> {
    let written = serde_json::to_string(&job_document(job).ok()?).ok()?;
    let read_back: serde_json::Value = serde_json::from_str(&written).ok()?;
    Some(read_back == superelement.metadata().job)
}

/// The report on the superelement of a digest, where the outputs that are asked for in addition to it are all there and of that file.
fn report_of(write: &WriteJob, digest: &str) -> Result<RecordedReport, Stale> {
    let other = |path: &Path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Stale::Because(format!("{name} is not there, or of another run"))
    };
    let path = write.report_path();
    let report = accompanying::read(&path).filter(|report| report.file_digest() == Some(digest));
    let report = report.ok_or_else(|| other(&path))?;
    let named = format!("value=\"{digest}\"");
    let of_page = [digest, "</html>"];
    // A run that counted warnings as failures wrote them there.
    let of_junit = [named.as_str(), " failures=\"0\"", "</testsuites>"];
    let texts = [(write.html.as_deref(), &of_page[..]), (write.junit.as_deref(), &of_junit)];
    for (path, expected) in texts.into_iter().filter_map(|(path, expected)| Some((path?, expected))) {
        let text = accompanying::bytes(path).and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_default();
        if !expected.iter().all(|expected| text.contains(expected)) {
            return Err(other(path));
        }
    }
    Ok(report)
}

impl MadeEarlier {
    /// What it is, for a person.
    pub(super) fn to_text(&self) -> String {
        let verdict = match self.report.verdict() {
            RecordedVerdict::Reserved { n_warnings: 0 } => "verified, with checks past their limits".to_owned(),
            RecordedVerdict::Reserved { n_warnings } => {
                format!("verified, with {}", counted(n_warnings, "warning", "warnings"))
            }
            RecordedVerdict::Verified | RecordedVerdict::Failed => "verified".to_owned(),
        };
        let path = self.write.superelement.to_string_lossy();
        format!("{} is up to date: {verdict}\n", printable(&path))
    }

    /// The report that was written with it, which says that nothing was computed now.
    ///
    /// # Errors
    /// A report that cannot be written as text.
    pub(super) fn to_json(&self) -> Result<String> {
        self.report.up_to_date(&self.write.superelement, &self.write.report_path())
    }
}
