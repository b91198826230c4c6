//! What `supel certify` says, as text and as the JSON document that `schemas/certification.schema.json` describes.

use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

use super::conclusion::{MatrixDigits, Open, Reservations, concluded};
use super::json::CheckLine;
use super::page::{Page, Paint, Tone, WIDTH, verdict_word};
use super::summary::body;
use super::table::{self, Align};
use super::{Generator, MatrixReport, json_text};
use crate::certification::{BandCount, Certification, JudgedPair, MissingMode, Off, PairKind};
use crate::error::{Result, Warning};
use crate::input::{ForeignModes, InputFacts, MatrixFacts, ModeValues};
use crate::modes::Component;
use crate::number::{self, counted, quantity, scientific};
use crate::verification::check::{Check, Verdict};

/// Version of the document's layout.
const FORMAT_VERSION: u32 = 1;
/// Rows of a table of pairs, or of missing modes, that the text has at most; the document has all of them.
const SHOWN: usize = 60;

/// A result of another program, held against a model.
#[derive(Clone, Debug)]
pub struct CertificationReport {
    /// The program that wrote the report.
    pub generator: Generator,
    /// The model.
    pub model: CertifiedModel,
    /// The result as it was read.
    pub result: ResultReport,
    /// What was found of it.
    pub certification: Certification,
}

/// The model that a result is held against.
#[derive(Clone, Debug, Serialize)]
pub struct CertifiedModel {
    /// Degrees of freedom: rows of K and M.
    pub n_dofs: usize,
    /// Nodes, where the rows belong to nodes.
    pub n_nodes: Option<usize>,
    /// Connected parts that can move.
    pub n_bodies: usize,
    /// Rows that are held.
    pub n_held: usize,
    /// Motions without strain energy.
    pub n_rigid: usize,
    /// K.
    pub stiffness: MatrixReport,
    /// M.
    pub mass: MatrixReport,
    /// What reading and checking did or found, one sentence each, without paths.
    pub notes: Vec<String>,
    /// What the user should know of the model.
    pub warnings: Vec<Warning>,
}

/// A result as it was read.
#[derive(Clone, Debug, Serialize)]
pub struct ResultReport {
    /// The program that wrote the file, where it tells.
    pub program: Option<&'static str>,
    /// BLAKE3 of the file of the shapes.
    pub digest: String,
    /// Pairs.
    pub n_pairs: usize,
    /// What the frequencies are, where the result has some.
    pub frequencies: Option<&'static str>,
}

impl CertifiedModel {
    /// What is known of the model of a component.
    pub fn of(facts: &InputFacts, component: Component<'_>) -> Self {
        let model = &component.partition.model;
        let [stiffness, mass] = &facts.matrices;
        let matrix = |facts: &MatrixFacts| MatrixReport {
            n_nonzeros: facts.n_nonzeros,
            digits: facts.digits,
            digest: facts.digest.clone(),
        };
        let findings = || model.findings.iter().chain(&component.partition.findings);
        let told = findings().filter(|finding| finding.warning().is_none()).map(ToString::to_string);
        let warned = findings()
            .filter_map(|finding| finding.warning().map(|code| Warning { code, message: finding.to_string() }));
        Self {
            n_dofs: model.n_dofs,
            n_nodes: model.n_nodes,
            n_bodies: model.n_bodies,
            n_held: model.n_held,
            n_rigid: component.rigid.count(),
            stiffness: matrix(stiffness),
            mass: matrix(mass),
            notes: facts.notes.iter().cloned().chain(told).collect(),
            warnings: facts.warnings.iter().cloned().chain(warned).collect(),
        }
    }
}

impl ResultReport {
    /// What is known of modes that were read, with the frequencies that are theirs.
    pub fn of(modes: &ForeignModes, values: Option<&ModeValues>) -> Self {
        Self {
            program: modes.program,
            digest: modes.digest.clone(),
            n_pairs: modes.columns.len(),
            frequencies: values.map(|values| values.unit.name()),
        }
    }
}

impl CertificationReport {
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
        let Self { generator, model, certification, .. } = self;
        let dofs = counted(model.n_dofs, "degree of freedom", "degrees of freedom");
        let title = format!("{} {} · certification of eigenpairs · {dofs}", generator.name, generator.version);
        page.line(Page::toned(&title, Tone::Heading));
        page.heading("Read");
        self.read(&mut page);
        page.heading("Found");
        for (label, line) in self.found() {
            page.entry(label, &line);
        }
        self.pairs(&mut page);
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
        let Certification { checks, .. } = &self.certification;
        let open = Open { share: 0.0, digits: MatrixDigits::All };
        concluded("certified", checks, 0, (self.certification.verdict(), reservations, &open))
    }

    fn read(&self, page: &mut Page) {
        read_model(page, &self.model);
        let result = &self.result;
        let mut parts = vec![counted(result.n_pairs, "shape", "shapes")];
        parts.push(result.frequencies.unwrap_or("no frequencies").to_owned());
        parts.extend(result.program.map(|program| format!("written by {program}")));
        parts.push(format!("blake3 {}…", body::short(&result.digest)));
        page.entry("result", &parts.join(" · "));
        self.model.notes.iter().for_each(|note| page.entry("note", note));
    }

    /// What was found, a label and a line each, the worst first.
    pub(super) fn found(&self) -> Vec<(&'static str, String)> {
        let Certification { band_hz: [from, to], count, missing, n_not_sought, notes, .. } = &self.certification;
        let mut lines = vec![("band", format!("{} Hz to {} Hz", quantity(*from, 7), quantity(*to, 7)))];
        lines.extend(count.iter().map(|count| ("count", counted_in_words(count, *from))));
        for (at, mode) in missing.iter().take(SHOWN).enumerate() {
            lines.push((if at == 0 { "missing" } else { "" }, missing_in_words(mode)));
        }
        if missing.len() > SHOWN {
            lines.push(("", format!("… and {} more with --json", missing.len() - SHOWN)));
        }
        if *n_not_sought > 0 {
            let text = counted(*n_not_sought, "more mode is missing", "more modes are missing");
            lines.push(("missing", format!("{text} in the band: too many to be looked for, give a smaller --band")));
        }
        for kind in [PairKind::Invented, PairKind::Repeated, PairKind::Inexact] {
            let of_kind = self.certification.pairs.iter().filter(|pair| pair.kind == kind);
            let label = kind_label(kind);
            lines.extend(
                of_kind
                    .take(SHOWN)
                    .enumerate()
                    .map(|(at, pair)| (if at == 0 { label } else { "" }, pair_in_words(pair))),
            );
        }
        lines.extend(notes.iter().map(|note| ("note", note.clone())));
        lines
    }

    fn pairs(&self, page: &mut Page) {
        let pairs = &self.certification.pairs;
        let highest = pairs.iter().map(|pair| pair.shape_hz).filter(|hertz| hertz.is_finite()).fold(0.0, f64::max);
        // Nine digits of the highest frequency show every error bar that engineering cares about.
        let decimals = usize::try_from(8 - number::decade(highest)).unwrap_or(0).min(9);
        let hertz = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |hertz| format!("{hertz:.decimals$}"));
        let heads = ["pair", "stated Hz", "of its shape Hz", "± Hz", "residual", ""].map(str::to_owned);
        let row = |pair: &JudgedPair| {
            [
                pair.number.to_string(),
                hertz(pair.stated_hz),
                hertz(Some(pair.shape_hz)),
                scientific(pair.error_bar_hz, 2),
                scientific(pair.backward_error, 2),
                kind_word(pair.kind).to_owned(),
            ]
        };
        let rows: Vec<[String; 6]> = std::iter::once(heads).chain(pairs.iter().take(SHOWN).map(row)).collect();
        let align = [Align::Right, Align::Right, Align::Right, Align::Right, Align::Right, Align::Left];
        let mut lines = table::columns(&rows, align).into_iter();
        page.heading("Pairs");
        if let Some(heads) = lines.next() {
            page.spans(&["  ".into(), Page::toned(&heads.join("  "), Tone::Faint)]);
        }
        for (line, pair) in lines.zip(pairs) {
            let [cells @ .., kind] = line;
            let verdict = verdict_of(pair.kind);
            let sign = verdict_word(verdict).chars().next().unwrap_or(' ');
            let kind = format!("{sign} {}", kind.trim_end());
            page.spans(&["  ".into(), (&cells.join("  ")).into(), "  ".into(), Page::toned(&kind, Tone::Of(verdict))]);
        }
        if pairs.len() > SHOWN {
            let hint = format!("{} of {} pairs; --json lists all", SHOWN, pairs.len());
            page.spans(&["  ".into(), Page::toned(&hint, Tone::Faint)]);
        }
    }
}

/// The model in a few lines.
pub(super) fn read_model(page: &mut Page, model: &CertifiedModel) {
    let CertifiedModel { n_dofs, n_nodes, n_bodies, n_held, n_rigid, stiffness, mass, .. } = model;
    let mut parts = vec![counted(*n_dofs, "dof", "dofs")];
    parts.extend(n_nodes.map(|n_nodes| counted(n_nodes, "node", "nodes")));
    parts.push(counted(*n_bodies, "body", "bodies"));
    if *n_held > 0 {
        parts.push(format!("{} held", number::count(*n_held as u64)));
    }
    parts.push(match n_rigid {
        0 => "no rigid-body modes".to_owned(),
        n => counted(*n, "rigid-body mode", "rigid-body modes"),
    });
    page.entry("model", &parts.join(" · "));
    page.entry("stiffness", &body::matrix(stiffness));
    page.entry("mass", &body::matrix(mass));
}

/// The count of a band that begins at a frequency.
fn counted_in_words(count: &BandCount, from_hz: f64) -> String {
    let BandCount { below_hz, n_counted, n_given, doubt } = count;
    let likely = if *doubt > 1.0 { "; its pivots grew so much that it is likely, not certain" } else { "" };
    let to = quantity(*below_hz, 7);
    let place = if from_hz > 0.0 {
        format!("between {} Hz and {to} Hz", quantity(from_hz, 7))
    } else {
        format!("up to {to} Hz")
    };
    format!(
        "a Sturm count finds {} {place}; the result has {}{likely}",
        counted(*n_counted, "mode", "modes"),
        if n_given == n_counted { "all of them".to_owned() } else { number::count(*n_given as u64) }
    )
}

fn missing_in_words(mode: &MissingMode) -> String {
    let MissingMode { frequency_hz, error_bar_hz, of_frequency: [n_modes, n_given] } = mode;
    let frequency = with_bar(*frequency_hz, *error_bar_hz);
    match n_modes {
        1 => frequency,
        n => format!("{frequency}: the model has {n} modes of this frequency, the result {n_given}"),
    }
}

/// A frequency and its error bar, with digits down to a tenth of that.
fn with_bar(hertz: f64, bar: f64) -> String {
    /// Digits that the matrices of practice have.
    const MOST: i32 = 9;
    let digits = if bar > 0.0 { number::decade(hertz) - number::decade(bar) + 2 } else { MOST };
    format!("{} Hz ± {}", quantity(hertz, digits.clamp(1, MOST) as usize), scientific(bar, 1))
}

pub(super) fn kind_word(kind: PairKind) -> &'static str {
    match kind {
        PairKind::RigidBody => "rigid-body",
        PairKind::Mode => "mode",
        PairKind::Inexact => "inexact",
        PairKind::Repeated => "repeated",
        PairKind::Invented => "no mode",
        PairKind::OutsideBand => "outside of the band",
    }
}

fn kind_label(kind: PairKind) -> &'static str {
    match kind {
        PairKind::Invented => "invented",
        other => kind_word(other),
    }
}

pub(super) fn verdict_of(kind: PairKind) -> Verdict {
    match kind {
        PairKind::RigidBody | PairKind::Mode => Verdict::Pass,
        PairKind::OutsideBand => Verdict::Info,
        PairKind::Inexact => Verdict::Warn,
        PairKind::Repeated | PairKind::Invented => Verdict::Fail,
    }
}

/// What is wrong with a pair.
pub(super) fn pair_in_words(pair: &JudgedPair) -> String {
    let stated = pair.stated_hz.unwrap_or(pair.shape_hz);
    let name = format!("pair {} at {} Hz", pair.number, quantity(stated, 7));
    let shape = format!("its shape has {} Hz", quantity(pair.shape_hz, 7));
    match pair.kind {
        PairKind::Repeated => match pair.repeats {
            Some(other) => format!("{name}: its shape is that of pair {other}, or a combination of it and others"),
            None => format!("{name}: its shape is a poor copy of others"),
        },
        PairKind::Invented => {
            let near = match pair.neighbours_hz {
                [Some(below), Some(above)] => {
                    format!("the nearest are at {} Hz and {} Hz", quantity(below, 7), quantity(above, 7))
                }
                [Some(one), None] | [None, Some(one)] => format!("the nearest is at {} Hz", quantity(one, 7)),
                [None, None] => "none is near".to_owned(),
            };
            format!("{name}: K and M have no such mode – {near}; largest residual at {}", pair.worst_at)
        }
        PairKind::Inexact if pair.out_of_place.is_some() => {
            let share = quantity(pair.out_of_place.unwrap_or(0.0), 2);
            format!(
                "{name}: it moves rows that are held, or that follow others, by {share} of its largest displacement"
            )
        }
        PairKind::Inexact => match pair.mode_hz {
            Some(0.0) => format!("{name}: rigid-body motion, which has no frequency"),
            Some(mode) => {
                let mode = with_bar(mode, pair.mode_error_bar_hz.unwrap_or(f64::INFINITY));
                let off = match pair.off() {
                    Some(Off::Stated(off)) => format!("off by {} %", quantity(100.0 * off, 2)),
                    Some(Off::Shape(off)) => format!("the shape is off by {} % of it", quantity(100.0 * off, 2)),
                    Some(Off::Residual) | None => "known no better by the residual of its shape".to_owned(),
                };
                format!("{name}: {shape}, the mode that it is has {mode}, {off}")
            }
            None => format!("{name}: {shape}"),
        },
        PairKind::RigidBody | PairKind::Mode | PairKind::OutsideBand => format!("{name}: {shape}"),
    }
}

impl Serialize for CertificationReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let Self { generator, model, result, certification } = self;
        let Certification { band_hz, pairs, missing, n_not_sought, count, checks, notes, .. } = certification;
        let checks: Vec<CheckLine<'_>> = checks.iter().map(|check: &Check| CheckLine::of(check)).collect();
        let mut document = serializer.serialize_struct("CertificationReport", 12)?;
        document.serialize_field("format_version", &FORMAT_VERSION)?;
        document.serialize_field("generator", generator)?;
        document.serialize_field("verdict", &certification.verdict())?;
        document.serialize_field("model", model)?;
        document.serialize_field("result", result)?;
        document.serialize_field("band_hz", band_hz)?;
        document.serialize_field("count", count)?;
        document.serialize_field("missing", missing)?;
        document.serialize_field("n_not_sought", n_not_sought)?;
        document.serialize_field("pairs", pairs)?;
        document.serialize_field("checks", &checks)?;
        document.serialize_field("notes", notes)?;
        document.end()
    }
}
