//! The report as text for people: at most 100 columns, the same words as the JSON document.

mod body;
mod run;

use super::Report;
use super::table::{self, Align};
use crate::verification::check::Verdict;

/// Widest line of the summary.
const WIDTH: usize = 100;

/// Width of the labels at the left of a section.
const LABEL: usize = 16;

/// Whether the text carries colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// Characters only, for files, pipes and `NO_COLOR`.
    Plain,
    /// With the escape sequences of a terminal.
    Colour,
}

/// The summary of `report`, with a newline at its end.
pub fn summary(report: &Report, paint: Paint) -> String {
    let mut page = Page { paint, text: String::new() };
    body::write(&mut page, &report.body);
    run::write(&mut page, report);
    page.text
}

/// What a piece of text means, which decides its colour.
#[derive(Clone, Copy)]
enum Tone {
    Heading,
    Faint,
    Of(Verdict),
}

/// The text so far.
struct Page {
    paint: Paint,
    text: String,
}

impl Page {
    fn line(&mut self, text: &str) {
        self.text.push_str(text.trim_end());
        self.text.push('\n');
    }

    fn heading(&mut self, text: &str) {
        let heading = self.toned(text, Tone::Heading);
        self.line("");
        self.line(&heading);
    }

    /// A label and its value, which continues below itself where it is long.
    fn entry(&mut self, label: &str, value: &str) {
        let label = table::shorten(label, LABEL);
        for (line_idx, line) in table::wrap(value, WIDTH - LABEL - 4).iter().enumerate() {
            let label = if line_idx == 0 { label.as_str() } else { "" };
            let label = self.toned(&table::pad(label, LABEL, Align::Left), Tone::Faint);
            self.line(&format!("  {label}  {line}"));
        }
    }

    fn toned(&self, text: &str, tone: Tone) -> String {
        let code = match tone {
            Tone::Heading => "1",
            Tone::Faint => "2",
            Tone::Of(Verdict::Pass) => "32",
            Tone::Of(Verdict::Warn) => "33",
            Tone::Of(Verdict::Fail) => "1;31",
        };
        match self.paint {
            Paint::Plain => text.to_owned(),
            Paint::Colour => format!("\x1b[{code}m{text}\x1b[0m"),
        }
    }
}

/// The sign and the word of a verdict.
fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "✓ pass",
        Verdict::Warn => "! warn",
        Verdict::Fail => "✗ fail",
    }
}
