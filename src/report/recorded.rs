//! A report that an earlier run wrote, read again.

use std::path::Path;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use serde_json::{Map, Value};

use super::json::FORMAT_VERSION;
use super::json_text;
use crate::error::Result;

/// A report that an earlier run wrote. Its body is kept as it is written.
#[derive(Debug, Deserialize)]
pub struct RecordedReport {
    body: Box<RawValue>,
    run: Map<String, Value>,
}

/// What is read of the body.
#[derive(Deserialize)]
struct RecordedBody {
    format_version: u32,
    verdict: String,
    warnings: Vec<IgnoredAny>,
}

/// What became of the checks of a run, by its report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedVerdict {
    /// All passed, without a warning.
    Verified,
    /// None failed; there are so many warnings, or none but checks past their limits.
    Reserved {
        /// Warnings.
        n_warnings: usize,
    },
    /// One failed.
    Failed,
}

/// The report as the answer of a run that had nothing to do.
#[derive(Serialize)]
struct UpToDate<'a> {
    body: &'a RawValue,
    run: Map<String, Value>,
}

impl RecordedReport {
    /// The report in a document; none where that is no report of this layout.
    pub fn parse(document: &[u8]) -> Option<Self> {
        let report: Self = serde_json::from_slice(document).ok()?;
        (report.read_body()?.format_version == FORMAT_VERSION).then_some(report)
    }

    /// BLAKE3 of the superelement that the run wrote; none where it wrote none.
    pub fn file_digest(&self) -> Option<&str> {
        self.run.get("file_digest")?.as_str()
    }

    /// What became of its checks.
    pub fn verdict(&self) -> RecordedVerdict {
        match self.read_body() {
            Some(body) if body.verdict == "pass" => RecordedVerdict::Verified,
            Some(body) if body.verdict == "warn" => RecordedVerdict::Reserved { n_warnings: body.warnings.len() },
            Some(_) | None => RecordedVerdict::Failed,
        }
    }

    /// The report as the answer of a run that found it and its superelement up to date, where they are now.
    ///
    /// # Errors
    /// [`crate::error::Error::NotJson`] where a value cannot be written.
    pub fn up_to_date(&self, superelement: &Path, report: &Path) -> Result<String> {
        let mut run = self.run.clone();
        for (key, path) in [("superelement", superelement), ("report", report)] {
            run.insert(key.to_owned(), path.to_string_lossy().into());
        }
        run.insert("up_to_date".to_owned(), true.into());
        json_text("the report", &UpToDate { body: &self.body, run })
    }

    fn read_body(&self) -> Option<RecordedBody> {
        serde_json::from_str(self.body.get()).ok()
    }
}
