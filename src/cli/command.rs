//! Checked commands, built from what was typed.

use std::path::PathBuf;

use super::all_command::AllCommand;
use super::certify_command::CertifyCommand;
use super::convert_command::ConvertCommand;
use super::doctor::DoctorCommand;
use super::export_command::ExportCommand;
use super::flags::{CommandLine, Typed};
use super::init::InitCommand;
use super::job_document;
use super::judging::{Answer, Strictness};
use super::modes_command::ModesCommand;
use super::plan_command::PlanCommand;
use super::recover_command::RecoverCommand;
use super::reduce_command::ReduceCommand;
use super::superelement_flags::{InspectFlags, VerifyFlags};
use super::text_flags::{ExplainFlags, RecipeFlags};
use super::threads::Threads;
use crate::error::Result;
use crate::job::Job;

/// One command, ready to run.
#[derive(Debug)]
pub(super) enum Command {
    Reduce(Box<ReduceCommand>),
    ReduceAll(AllCommand),
    Plan(Box<PlanCommand>),
    Verify(Box<VerifyCommand>),
    Inspect(InspectCommand),
    Doctor(Box<DoctorCommand>),
    Init(Box<InitCommand>),
    Certify(Box<CertifyCommand>),
    Modes(ModesCommand),
    Export(ExportCommand),
    Recover(RecoverCommand),
    Convert(ConvertCommand),
    Explain(ExplainFlags),
    Recipe(RecipeFlags),
    /// What a child process does for its parent, see [`super::rehearsal`].
    RehearseReading,
}

/// Check a superelement file again.
#[derive(Debug)]
pub(super) struct VerifyCommand {
    pub(super) file: PathBuf,
    /// The model to compare with: checked, paths absolute.
    pub(super) job: Option<Job>,
    /// What is to be said of the folder from which its paths count.
    pub(super) remark: Option<String>,
    pub(super) rerun: Rerun,
    pub(super) threads: Threads,
    pub(super) answer: Answer,
    pub(super) strictness: Strictness,
}

/// Whether the job of a superelement is run again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rerun {
    No,
    Compared,
}

/// Show a superelement file.
#[derive(Debug)]
pub(super) struct InspectCommand {
    pub(super) file: PathBuf,
    pub(super) answer: InspectAnswer,
}

/// What `supel inspect` prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InspectAnswer {
    Text,
    Json,
    Rubin,
    Coordinates,
    Job,
}

impl Command {
    pub(super) fn build(line: CommandLine) -> Result<Self> {
        match line.command {
            Typed::Reduce(flags) => match &flags.all {
                Some(path) => AllCommand::build(path, &flags.output, &flags.run).map(Self::ReduceAll),
                None => ReduceCommand::build(*flags).map(|command| Self::Reduce(Box::new(command))),
            },
            Typed::Plan(flags) => PlanCommand::build(flags).map(|command| Self::Plan(Box::new(command))),
            Typed::Verify(flags) => build_verify(flags).map(|command| Self::Verify(Box::new(command))),
            Typed::Inspect(flags) => Ok(Self::Inspect(InspectCommand::of(flags))),
            Typed::Init(flags) => InitCommand::build(*flags).map(|command| Self::Init(Box::new(command))),
            Typed::Doctor(flags) => DoctorCommand::build(*flags).map(|command| Self::Doctor(Box::new(command))),
            Typed::Certify(flags) => CertifyCommand::build(*flags).map(|command| Self::Certify(Box::new(command))),
            Typed::Modes(flags) => ModesCommand::build(flags).map(Self::Modes),
            Typed::Export(flags) => ExportCommand::build(flags).map(Self::Export),
            Typed::Recover(flags) => RecoverCommand::build(flags).map(Self::Recover),
            Typed::Convert(flags) => ConvertCommand::build(flags).map(Self::Convert),
            Typed::Explain(flags) => Ok(Self::Explain(flags)),
            Typed::Recipe(flags) => Ok(Self::Recipe(flags)),
            Typed::RehearseReading => Ok(Self::RehearseReading),
        }
    }
}

impl InspectCommand {
    fn of(InspectFlags { file, json, rubin, coordinates, job }: InspectFlags) -> Self {
        let asked = [
            (json, InspectAnswer::Json),
            (rubin, InspectAnswer::Rubin),
            (coordinates, InspectAnswer::Coordinates),
            (job, InspectAnswer::Job),
        ];
        let answer =
            asked.into_iter().find(|(is_asked, _)| *is_asked).map_or(InspectAnswer::Text, |(_, answer)| answer);
        Self { file, answer }
    }
}

fn build_verify(flags: VerifyFlags) -> Result<VerifyCommand> {
    let (job, remark) = flags.job.as_deref().map(job_document::read).transpose()?.unzip();
    Ok(VerifyCommand {
        file: flags.file,
        job,
        remark: remark.flatten(),
        rerun: if flags.reproduce { Rerun::Compared } else { Rerun::No },
        threads: Threads::of(flags.threads),
        answer: Answer::from((flags.json, flags.quiet)),
        strictness: Strictness::from(flags.strict),
    })
}
