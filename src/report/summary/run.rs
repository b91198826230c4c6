//! What the run cost, where its files are, and the verdict as the last line.

use crate::number;
use crate::report::conclusion::{MatrixDigits, Open, conclusion};
use crate::report::page::{LABEL, Page, Tone, WIDTH};
use crate::report::table::{self, Align};
use crate::report::{Report, RunFacts, StageTime, WorkCounters, words};

/// Columns of the bar that shows a stage's share of the time.
const BAR: usize = 40;

pub(super) fn write(page: &mut Page, report: &Report) {
    page.heading("Run");
    stages(page, &report.run.stages);
    facts(page, &report.run);
    accuracy(page, report);
    page.line("");
    verdict(page, report);
}

fn accuracy(page: &mut Page, report: &Report) {
    let lines = words::accuracy(&report.body);
    if !lines.is_empty() {
        page.heading("Accuracy");
        lines.iter().for_each(|(label, line)| page.entry(label, line));
    }
}

fn stages(page: &mut Page, stages: &[StageTime]) {
    let total: f64 = stages.iter().map(|stage| stage.seconds).sum();
    let names = stages.iter().map(|stage| stage.name).chain(["total"]);
    let seconds = stages.iter().map(|stage| stage.seconds).chain([total]);
    let rows: Vec<[String; 2]> =
        names.zip(seconds.clone()).map(|(name, seconds)| [name.to_owned(), number::duration(seconds)]).collect();
    for ([name, time], seconds) in table::columns(&rows, [Align::Left, Align::Right]).into_iter().zip(seconds) {
        let bar = if name.trim_end() == "total" { String::new() } else { bar(seconds / total) };
        let name = Page::toned(&table::pad(&name, LABEL, Align::Left), Tone::Faint);
        let time = format!("  {time}  ");
        page.spans(&["  ".into(), name, (&time).into(), Page::toned(&bar, Tone::Faint)]);
    }
}

/// A bar in eighths of a column.
fn bar(share: f64) -> String {
    const EIGHTHS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
    let eighths = (share.clamp(0.0, 1.0) * (BAR * 8) as f64).round() as usize;
    format!("{}{}", "█".repeat(eighths / 8), EIGHTHS.get(eighths % 8).unwrap_or(&""))
}

fn facts(page: &mut Page, run: &RunFacts) {
    let WorkCounters { n_factorisations, n_solves, n_restarts, factor_flops, factor_nonzeros } = run.work;
    let work = [
        number::counted(n_factorisations, "factorisation", "factorisations"),
        number::counted(n_solves, "solve", "solves"),
        number::counted(n_restarts, "restart", "restarts"),
        number::counted(run.n_threads, "thread", "threads"),
    ];
    page.entry("work", &work.join(" · "));
    if factor_nonzeros > 0 {
        let entries = number::counted(usize::try_from(factor_nonzeros).unwrap_or(usize::MAX), "nonzero", "nonzeros");
        page.entry("largest factor", &format!("{entries} · {} flop", number::scientific(factor_flops, 2)));
    }
    if let Some(tally) = &run.cache {
        page.entry("cache", &words::cache(tally));
    }
    if let Some(peak) = run.peak_memory_bytes {
        page.entry("peak memory", &number::bytes(peak));
    }
    if let Some(path) = &run.superelement {
        let size = run.file_bytes.map(|size| format!(" · {}", number::bytes(size))).unwrap_or_default();
        page.entry("superelement", &format!("{}{size}", path.display()));
    }
    if let Some(path) = &run.report {
        page.entry("report", &path.display().to_string());
    }
}

fn verdict(page: &mut Page, report: &Report) {
    let body = &report.body;
    let verdict = body.verdict();
    let known = body.reduction.modes.iter().map(|mode| mode.error_bar_hz / mode.frequency_hz);
    let has_all =
        body.model.stiffness.digits.are_all() && body.model.mass.as_ref().is_none_or(|mass| mass.digits.are_all());
    let digits = if has_all { MatrixDigits::All } else { MatrixDigits::Fewer };
    let open = Open { share: known.fold(0.0, f64::max), digits };
    let text = conclusion(&body.checks, body.warnings.len(), (verdict, report.run.reservations), &open);
    let text = if report.run.superelement.is_none() { text + " – no superelement was written" } else { text };
    for line in table::wrap(&text, WIDTH) {
        page.line(Page::toned(&line, Tone::Of(verdict)));
    }
}
