//! `supel doctor`: what a pair of matrices is, what is wrong with it, and what to do about it.

use super::answer::{Program, Terminal};
use super::exit_code::ExitCode;
use super::pipeline::Pipeline;
use super::progress::StageLine;
use super::rehearsal::{self, Rehearsed};
use super::subject_command::SubjectCommand;
use super::subject_flags::DoctorFlags;
use super::{memory, process};
use crate::error::Result;
use crate::examination::{Examined, N_MODES, Severity};
use crate::memory_forecast::Resources;

/// A pair of matrices to be examined.
#[derive(Debug)]
pub(super) struct DoctorCommand {
    subject: SubjectCommand,
    form: Form,
}

/// What stdout carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Text,
    Json,
}

impl DoctorCommand {
    /// # Errors
    /// Those of [`SubjectCommand::build`].
    pub(super) fn build(flags: DoctorFlags) -> Result<Self> {
        let form = if flags.json { Form::Json } else { Form::Text };
        Ok(Self { subject: SubjectCommand::build(flags.subject, flags.rows, N_MODES)?, form })
    }
}

pub(super) fn run(command: &DoctorCommand, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let examined = examined(&command.subject, pipeline, terminal)?;
    match command.form {
        Form::Text => terminal.answer(&examined.to_text(terminal.paint)),
        Form::Json => terminal.answer(&examined.to_json()?),
    }
    Ok(if examined.severity() == Some(Severity::Error) { ExitCode::CheckFailed } else { ExitCode::Done })
}

/// What is found of a model.
pub(super) fn examined(subject: &SubjectCommand, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<Examined> {
    let SubjectCommand { job, threads } = subject;
    let resources = Resources { memory_bytes: memory::available_bytes(), cache: None };
    let rehearsed = match terminal.program {
        Program::Supel => rehearsal::rehearse(job, &[], resources.allowed(job))?,
        Program::Other => Rehearsed::Nothing,
    };
    terminal.tell_threads(*threads);
    let pool = process::threads(threads.used)?;
    let mut stage_line = StageLine::new(terminal.progress);
    let examined = pool.install(|| (pipeline.examine)(job, (resources, &mut stage_line)));
    examined.map_err(|error| rehearsed.judge(error))
}
