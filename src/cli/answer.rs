//! Where answers, errors and progress go.

use std::io::{ErrorKind, IsTerminal, Write};

use super::exit_code::ExitCode;
use super::threads::Threads;
use crate::error::Error;
use crate::report::{Paint, printable};

/// The two streams of a command and what is known of them.
pub struct Terminal<'a> {
    out: &'a mut dyn Write,
    err: &'a mut dyn Write,
    /// Why an answer did not arrive.
    undelivered: Option<std::io::Error>,
    /// Whether answers may carry colours.
    pub(super) paint: Paint,
    /// Whether progress is shown.
    pub(super) progress: Progress,
    /// Whether the streams are those of a process of `supel`, which can start another one.
    pub(super) program: Program,
}

/// Whether the process was given an stdout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stdout {
    /// It was, or the system does not say.
    Open,
    /// It was not: what is written there is lost.
    Closed,
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
        let (paint, progress, program) = (Paint::Plain, Progress::Hidden, Program::Other);
        Self { out, err, undelivered: None, paint, progress, program }
    }

    /// The streams of the process: colour and progress where a person looks on and `NO_COLOR` is not set.
    pub fn of_process(out: &'a mut dyn Write, err: &'a mut dyn Write) -> Self {
        let is_colour_refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let is_colourful = std::io::stdout().is_terminal() && !is_colour_refused;
        let paint = if is_colourful { Paint::Colour } else { Paint::Plain };
        let progress = if std::io::stderr().is_terminal() { Progress::Shown } else { Progress::Hidden };
        Self { out, err, undelivered: None, paint, progress, program: Program::Supel }
    }

    /// Writes to stdout; whether it arrives decides [`Terminal::close`].
    pub(super) fn answer(&mut self, text: &str) {
        if let Err(error) = self.out.write_all(text.as_bytes()).and_then(|()| self.out.flush()) {
            self.undelivered.get_or_insert(error);
        }
    }

    /// Writes a line to stderr. A failure of that is ignored: there is no place left to report it.
    pub(super) fn complain(&mut self, line: &str) {
        let _ = writeln!(self.err, "{}", printable(line));
    }

    /// Writes lines to stderr that are several on purpose.
    pub(super) fn complain_at_length(&mut self, lines: &str) {
        lines.lines().for_each(|line| self.complain(line));
    }

    /// Says that fewer threads work than were asked for.
    pub(super) fn tell_threads(&mut self, threads: Threads) {
        let Threads { asked, used } = threads;
        if used < asked {
            self.complain(&format!(
                "supel: {used} threads work, not {asked}: more only wait for each other on this machine"
            ));
        }
    }

    /// The exit code of a command that ended with `code`: another one where its answer did not arrive. A reader that has gone away
    /// (`supel … | head`) needs no answer.
    pub(super) fn close(&mut self, code: ExitCode) -> ExitCode {
        let came_to_an_answer = matches!(code, ExitCode::Done | ExitCode::CheckFailed);
        match self.undelivered.take() {
            Some(source) if came_to_an_answer && source.kind() != ErrorKind::BrokenPipe => {
                let error = Error::Answer { source };
                self.complain(&format!("supel: error[{}]: {error}", error.code()));
                ExitCode::from(error.class())
            }
            _ => code,
        }
    }
}
