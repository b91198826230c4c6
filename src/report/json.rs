//! The report as a JSON document: stored values and the verdicts that follow from them.

use std::path::Path;

use serde::ser::{Serialize, SerializeStruct, Serializer};
use supel_runtime::StagedFile;

use super::{Completeness, Report, ReportBody, json_text};
use crate::error::{Error, Result};
use crate::verification::check::{ActiveLimit, Check, Verdict};

/// Version of the report's layout, raised when a reader of the old one would misread the new one.
pub(super) const FORMAT_VERSION: u32 = 1;

impl Report {
    /// The JSON document; numbers that are not finite become `null`.
    ///
    /// # Errors
    ///
    /// [`Error::NotJson`] where the path of an output is not UTF-8.
    pub fn to_json(&self) -> Result<String> {
        json_text("the report", self)
    }

    /// Writes the JSON document to `path`: whole or not at all.
    ///
    /// # Errors
    ///
    /// The errors of [`Self::to_json`]; [`Error::Write`], [`Error::NotSynced`], or [`Error::OutputKind`] where `path` is a folder or a device.
    pub fn write(&self, path: &Path) -> Result<()> {
        StagedFile::write(path, self.to_json()?.as_bytes()).and_then(StagedFile::commit).map_err(Error::of_writing)
    }
}

impl Serialize for ReportBody {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let checks: Vec<CheckLine<'_>> = self.checks.iter().map(CheckLine::of).collect();
        let mut body = serializer.serialize_struct("ReportBody", 11)?;
        body.serialize_field("format_version", &FORMAT_VERSION)?;
        body.serialize_field("generator", &self.generator)?;
        body.serialize_field("verdict", &self.verdict())?;
        body.serialize_field("completeness", &self.completeness)?;
        body.serialize_field("model", &self.model)?;
        body.serialize_field("reduction", &self.reduction)?;
        body.serialize_field("checks", &checks)?;
        body.serialize_field("warnings", &self.warnings)?;
        body.serialize_field("trust_intervals", &self.trust_intervals)?;
        body.serialize_field("rigid_body", &self.rigid_body)?;
        body.serialize_field("preservation", &self.preservation)?;
        body.end()
    }
}

/// A check with what follows from its values.
#[derive(serde::Serialize)]
pub(super) struct CheckLine<'a> {
    id: &'a str,
    name: &'a str,
    equation: &'a str,
    value: f64,
    limit: f64,
    active_limit: Option<ActiveLimit>,
    fail_above: f64,
    margin: f64,
    verdict: Verdict,
    worst: Option<&'a str>,
}

impl<'a> CheckLine<'a> {
    pub(super) fn of(check: &'a Check) -> Self {
        Self {
            id: check.id,
            name: check.name,
            equation: check.equation,
            value: check.value,
            limit: check.limits.value(),
            active_limit: check.is_judged().then(|| check.limits.active()),
            fail_above: if check.fail_above == Check::NEVER { f64::INFINITY } else { check.fails_above() },
            margin: if check.is_judged() { check.margin() } else { f64::NAN },
            verdict: check.verdict(),
            worst: check.worst.as_deref(),
        }
    }
}

impl Serialize for Completeness {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let (certificate, below_hz, n_counted, n_found) = match self {
            Self::NotCertified { .. } => ("none", None, None, None),
            Self::SturmCount { below_hz, n_counted, n_found, .. } => {
                ("sturm-count", Some(below_hz), Some(n_counted), Some(n_found))
            }
        };
        let mut line = serializer.serialize_struct("Completeness", 6)?;
        line.serialize_field("certificate", certificate)?;
        line.serialize_field("is_certified", &self.is_certified())?;
        line.serialize_field("statement", &self.statement())?;
        line.serialize_field("below_hz", &below_hz)?;
        line.serialize_field("n_counted", &n_counted)?;
        line.serialize_field("n_found", &n_found)?;
        line.end()
    }
}
