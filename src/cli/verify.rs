//! `supel verify`: a superelement file checked again, by itself, against the full matrices, or made again.

use std::path::Path;

use supel_runtime::{FileError, Superelement};

use super::answer::{Program, Terminal};
use super::command::{Answer, Rerun, Strictness, VerifyCommand};
use super::exit_code::ExitCode;
use super::progress::StageLine;
use super::{Pipeline, memory, process, rehearsal};
use crate::audit::{self, Audit};
use crate::error::{Error, Result};
use crate::job::Job;
use crate::outcome::Resources;
use crate::report::{Against, Reproduction, VerificationReport};
use crate::verification::check::Verdict;

pub(super) fn run(command: &VerifyCommand, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let failed = |error| Error::from_file(&command.file, error);
    let superelement = Superelement::open(&command.file).map_err(failed)?;
    let bytes = std::fs::read(&command.file)
        .map_err(|source| failed(FileError::Read { path: command.file.clone(), source }))?;
    let rerun = match command.rerun {
        Rerun::No => None,
        Rerun::Compared => Some(job_to_run(command, &superelement)?),
    };
    if let Some(job) = command.job.as_ref().or(rerun.as_ref()).filter(|_| terminal.program == Program::Supel) {
        rehearsal::rehearse(&job.model)?;
    }
    let threads = process::threads(command.n_threads)?;
    let mut stage_line = StageLine::new(terminal.progress);
    let mut audit = threads.install(|| crate::verify(&superelement, command.job.as_ref(), &mut stage_line))?;
    audit.checks.push(audit::rewritten(&superelement, &bytes));
    if let Some(job) = &rerun {
        let resources = Resources { memory_bytes: memory::available_bytes() };
        let again = threads.install(|| pipeline(job, resources, &mut stage_line))?.superelement;
        audit = reproduced(audit, &superelement, (&again, job));
    }
    drop(stage_line);
    let report = VerificationReport {
        digest: superelement.to_bytes().map_err(failed)?.digest,
        against: if command.job.is_some() { Against::Model } else { Against::File },
        reproduction: if rerun.is_some() { Reproduction::Compared } else { Reproduction::None },
        audit,
    };
    match command.answer {
        Answer::Text => terminal.answer(&report.to_text(&superelement, terminal.paint)),
        Answer::Json => terminal.answer(&report.to_json(&superelement)),
        Answer::Nothing => {}
    }
    Ok(match (report.audit.verdict(), command.strictness) {
        (Verdict::Info | Verdict::Pass, _) | (Verdict::Warn, Strictness::Normal) => ExitCode::Done,
        (Verdict::Warn, Strictness::Strict) | (Verdict::Fail, _) => ExitCode::CheckFailed,
    })
}

/// The job that is run again: the one given, or the one kept in the file, with its paths relative to the file's folder.
fn job_to_run(command: &VerifyCommand, superelement: &Superelement) -> Result<Job> {
    if !audit::is_of_this_version(superelement) {
        let generator = &superelement.metadata().generator;
        let found = format!("{} {}", generator.name, generator.version);
        return Err(Error::OtherVersion { path: command.file.clone(), found });
    }
    if let Some(job) = &command.job {
        return Ok(job.clone());
    }
    let kept = audit::kept_job(superelement).ok_or_else(|| Error::KeptJob { path: command.file.clone() })?;
    kept.validate()?;
    kept.resolve(command.file.parent().unwrap_or(Path::new("")))
}

/// An audit with what running the job again has shown: where the bytes are the same, it vouches for every field but the job
/// itself, whose paths were not compared.
fn reproduced(audit: Audit, superelement: &Superelement, (again, job): (&Superelement, &Job)) -> Audit {
    let check = audit::reproduced(superelement, again, job);
    let is_same = check.verdict() == Verdict::Pass;
    let Audit { mut checks, mut unvouched, notes } = audit;
    unvouched.retain(|unvouched| !is_same || unvouched.field == "job");
    checks.push(check);
    Audit { checks, notes, unvouched }
}
