//! What `supel verify` says, as text and as the JSON document that `schemas/verification.schema.json` describes.

use serde::ser::{Serialize, SerializeStruct, Serializer};
use supel_runtime::Superelement;

use super::conclusion::{MatrixDigits, Open, Reservations, conclusion};
use super::json::CheckLine;
use super::page::{Page, Paint, Tone, WIDTH};
use super::summary::body;
use super::{Generator, json_text, table};
use crate::audit::Audit;
use crate::error::Result;

/// Version of the document's layout.
const FORMAT_VERSION: u32 = 1;

/// What the superelement was compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Against {
    /// Its own file alone.
    File,
    /// The full matrices of a job too.
    Model,
}

/// Whether its job was run again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reproduction {
    /// No.
    None,
    /// Yes, and the bytes were compared.
    Compared,
}

/// The checks of a superelement that was made earlier.
#[derive(Clone, Debug, PartialEq)]
pub struct VerificationReport {
    /// BLAKE3 digest of the file.
    pub digest: String,
    /// What it was compared with.
    pub against: Against,
    /// Whether its job was run again.
    pub reproduction: Reproduction,
    /// What was found.
    pub audit: Audit,
}

impl VerificationReport {
    /// The JSON document on `superelement`; numbers that are not finite become `null`.
    ///
    /// # Errors
    ///
    /// [`crate::error::Error::NotJson`]; nothing in it can have it.
    pub fn to_json(&self, superelement: &Superelement) -> Result<String> {
        json_text("the answer", &Document { report: self, superelement })
    }

    /// The text about `superelement` for people.
    pub fn to_text(&self, superelement: &Superelement, reservations: Reservations, paint: Paint) -> String {
        let mut page = Page::new(paint);
        let metadata = superelement.metadata();
        let sizes = format!("{} coordinates", superelement.n_coordinates());
        page.line(Page::toned(&format!("superelement · {} · {sizes}", metadata.method.name()), Tone::Heading));
        page.entry("made by", &format!("{} {}", metadata.generator.name, metadata.generator.version));
        page.entry("file", &format!("blake3 {}", self.digest));
        let against = match self.against {
            Against::File => "the file alone; give the job with --job to compare with the full matrices",
            Against::Model => "the file and the full matrices of the job",
        };
        page.entry("compared with", against);
        if self.reproduction == Reproduction::Compared {
            page.entry("", "the superelement that the same job makes now, to the last bit");
        }
        page.heading("Checked");
        body::checks(&mut page, &self.audit.checks);
        if !self.audit.notes.is_empty() {
            page.heading("Not judged");
            self.audit.notes.iter().for_each(|note| page.entry("note", note));
        }
        if !self.audit.unvouched.is_empty() {
            page.heading("Not vouched for");
            for field in &self.audit.unvouched {
                let lines = table::wrap(&format!("{}: {}", field.field, field.reason), WIDTH - 6);
                let lines = lines.iter().enumerate();
                lines.for_each(|(at, line)| page.line(&format!("  {}{line}", if at == 0 { "" } else { "    " })));
            }
        }
        page.line("");
        let shares = metadata.named_columns().map(|column| Some(column.error_bar_hz()? / column.mode()?.1));
        let open = Open { share: shares.flatten().fold(0.0, f64::max), digits: MatrixDigits::Unrecorded };
        let verdict = self.audit.verdict();
        for line in table::wrap(&conclusion(&self.audit.checks, 0, (verdict, reservations), &open), WIDTH) {
            page.line(Page::toned(&line, Tone::Of(verdict)));
        }
        page.into_text()
    }
}

struct Document<'a> {
    report: &'a VerificationReport,
    superelement: &'a Superelement,
}

#[derive(serde::Serialize)]
struct Subject<'a> {
    digest: &'a str,
    generator: &'a supel_runtime::Generator,
    method: supel_runtime::Method,
    n_reduced: usize,
    n_interface: usize,
    n_rigid: usize,
    n_modes: usize,
}

impl Serialize for Document<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let VerificationReport { digest, against, reproduction, audit } = self.report;
        let metadata = self.superelement.metadata();
        let subject = Subject {
            digest,
            generator: &metadata.generator,
            method: metadata.method,
            n_reduced: self.superelement.n_coordinates(),
            n_interface: self.superelement.n_interface(),
            n_rigid: self.superelement.n_rigid(),
            n_modes: self.superelement.tensors().frequencies.len(),
        };
        let checks: Vec<CheckLine<'_>> = audit.checks.iter().map(CheckLine::of).collect();
        let mut document = serializer.serialize_struct("VerificationReport", 9)?;
        document.serialize_field("format_version", &FORMAT_VERSION)?;
        document.serialize_field("generator", &Generator::default())?;
        document.serialize_field("verdict", &audit.verdict())?;
        document.serialize_field("subject", &subject)?;
        document.serialize_field("against", against)?;
        document.serialize_field("reproduced", &(*reproduction == Reproduction::Compared))?;
        document.serialize_field("checks", &checks)?;
        document.serialize_field("notes", &audit.notes)?;
        document.serialize_field("unvouched", &audit.unvouched)?;
        document.end()
    }
}
