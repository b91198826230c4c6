//! The command line: what was typed becomes a checked command, the command runs, and one place reports errors.
//!
//! Answers go to stdout, as text or as one JSON document; with `--json` an error is a JSON document too. Errors go to
//! stderr, and so does progress on a terminal. The exit code is a contract, see [`ExitCode`].
//!
//! An interrupt (Ctrl-C) ends the process by the signal itself, which shells and make report as 130. Outputs get
//! their names only when they are complete; before that a handler removes them. While outputs are being renamed, the
//! signal waits.
//!
//! An answer that cannot be written to stdout is an error. A reader that has closed its end of the pipe is not.

mod accompanying;
mod admission;
mod all;
mod all_command;
mod answer;
mod assembled;
mod assembly_command;
mod assembly_file;
mod cache_choice;
mod calibration;
mod certify;
mod certify_command;
mod codes;
mod command;
mod convert;
mod convert_command;
mod convert_mesh;
mod doctor;
mod exit_code;
mod explain;
mod export;
mod export_command;
mod flag_values;
mod flags;
mod init;
mod inspect;
mod job_document;
mod job_folder;
mod job_process;
mod judging;
mod memory;
mod modes;
mod modes_command;
mod outputs;
mod overwriting;
mod pipeline;
mod plan;
mod plan_command;
mod process;
mod progress;
mod recipe;
mod recipes;
mod recover;
mod recover_command;
mod reduce;
mod reduce_command;
mod refusal;
mod rehearsal;
mod remaining;
mod selection_flags;
mod signals;
mod subject_command;
mod subject_flags;
mod superelement_flags;
mod text_flags;
mod threads;
mod unmet;
mod unverified;
mod up_to_date;
mod verify;

use std::ffi::OsString;
use std::io::{Error as IoError, ErrorKind, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};

use clap::Parser;

use crate::error::Result;
use crate::heap;
use crate::report::printable;

use command::Command;
use refusal::{Form, Refusal};

pub use answer::{Stdout, Terminal};
pub use assembly_file::AssemblyFile;
pub use calibration::rates;
pub use exit_code::ExitCode;
pub use pipeline::{Calibration, Certify, Examine, Foresee, Measure, Pipeline, Reduce, Verify};

/// Runs one command line, `args` with the program's name first, and says how it went.
///
/// A panic anywhere below is caught and reported as a defect of the program.
pub fn run<I>(args: I, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> ExitCode
where
    I: IntoIterator<Item = OsString>,
{
    let args: Vec<OsString> = args.into_iter().collect();
    // Known before the rest is: a command line that cannot be read is answered in the form it asks for.
    let form = if args.iter().any(|arg| arg == "--json") { Form::Json } else { Form::Text };
    heap::promise(if form == Form::Json { heap::Document::Json } else { heap::Document::None });
    let code = answered(args, form, pipeline, terminal);
    terminal.close(code)
}

fn answered(args: Vec<OsString>, form: Form, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> ExitCode {
    let flags = match flags::CommandLine::try_parse_from(&args) {
        Ok(flags) => flags,
        Err(error) if error.use_stderr() => return Refusal::usage(&quoting_safely(error, &args)).tell(form, terminal),
        // Help and version are answers.
        Err(error) => {
            terminal.answer(&error.render().to_string());
            return ExitCode::Done;
        }
    };
    match catch_unwind(AssertUnwindSafe(|| execute(flags, pipeline, terminal))) {
        Ok(Ok(code)) => code,
        Ok(Err(error)) => Refusal::of(&error).tell(form, terminal),
        Err(_) => Refusal::defect().tell(form, terminal),
    }
}

/// What clap says of a command line it cannot read, about the same words written out: it quotes them, where a line end would begin a line of
/// its own and an escape sequence would be left out.
fn quoting_safely(error: clap::Error, args: &[OsString]) -> clap::Error {
    let written_out = args.iter().map(|arg| printable(&arg.to_string_lossy()).into_owned());
    // Words that can be read once they are written out have nothing that clap quotes: they were not UTF-8.
    flags::CommandLine::try_parse_from(written_out).err().unwrap_or(error)
}

fn execute(flags: flags::CommandLine, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    match Command::build(flags)? {
        Command::Reduce(command) => reduce::run(&command, pipeline, terminal),
        Command::ReduceAll(command) => all::run(&command, (pipeline, run::<Vec<OsString>>), terminal),
        Command::Plan(command) => plan::run(&command, pipeline, terminal),
        Command::Verify(command) => verify::run(&command, pipeline, terminal),
        Command::Inspect(command) => inspect::run(&command, terminal),
        Command::Doctor(command) => doctor::run(&command, pipeline, terminal),
        Command::Init(command) => init::run(&command, pipeline, terminal),
        Command::Certify(command) => certify::run(&command, pipeline, terminal),
        Command::Modes(command) => modes::run(&command, terminal),
        Command::Export(command) => export::run(&command, terminal),
        Command::Recover(command) => recover::run(&command, terminal),
        Command::Convert(command) => convert::run(&command, terminal),
        Command::Explain(flags) => explain::run(&flags, terminal),
        Command::Recipe(flags) => recipe::run(&flags, terminal),
        Command::RehearseReading => rehearsal::read_from_stdin(),
    }
}

/// A command line run against the real streams; what `main` calls.
pub fn main(pipeline: Pipeline, stdout: Stdout) -> std::process::ExitCode {
    signals::ignore_file_size_limit();
    signals::leave_nothing_unfinished();
    let (mut open, mut closed, mut err) = (std::io::stdout().lock(), Closed, std::io::stderr());
    let out: &mut dyn Write = if stdout == Stdout::Closed { &mut closed } else { &mut open };
    let code = run(std::env::args_os(), pipeline, &mut Terminal::of_process(out, &mut err));
    std::process::ExitCode::from(code as u8)
}

/// An stdout that was closed before the program started.
struct Closed;

impl Write for Closed {
    fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
        Err(IoError::new(ErrorKind::NotConnected, "it is closed"))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}
