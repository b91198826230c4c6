//! A page of text for people: headings, labelled entries, tables, with or without colour.
//!
//! A line is made of spans, whose text may be anybody's: what would act on the terminal is written out here, and only the colours of
//! this module act.

use super::printable;
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

/// A piece of a line, in one tone.
pub(crate) struct Span {
    text: String,
    tone: Option<Tone>,
}

impl<T: AsRef<str> + ?Sized> From<&T> for Span {
    fn from(text: &T) -> Self {
        Self { text: text.as_ref().to_owned(), tone: None }
    }
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

    pub(crate) fn line(&mut self, span: impl Into<Span>) {
        self.spans(&[span.into()]);
    }

    /// A line of several spans, without blanks at its end.
    pub(crate) fn spans(&mut self, spans: &[Span]) {
        let is_blank = |span: &Span| span.text.trim_end().is_empty();
        let n_shown = spans.iter().rposition(|span| !is_blank(span)).map_or(0, |last| last + 1);
        for (place, span) in spans[..n_shown].iter().enumerate() {
            let is_last = place + 1 == n_shown;
            let text = printable(if is_last && span.tone.is_none() { span.text.trim_end() } else { &span.text });
            match (span.tone, self.paint) {
                (Some(tone), Paint::Colour) => self.text.push_str(&format!("\x1b[{}m{text}\x1b[0m", tone.code())),
                _ => self.text.push_str(if is_last { text.trim_end() } else { &text }),
            }
        }
        self.text.push('\n');
    }

    pub(crate) fn heading(&mut self, text: &str) {
        self.line("");
        self.line(Self::toned(text, Tone::Heading));
    }

    /// A label and its value, which continues below itself where it is long.
    pub(crate) fn entry(&mut self, label: &str, value: &str) {
        let label = table::shorten(label, LABEL);
        for (line_idx, line) in table::wrap(value, WIDTH - LABEL - 4).iter().enumerate() {
            let label = if line_idx == 0 { label.as_str() } else { "" };
            let label = Self::toned(&table::pad(label, LABEL, Align::Left), Tone::Faint);
            self.spans(&["  ".into(), label, "  ".into(), line.into()]);
        }
    }

    pub(crate) fn toned(text: &str, tone: Tone) -> Span {
        Span { text: text.to_owned(), tone: Some(tone) }
    }
}

impl Tone {
    /// The parameters of the terminal's sequence.
    fn code(self) -> &'static str {
        match self {
            Self::Heading => "1",
            Self::Faint => "2",
            Self::Of(Verdict::Info) => "36",
            Self::Of(Verdict::Pass) => "32",
            Self::Of(Verdict::Warn) => "33",
            Self::Of(Verdict::Fail) => "1;31",
        }
    }
}

/// The sign and the name of a verdict.
pub(crate) fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Info => "· shown",
        Verdict::Pass => "✓ pass",
        Verdict::Warn => "! warn",
        Verdict::Fail => "✗ fail",
    }
}
