//! What `supel certify` says of a superelement with its basis, as text and as the JSON document that
//! `schemas/certified-superelement.schema.json` describes.

use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

use super::certification::read_model;
use super::conclusion::{MatrixDigits, Open, Reservations, concluded};
use super::json::CheckLine;
use super::page::{Page, Paint, Tone, WIDTH};
use super::summary::{body, preserved};
use super::table::{self, Align};
use super::{CertifiedModel, Generator, json_text, words};
use crate::certification::{ForeignSuperelement, FreeComparison, ReducedCertification};
use crate::error::Result;
use crate::number::{self, counted, quantity};
use crate::verification::check::Check;
use crate::verification::preservation::{BoundaryComparison, FrequencyPair};

/// Version of the document's layout.
const FORMAT_VERSION: u32 = 1;
/// Frequencies that the text has at most.
const SHOWN: usize = 40;

/// A superelement of another program, held against a model.
#[derive(Clone, Debug)]
pub struct ReducedReport {
    /// The program that wrote the report.
    pub generator: Generator,
    /// The model.
    pub model: CertifiedModel,
    /// The superelement as it was read.
    pub source: ReducedSource,
    /// What was found of it.
    pub certification: ReducedCertification,
}

/// A superelement as it was read: BLAKE3 digests of its files.
#[derive(Clone, Debug, Serialize)]
pub struct ReducedSource {
    /// Ψ.
    pub basis: String,
    /// K̂.
    pub stiffness: String,
    /// M̂.
    pub mass: String,
}

impl ReducedSource {
    /// What is known of a superelement that was read.
    pub fn of(given: &ForeignSuperelement) -> Self {
        let [stiffness, mass] = [&given.stiffness, &given.mass].map(|matrix| matrix.digest.clone());
        Self { basis: given.basis.digest.clone(), stiffness, mass }
    }
}

impl ReducedReport {
    /// The JSON document; numbers that are not finite become `null`.
    ///
    /// # Errors
    ///
    /// [`crate::error::Error::NotJson`]; nothing in it can have it.
    pub fn to_json(&self) -> Result<String> {
        json_text("the answer", self)
    }

    /// The text for people.
    pub fn to_text(&self, reservations: Reservations, paint: Paint) -> String {
        let mut page = Page::new(paint);
        let Self { generator, model, source, certification } = self;
        let sizes = format!(
            "{} → {} degrees of freedom",
            number::count(model.n_dofs as u64),
            number::count(certification.n_coordinates as u64)
        );
        let title = format!("{} {} · certification of a superelement · {sizes}", generator.name, generator.version);
        page.line(Page::toned(&title, Tone::Heading));
        page.heading("Read");
        read_model(&mut page, model);
        let digests = [("basis", &source.basis), ("reduced", &source.stiffness), ("", &source.mass)];
        digests.into_iter().for_each(|(label, digest)| page.entry(label, &format!("blake3 {}…", body::short(digest))));
        model.notes.iter().for_each(|note| page.entry("note", note));
        page.heading("Found");
        self.found().iter().for_each(|(label, line)| page.entry(label, line));
        if let Some(compared) = &certification.free.frequencies {
            frequencies(&mut page, compared);
        }
        certification.preservation.iter().for_each(|preservation| preserved::write(&mut page, preservation));
        page.heading("Checked");
        body::checks(&mut page, &certification.checks);
        if !model.warnings.is_empty() {
            page.heading("Warnings");
            model.warnings.iter().for_each(|warning| page.entry(warning.code, &warning.message));
        }
        page.line("");
        for line in table::wrap(&self.conclusion(reservations), WIDTH) {
            page.line(Page::toned(&line, Tone::Of(certification.verdict())));
        }
        page.into_text()
    }

    /// The verdict in one line.
    fn conclusion(&self, reservations: Reservations) -> String {
        let Self { certification, .. } = self;
        let open = Open { share: 0.0, digits: MatrixDigits::All };
        concluded("certified", &certification.checks, 0, (certification.verdict(), reservations, &open))
    }

    /// What was found, a label and a line each.
    pub(super) fn found(&self) -> Vec<(&'static str, String)> {
        let ReducedCertification { n_coordinates, n_interface, free, notes, .. } = &self.certification;
        let FreeComparison { band_hz: [from, to], n_rigid, n_without_stiffness, .. } = free;
        let coordinates = counted(*n_coordinates, "coordinate", "coordinates");
        let interface = match n_interface {
            0 => "none of them a row of K".to_owned(),
            n => format!("{} of them rows of K, its interface", number::count(*n as u64)),
        };
        let mut lines = vec![
            ("coordinates", format!("{coordinates}, {interface}")),
            ("band", format!("{} Hz to {} Hz", quantity(*from, 7), quantity(*to, 7))),
            (
                "rigid body",
                format!(
                    "{} without stiffness; the component has {}",
                    counted(*n_without_stiffness, "motion", "motions"),
                    counted(*n_rigid, "rigid-body mode", "rigid-body modes")
                ),
            ),
        ];
        lines.extend(notes.iter().map(|note| ("note", note.clone())));
        lines
    }
}

/// A row for each frequency of the component, its interface free.
fn frequencies(page: &mut Page, compared: &BoundaryComparison) {
    let pairs = &compared.frequencies;
    let highest = pairs.iter().map(|pair| pair.full_hz).fold(0.0, f64::max);
    let decimals = usize::try_from(8 - number::decade(highest)).unwrap_or(0).min(9);
    let heads = ["mode", "component Hz", "superelement Hz", "off by", ""].map(str::to_owned);
    let of_pair = |(at, pair): (usize, &FrequencyPair)| {
        let has_one = pair.reduced_hz.is_finite();
        [
            (at + 1).to_string(),
            words::full_frequency(pair, decimals),
            if has_one { format!("{:.decimals$}", pair.reduced_hz) } else { "–".to_owned() },
            if has_one { format!("{} %", quantity(100.0 * pair.relative_difference, 2)) } else { String::new() },
            if pair.in_band { String::new() } else { "outside of the band".to_owned() },
        ]
    };
    let rows: Vec<[String; 5]> =
        std::iter::once(heads).chain(pairs.iter().enumerate().take(SHOWN).map(of_pair)).collect();
    let align = [Align::Right, Align::Right, Align::Right, Align::Right, Align::Left];
    page.heading("Frequencies of the free component");
    for (at, cells) in table::columns(&rows, align).into_iter().enumerate() {
        let line = cells.join("  ");
        let line = line.trim_end();
        page.spans(&["  ".into(), if at == 0 { Page::toned(line, Tone::Faint) } else { line.into() }]);
    }
    if pairs.len() > SHOWN {
        page.spans(&["  ".into(), Page::toned(&format!("{SHOWN} of {}; --json lists all", pairs.len()), Tone::Faint)]);
    }
}

impl Serialize for ReducedReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let Self { generator, model, source, certification } = self;
        let ReducedCertification { n_coordinates, n_interface, free, preservation, checks, notes } = certification;
        let checks: Vec<CheckLine<'_>> = checks.iter().map(|check: &Check| CheckLine::of(check)).collect();
        let mut document = serializer.serialize_struct("ReducedReport", 14)?;
        document.serialize_field("format_version", &FORMAT_VERSION)?;
        document.serialize_field("generator", generator)?;
        document.serialize_field("verdict", &certification.verdict())?;
        document.serialize_field("model", model)?;
        document.serialize_field("superelement", source)?;
        document.serialize_field("n_coordinates", n_coordinates)?;
        document.serialize_field("n_interface", n_interface)?;
        document.serialize_field("n_rigid", &free.n_rigid)?;
        document.serialize_field("n_without_stiffness", &free.n_without_stiffness)?;
        document.serialize_field("band_hz", &free.band_hz)?;
        document.serialize_field("free", &free.frequencies)?;
        document.serialize_field("preservation", preservation)?;
        document.serialize_field("checks", &checks)?;
        document.serialize_field("notes", notes)?;
        document.end()
    }
}
