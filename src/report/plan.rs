//! What `supel plan` says, as text and as the JSON document that `schemas/plan.schema.json` describes.

use serde::Serialize;

use super::page::{Page, Paint, Tone, WIDTH};
use super::table::{self, Align};
use super::{Generator, json_text};
use crate::cost_forecast::{ExpectedModes, Forecast, Known, Need, Rates, Stage, Work};
use crate::error::{Result, Warning};
use crate::number::{self, counted};
use crate::plan::{Decision, Kind, RULES, Row};

/// Version of the document's layout.
const FORMAT_VERSION: u32 = 1;

/// What a job will do and what it will cost on one machine.
#[derive(Clone, Copy, Debug)]
pub struct PlanReport<'a> {
    /// What is known of the run.
    pub forecast: &'a Forecast,
    /// How fast the machine is.
    pub rates: &'a Rates,
    /// Number of threads.
    pub n_threads: usize,
}

#[derive(Serialize)]
struct Document<'a> {
    format_version: u32,
    generator: Generator,
    model: ModelLine,
    modes: ModesLine,
    stages: Vec<StageLine<'a>>,
    total: TotalLine,
    memory: MemoryLine,
    answer: AnswerLine,
    rules: Vec<RuleLine>,
    assumptions: Vec<String>,
    warnings: &'a [Warning],
    machine: MachineLine<'a>,
}

#[derive(Serialize)]
struct ModelLine {
    n_dofs: usize,
    n_internal: usize,
    n_interface: usize,
    n_rigid: usize,
    n_parts: usize,
    factor_entries: f64,
}

#[derive(Serialize)]
struct StageLine<'a> {
    name: &'static str,
    needed_by: Option<&'static str>,
    skipped_by: Option<String>,
    left_out: Option<&'a str>,
    #[serde(flatten)]
    cost: TotalLine,
}

#[derive(Serialize)]
struct ModesLine {
    #[serde(flatten)]
    expected: ExpectedModes,
    chosen_by: &'static str,
}

#[derive(Serialize)]
struct TotalLine {
    flops: f64,
    bytes: f64,
    seconds: f64,
}

#[derive(Serialize)]
struct MemoryLine {
    peak_bytes: u64,
    factor_bytes: u64,
    matrix_bytes: u64,
    vector_bytes: u64,
    program_bytes: u64,
    allowed_bytes: Option<u64>,
    fits: bool,
}

#[derive(Serialize)]
struct AnswerLine {
    n_coordinates: usize,
    file_bytes: u64,
}

#[derive(Serialize)]
struct RuleLine {
    id: String,
    kind: Kind,
    leaves_out: &'static str,
    because: &'static str,
    guard: &'static str,
    decision: &'static str,
    words: Option<String>,
}

#[derive(Serialize)]
struct MachineLine<'a> {
    n_threads: usize,
    rates: &'a Rates,
}

impl PlanReport<'_> {
    /// The JSON document.
    ///
    /// # Errors
    /// [`crate::error::Error::NotJson`]; nothing in it can have it.
    pub fn to_json(&self) -> Result<String> {
        let Forecast { plan, modes, memory, warnings, .. } = self.forecast;
        let document = Document {
            format_version: FORMAT_VERSION,
            generator: Generator::default(),
            model: self.model(),
            modes: ModesLine {
                expected: *modes,
                chosen_by: if plan.searched_hz().is_some() { "accept" } else { "job" },
            },
            stages: self.forecast.stages.iter().map(|stage| self.stage(stage)).collect(),
            total: self.cost(&self.total()),
            memory: MemoryLine {
                peak_bytes: memory.total(),
                factor_bytes: memory.factors,
                matrix_bytes: memory.matrices,
                vector_bytes: memory.vectors,
                program_bytes: memory.program,
                allowed_bytes: self.forecast.allowed_bytes,
                fits: self.forecast.fits(),
            },
            answer: AnswerLine { n_coordinates: self.forecast.n_coordinates, file_bytes: self.forecast.file_bytes },
            rules: plan.rows().into_iter().map(RuleLine::of).collect(),
            assumptions: plan.assumptions(),
            warnings,
            machine: MachineLine { n_threads: self.n_threads, rates: self.rates },
        };
        json_text("the plan", &document)
    }

    /// The text for people.
    pub fn to_text(&self, paint: Paint) -> String {
        let mut page = Page::new(paint);
        let model = self.model();
        let title = format!(
            "plan · {} · {} dofs, {} of the interface",
            self.forecast.plan.job().reduction.method.name(),
            number::count(model.n_dofs as u64),
            number::count(model.n_interface as u64),
        );
        page.line(Page::toned(&title, Tone::Heading));
        page.entry("answer", &self.answer());
        page.entry("memory", &self.memory());
        let threads = counted(self.n_threads, "thread", "threads");
        page.entry("time", &format!("{} with {threads}", about(self.total().seconds(self.rates))));
        page.heading("Stages");
        self.table(&mut page);
        self.rules(&mut page);
        if !self.forecast.warnings.is_empty() {
            page.heading("Warnings");
            self.forecast.warnings.iter().for_each(|warning| page.entry(warning.code, &warning.message));
        }
        page.into_text()
    }

    fn model(&self) -> ModelLine {
        let sizes = &self.forecast.sizes;
        let (n_dofs, n_interface) = (sizes.n_dofs as usize, sizes.n_interface as usize);
        let facts = self.forecast.plan.facts();
        ModelLine {
            n_dofs,
            n_internal: n_dofs - n_interface,
            n_interface,
            n_rigid: facts.map_or(0, |facts| facts.n_rigid),
            n_parts: facts.map_or(1, |facts| facts.n_parts),
            factor_entries: sizes.factor_entries,
        }
    }

    fn total(&self) -> Work {
        self.forecast.stages.iter().map(|stage| stage.work).sum()
    }

    fn cost(&self, work: &Work) -> TotalLine {
        TotalLine { flops: work.flops(), bytes: work.bytes(), seconds: work.seconds(self.rates) }
    }

    fn stage<'a>(&self, Stage { name, need, work }: &'a Stage) -> StageLine<'a> {
        let (needed_by, skipped_by, left_out) = match need {
            Need::By(what) => (Some(*what), None, None),
            Need::Skipped(rule) => (None, Some(rule.name()), None),
            Need::LeftOut(why) => (None, None, Some(why.as_str())),
        };
        StageLine { name, needed_by, skipped_by, left_out, cost: self.cost(work) }
    }

    fn answer(&self) -> String {
        let Forecast { n_coordinates, file_bytes, modes, .. } = self.forecast;
        let of_modes = match (modes.known, self.forecast.plan.searched_hz()) {
            (_, Some(hertz)) => {
                let most = match modes.known {
                    Known::Asked | Known::Counted => counted(modes.count, "mode", "modes"),
                    Known::Assumed => format!("{} modes, a guess that --count-modes replaces,", modes.count),
                };
                let band = number::quantity(hertz, 3);
                format!(
                    " with all {most} up to {band} Hz that are looked through first; the fewest that `accept` allows stay, \
                     and where these do not do, twice or four times the band is looked through"
                )
            }
            (Known::Asked, None) => String::new(),
            (Known::Counted, None) => format!(" with the {} of the band", counted(modes.count, "mode", "modes")),
            (Known::Assumed, None) => {
                format!(" if the band has {} modes, which is a guess: --count-modes counts them", modes.count)
            }
        };
        format!(
            "{} coordinates{of_modes}, a file of {}",
            number::count(*n_coordinates as u64),
            number::bytes(*file_bytes)
        )
    }

    fn memory(&self) -> String {
        let memory = self.forecast.memory;
        let [peak, factors, matrices, vectors, program] =
            [memory.total(), memory.factors, memory.matrices, memory.vectors, memory.program].map(number::bytes);
        let room = match (self.forecast.allowed_bytes.map(number::bytes), self.forecast.fits()) {
            (None, _) => String::new(),
            (Some(allowed), true) => format!("; {allowed} are there"),
            (Some(allowed), false) => format!("; {allowed} are there: `supel reduce` will refuse"),
        };
        format!(
            "{peak}: {factors} of factors, {matrices} of matrices, {vectors} of vectors, {program} of the program{room}"
        )
    }

    fn table(&self, page: &mut Page) {
        let head = ["stage", "operations", "bytes", "time", "needed by"].map(str::to_owned);
        let mut rows = vec![head];
        rows.extend(self.forecast.stages.iter().map(|stage| self.row(stage)));
        let aligned = [Align::Left, Align::Right, Align::Right, Align::Right, Align::Left];
        // What a stage is needed by, or why it is left out, goes on below itself.
        let narrow: Vec<[String; 4]> = rows.iter().map(|[a, b, c, d, _]| [a, b, c, d].map(Clone::clone)).collect();
        let narrow = table::columns(&narrow, [aligned[0], aligned[1], aligned[2], aligned[3]]);
        let at = table::width(&narrow[0].join("  ")) + 4;
        for (place, (cells, [.., why])) in narrow.iter().zip(&rows).enumerate() {
            for (line_idx, line) in table::wrap(why, WIDTH - at).iter().enumerate() {
                let cells = if line_idx == 0 { cells.join("  ") } else { " ".repeat(at - 4) };
                match place {
                    0 => page.spans(&["  ".into(), Page::toned(&format!("{cells}  {line}"), Tone::Faint)]),
                    _ => page.line(&format!("  {cells}  {line}")),
                }
            }
        }
    }

    fn row(&self, Stage { name, need, work }: &Stage) -> [String; 5] {
        let why = match need {
            Need::By(what) => (*what).to_owned(),
            Need::Skipped(rule) => format!("skipped by {}", rule.name()),
            Need::LeftOut(why) => format!("left out: {why}"),
        };
        if !matches!(need, Need::By(_)) {
            return [(*name).to_owned(), "–".to_owned(), "–".to_owned(), "–".to_owned(), why];
        }
        let TotalLine { flops, bytes, seconds } = self.cost(work);
        [(*name).to_owned(), number::quantity(flops, 2), number::bytes(bytes as u64), about(seconds), why]
    }

    /// What rules leave out by what the scene and the job say; what is always so stands in the document.
    fn rules(&self, page: &mut Page) {
        page.heading("Skipped");
        let skipped = self.forecast.plan.skipped();
        skipped.iter().for_each(|(rule, what)| page.entry(&rule.name(), what));
        if skipped.is_empty() {
            page.line("  nothing: the scene asks for everything");
        }
        for assumption in self.forecast.plan.assumptions() {
            page.entry("taken for granted", &assumption);
        }
    }
}

impl RuleLine {
    fn of(Row { rule, decision }: Row) -> Self {
        let of_table = &RULES[rule as usize];
        let (decision, words) = match decision {
            Decision::LeftOut(words) => ("left-out", Some(words)),
            Decision::Kept(words) => ("kept", Some(words)),
            Decision::Open => ("open", None),
        };
        Self {
            id: rule.name(),
            kind: of_table.kind,
            leaves_out: of_table.leaves_out,
            because: of_table.because,
            guard: of_table.guard,
            decision,
            words,
        }
    }
}

/// A time that is an estimate: with two digits at most.
fn about(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 0.05 => "< 0.1 s".to_owned(),
        seconds if seconds < 60.0 => format!("{} s", number::quantity(seconds, 2)),
        seconds => number::duration(seconds),
    }
}
