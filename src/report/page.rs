//! A page of text for people: headings, labelled entries, tables, with or without colour.

use super::table::{self, Align};
use crate::verification::check::Verdict;

/// Widest line of the summary.
pub(crate) const WIDTH: usize = 100;

/// Width of the labels at the left of a section.
pub(crate) const LABEL: usize = 16;

/// Whether the text carries colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// Characters only, for files, pipes and `NO_COLOR`.
    Plain,
    /// With the escape sequences of a terminal.
    Colour,
}

/// What a piece of text means, which decides its colour.
#[derive(Clone, Copy)]
pub(crate) enum Tone {
    Heading,
    Faint,
    Of(Verdict),
}

/// The text so far.
pub(crate) struct Page {
    paint: Paint,
    text: String,
}

impl Page {
    pub(crate) fn new(paint: Paint) -> Self {
        Self { paint, text: String::new() }
    }

    pub(crate) fn into_text(self) -> String {
        self.text
    }

    pub(crate) fn line(&mut self, text: &str) {
        self.text.push_str(text.trim_end());
        self.text.push('\n');
    }

    pub(crate) fn heading(&mut self, text: &str) {
        let heading = self.toned(text, Tone::Heading);
        self.line("");
        self.line(&heading);
    }

    /// A label and its value, which continues below itself where it is long.
    pub(crate) fn entry(&mut self, label: &str, value: &str) {
        let label = table::shorten(label, LABEL);
        for (line_idx, line) in table::wrap(value, WIDTH - LABEL - 4).iter().enumerate() {
            let label = if line_idx == 0 { label.as_str() } else { "" };
            let label = self.toned(&table::pad(label, LABEL, Align::Left), Tone::Faint);
            self.line(&format!("  {label}  {line}"));
        }
    }

    pub(crate) fn toned(&self, text: &str, tone: Tone) -> String {
        let code = match tone {
            Tone::Heading => "1",
            Tone::Faint => "2",
            Tone::Of(Verdict::Info) => "36",
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
pub(crate) fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Info => "· shown",
        Verdict::Pass => "✓ pass",
        Verdict::Warn => "! warn",
        Verdict::Fail => "✗ fail",
    }
}
