//! What `supel reduce --all` says, as text and as the JSON document that `schemas/reductions.schema.json` describes.

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::Value;

use super::page::{Page, Paint, Tone};
use super::printable::printable;
use super::table::{self, Align};
use super::{Generator, json_text};
use crate::assembly::Joint;
use crate::error::{Error, INTERNAL_CODE, Result};
use crate::number::{counted, quantity};
use crate::verification::check::Verdict;

/// Version of the document's layout.
const FORMAT_VERSION: u32 = 1;

/// What became of the jobs of a folder or of an assembly.
#[derive(Clone, Debug)]
pub struct ReductionsReport {
    /// One for each job, in their order.
    pub components: Vec<ComponentRow>,
    /// One for each pair of interfaces that an assembly joins.
    pub joins: Vec<JoinRow>,
    /// Memory for all jobs that ran at the same time, in bytes, where there was a limit.
    pub budget_bytes: Option<u64>,
}

/// What became of a job.
#[derive(Clone, Debug, Serialize)]
pub struct ComponentRow {
    /// The name of the component.
    pub name: String,
    /// The document of its job.
    pub job: PathBuf,
    /// What its run did.
    pub outcome: ComponentOutcome,
    /// The exit code of its run.
    pub exit_code: u8,
    /// The verdict of its report: `pass`, `warn` or `fail`; none where there is no report.
    pub verdict: Option<String>,
    /// Degrees of freedom of the model.
    pub n_dofs: Option<u64>,
    /// Coordinates of the superelement.
    pub n_reduced: Option<u64>,
    /// Modes that it keeps.
    pub n_modes: Option<u64>,
    /// How long its run took; none where it had nothing to do.
    pub seconds: Option<f64>,
    /// The superelement; none where none was written.
    pub superelement: Option<PathBuf>,
    /// Why there is none.
    pub error: Option<ErrorLine>,
}

/// What the run of a job did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ComponentOutcome {
    /// Nothing: everything was there and unchanged.
    UpToDate,
    /// It reduced the component and judged the result.
    Reduced,
    /// It ended in an error.
    Failed,
}

/// An error in a row.
#[derive(Clone, Debug, Serialize)]
pub struct ErrorLine {
    /// Its code.
    pub code: String,
    /// Its message.
    pub message: String,
}

/// Two interfaces that are to be joined.
#[derive(Clone, Debug, Serialize)]
pub struct JoinRow {
    /// The first, as it was named.
    pub a: String,
    /// The second.
    pub b: String,
    /// Pairs of nodes, or of rows.
    pub n_nodes: Option<usize>,
    /// Pairs of dofs.
    pub n_dofs: Option<usize>,
    /// The largest distance between the nodes of a pair; none for rows.
    pub distance: Option<f64>,
    /// The component without a verified superelement that they were not compared for.
    pub not_compared: Option<String>,
    /// Why they do not fit, or could not be compared.
    pub error: Option<ErrorLine>,
    /// The exit code that follows; none where they were not compared, which is a matter of the component.
    pub exit_code: u8,
}

impl ErrorLine {
    /// An error of this process.
    pub fn of(error: &Error) -> Self {
        Self { code: error.code().to_owned(), message: error.to_string() }
    }

    /// The line for stderr that says of what it is.
    pub fn line(&self, what: &str) -> String {
        format!("supel: {what}: error[{}]: {}", self.code, self.message)
    }

    /// The error in the document of another process, or, where that left none, how it ended.
    pub fn of_document(answer: &Value, ended: &str) -> Self {
        let text = |key: &str| answer["error"][key].as_str().map(str::to_owned);
        let code = text("code").unwrap_or_else(|| INTERNAL_CODE.to_owned());
        Self { code, message: text("message").unwrap_or_else(|| format!("the run left no answer: {ended}")) }
    }
}

impl ComponentRow {
    /// The row of a run that left a report.
    pub fn of_report(name: &str, job: &Path, (outcome, report): (ComponentOutcome, &Value)) -> Self {
        let (model, reduction) = (&report["body"]["model"], &report["body"]["reduction"]);
        let stages = report["run"]["stages"].as_array().map_or(&[][..], Vec::as_slice);
        let seconds = stages.iter().filter_map(|stage| stage["seconds"].as_f64()).sum();
        Self {
            name: name.to_owned(),
            job: job.to_owned(),
            outcome,
            exit_code: 0,
            verdict: report["body"]["verdict"].as_str().map(str::to_owned),
            n_dofs: model["n_dofs"].as_u64(),
            n_reduced: reduction["n_reduced"].as_u64(),
            n_modes: reduction["n_modes"].as_u64(),
            seconds: (outcome != ComponentOutcome::UpToDate).then_some(seconds),
            superelement: report["run"]["superelement"].as_str().map(PathBuf::from),
            error: None,
        }
    }

    /// The row of a run that ended in an error.
    pub fn failed(name: &str, job: &Path, (exit_code, error): (u8, ErrorLine)) -> Self {
        Self {
            exit_code,
            error: Some(error),
            outcome: ComponentOutcome::Failed,
            seconds: None,
            ..Self::of_report(name, job, (ComponentOutcome::Failed, &Value::Null))
        }
    }

    /// What became of it, in words.
    fn words(&self) -> (String, Verdict) {
        let kept = if self.outcome == ComponentOutcome::UpToDate { "up to date: " } else { "" };
        match (&self.error, self.verdict.as_deref(), self.exit_code) {
            (Some(error), ..) => (format!("✗ {}", error.code), Verdict::Fail),
            (None, Some("pass"), 0) => (format!("✓ {kept}verified"), Verdict::Pass),
            (None, Some("warn"), 0) => (format!("! {kept}verified, with warnings"), Verdict::Warn),
            (None, ..) => ("✗ not verified".to_owned(), Verdict::Fail),
        }
    }
}

impl JoinRow {
    /// Two that fit.
    pub fn fitting(joint: &Joint) -> Self {
        let Joint { a, b, n_nodes, n_dofs, distance, .. } = joint.clone();
        let (n_nodes, n_dofs) = (Some(n_nodes), Some(n_dofs));
        Self { n_nodes, n_dofs, distance, ..Self::of(&a, &b) }
    }

    /// Two of which one is of a component without a verified superelement.
    pub fn not_compared(a: &str, b: &str, component: &str) -> Self {
        Self { not_compared: Some(component.to_owned()), ..Self::of(a, b) }
    }

    /// Two that do not fit, or could not be compared.
    pub fn refused(a: &str, b: &str, error: &Error) -> Self {
        Self { error: Some(ErrorLine::of(error)), exit_code: error.class() as u8, ..Self::of(a, b) }
    }

    fn of(a: &str, b: &str) -> Self {
        let [a, b] = [a, b].map(str::to_owned);
        Self { a, b, n_nodes: None, n_dofs: None, distance: None, not_compared: None, error: None, exit_code: 0 }
    }

    /// Why they do not fit, as a line for stderr.
    pub fn refusal(&self) -> Option<String> {
        Some(self.error.as_ref()?.line(&format!("{} = {}", self.a, self.b)))
    }
}

#[derive(Serialize)]
struct Document<'a> {
    format_version: u32,
    generator: Generator,
    exit_code: u8,
    budget_bytes: Option<u64>,
    components: &'a [ComponentRow],
    joins: &'a [JoinRow],
}

impl ReductionsReport {
    /// The exit code of the worst: the highest.
    pub fn exit_code(&self) -> u8 {
        let of_joins = self.joins.iter().map(|join| join.exit_code);
        self.components.iter().map(|component| component.exit_code).chain(of_joins).max().unwrap_or(0)
    }

    /// The JSON document.
    ///
    /// # Errors
    /// [`Error::NotJson`] where a path is not UTF-8.
    pub fn to_json(&self) -> Result<String> {
        let document = Document {
            format_version: FORMAT_VERSION,
            generator: Generator::default(),
            exit_code: self.exit_code(),
            budget_bytes: self.budget_bytes,
            components: &self.components,
            joins: &self.joins,
        };
        json_text("the answer", &document)
    }

    /// The text for people.
    pub fn to_text(&self, paint: Paint) -> String {
        let mut page = Page::new(paint);
        let n = counted(self.components.len(), "component", "components");
        page.line(Page::toned(&format!("reduction of {n}"), Tone::Heading));
        page.line("");
        self.table(&mut page);
        if !self.joins.is_empty() {
            page.heading("Joined interfaces");
            self.joins.iter().for_each(|join| page.line(&format!("  {}", of_join(join))));
        }
        page.line("");
        page.line(&format!("  {}", self.conclusion()));
        page.into_text()
    }

    /// A line for each component that is not verified, and for each pair of interfaces that does not fit.
    pub fn unmet(&self) -> Vec<String> {
        let components = self.components.iter().filter(|row| row.exit_code != 0).map(|row| match &row.error {
            Some(error) => error.line(&row.name),
            None => format!("supel: {}: not verified", row.name),
        });
        components.chain(self.joins.iter().filter_map(JoinRow::refusal)).collect()
    }

    fn table(&self, page: &mut Page) {
        let or_dash = |value: Option<String>| value.unwrap_or_else(|| "–".to_owned());
        let number = |value: Option<u64>| or_dash(value.map(|value| value.to_string()));
        let head = ["component", "verdict", "dofs", "coordinates", "modes", "seconds", "file"].map(str::to_owned);
        let body = self.components.iter().map(|row| {
            let file = row.superelement.as_ref().and_then(|path| path.file_name());
            [
                printable(&row.name).into_owned(),
                row.words().0,
                number(row.n_dofs),
                number(row.n_reduced),
                number(row.n_modes),
                or_dash(row.seconds.map(|seconds| format!("{seconds:.2}"))),
                or_dash(file.map(|name| printable(&name.to_string_lossy()).into_owned())),
            ]
        });
        let rows: Vec<[String; 7]> = std::iter::once(head).chain(body).collect();
        let align = [Align::Left, Align::Left, Align::Right, Align::Right, Align::Right, Align::Right, Align::Left];
        for (at, cells) in table::columns(&rows, align).into_iter().enumerate() {
            let tone = match at.checked_sub(1) {
                None => Tone::Faint,
                Some(row) => Tone::Of(self.components[row].words().1),
            };
            let [name, verdict, rest @ ..] = cells;
            let is_head = at == 0;
            let rest = format!("  {}", rest.join("  "));
            let rest = if is_head { Page::toned(&rest, Tone::Faint) } else { rest.as_str().into() };
            let name = if is_head { Page::toned(&name, Tone::Faint) } else { name.as_str().into() };
            page.spans(&["  ".into(), name, "  ".into(), Page::toned(&verdict, tone), rest]);
        }
    }

    fn conclusion(&self) -> String {
        let n_bad = self.components.iter().filter(|row| row.exit_code != 0).count();
        let n_apart = self.joins.iter().filter(|join| join.exit_code != 0).count();
        let of_all = counted(self.components.len(), "component", "components");
        let apart = format!("joined interfaces do not fit: {}", counted(n_apart, "pair", "pairs"));
        match (n_bad, n_apart) {
            (0, 0) => format!("✓ {of_all} verified"),
            (0, _) => format!("✗ {apart}"),
            (_, 0) => format!("✗ {n_bad} of {of_all} not verified"),
            _ => format!("✗ {n_bad} of {of_all} not verified; {apart}"),
        }
    }
}

fn of_join(join: &JoinRow) -> String {
    let JoinRow { a, b, n_nodes, n_dofs, distance, not_compared, error, .. } = join;
    match (error, not_compared) {
        (Some(error), _) => format!("✗ {a} = {b}: {}", error.code),
        (None, Some(component)) => {
            format!("– {a} = {b}: not compared, `{}` has no verified superelement", printable(component))
        }
        (None, None) => {
            let nodes = counted(n_nodes.unwrap_or(0), "pair of nodes", "pairs of nodes");
            let dofs = counted(n_dofs.unwrap_or(0), "dof", "dofs");
            let apart = distance.map(|distance| format!(" · at most {} apart", quantity(distance, 3)));
            format!("✓ {a} = {b} · {nodes} · {dofs}{}", apart.unwrap_or_default())
        }
    }
}
