//! The command line: what was typed becomes a checked command, the command runs, and one place reports errors.
//!
//! stdout carries the answer, text or one JSON document; stderr carries errors and, on a terminal, progress. The exit
//! code is a contract, see [`ExitCode`].
//!
//! An interrupt (Ctrl-C) ends the process by the signal itself, which shells and make report as 130: outputs get
//! their names only when they are whole, so that no handler has anything to undo.

mod answer;
mod command;
mod exit_code;
mod flags;
mod inspect;
mod memory;
mod process;
mod progress;
mod reduce;
mod rehearsal;

use std::error::Error as _;
use std::ffi::OsString;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};

use clap::Parser;

use crate::error::{Error, Result};
use crate::job::Job;
use crate::outcome::{Outcome, Resources};
use crate::report::Observer;

use command::Command;

pub use answer::Terminal;
pub use exit_code::ExitCode;

/// The function that turns a job into a superelement and its report.
pub type Pipeline = fn(&Job, Resources, &mut dyn Observer) -> Result<Outcome>;

/// Runs one command line, `args` with the program's name first, and says how it went.
///
/// A panic anywhere below is caught and reported as a defect of the program.
pub fn run<I>(args: I, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> ExitCode
where
    I: IntoIterator<Item = OsString>,
{
    let flags = match flags::CommandLine::try_parse_from(args) {
        Ok(flags) => flags,
        Err(error) => return refuse(&error, terminal),
    };
    match catch_unwind(AssertUnwindSafe(|| execute(flags, pipeline, terminal))) {
        Ok(Ok(code)) => code,
        Ok(Err(error)) => {
            complain(&error, terminal);
            ExitCode::from(error.class())
        }
        Err(_) => {
            terminal
                .complain("supel: internal error: this is a defect of supel, please report it with the lines above");
            ExitCode::InternalError
        }
    }
}

fn execute(flags: flags::CommandLine, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    match Command::build(flags)? {
        Command::Reduce(command) => reduce::run(&command, pipeline, terminal),
        Command::Inspect(command) => inspect::run(&command, terminal),
        Command::RehearseReading => rehearsal::read_from_stdin().map(|()| ExitCode::Done),
    }
}

/// What clap says of a command line it cannot read; help and version are answers, not errors.
fn refuse(error: &clap::Error, terminal: &mut Terminal<'_>) -> ExitCode {
    if error.use_stderr() {
        let text = error.render().to_string();
        let text = text.strip_prefix("error: ").unwrap_or(&text);
        terminal.complain(&format!("supel: error: {}", text.trim_end()));
        ExitCode::Usage
    } else {
        terminal.answer(&error.render().to_string());
        ExitCode::Done
    }
}

/// The error with its causes, each on a line of its own unless the line before has quoted it.
fn complain(error: &Error, terminal: &mut Terminal<'_>) {
    let mut said = error.to_string();
    terminal.complain(&format!("supel: error: {said}"));
    let mut cause = error.source();
    while let Some(deeper) = cause {
        let text = deeper.to_string();
        if !said.contains(&text) {
            terminal.complain(&format!("  caused by: {text}"));
            said = text;
        }
        cause = deeper.source();
    }
}

/// A command line run against the real streams; what `main` calls.
pub fn main(pipeline: Pipeline) -> std::process::ExitCode {
    let (mut out, mut err) = (std::io::stdout().lock(), std::io::stderr());
    let code = run(std::env::args_os(), pipeline, &mut Terminal::of_process(&mut out, &mut err));
    // A reader that has gone away needs no answer, and nobody is left to be told.
    let _ = out.flush();
    std::process::ExitCode::from(code as u8)
}
