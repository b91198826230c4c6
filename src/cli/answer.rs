//! Where answers, errors and progress go.

use std::io::{IsTerminal, Write};

use crate::report::Paint;

/// The two streams of a command and what is known of them.
pub struct Terminal<'a> {
    out: &'a mut dyn Write,
    err: &'a mut dyn Write,
    /// Whether answers may carry colours.
    pub(super) paint: Paint,
    /// Whether progress is shown.
    pub(super) progress: Progress,
    /// Whether the streams are those of a process of `supel`, which can start another one.
    pub(super) program: Program,
}

/// What runs the command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Program {
    /// The program `supel`.
    Supel,
    /// A program that calls this library.
    Other,
}

/// Whether progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Progress {
    Shown,
    Hidden,
}

impl<'a> Terminal<'a> {
    /// Streams that are no terminal: no colour, no progress.
    pub fn plain(out: &'a mut dyn Write, err: &'a mut dyn Write) -> Self {
        Self { out, err, paint: Paint::Plain, progress: Progress::Hidden, program: Program::Other }
    }

    /// The streams of the process: colour and progress where a person looks on and `NO_COLOR` is not set.
    pub fn of_process(out: &'a mut dyn Write, err: &'a mut dyn Write) -> Self {
        let is_colour_refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let is_colourful = std::io::stdout().is_terminal() && !is_colour_refused;
        let paint = if is_colourful { Paint::Colour } else { Paint::Plain };
        let progress = if std::io::stderr().is_terminal() { Progress::Shown } else { Progress::Hidden };
        Self { out, err, paint, progress, program: Program::Supel }
    }

    /// Writes to stdout. A reader that has gone away (`supel … | head`) is no error: the exit code still tells how
    /// the command went.
    pub(super) fn answer(&mut self, text: &str) {
        let _ = self.out.write_all(text.as_bytes()).and_then(|()| self.out.flush());
    }

    /// Writes a line to stderr; nobody can be told if that fails.
    pub(super) fn complain(&mut self, line: &str) {
        let _ = writeln!(self.err, "{line}");
    }
}
