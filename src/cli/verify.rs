//! `supel verify`: a superelement file checked again, by itself, against the full matrices, or made again.

use std::path::Path;

use supel_runtime::Superelement;

use super::answer::{Program, Terminal};
use super::command::{Rerun, VerifyCommand};
use super::exit_code::ExitCode;
use super::judging::{Answer, Strictness};
use super::pipeline::Pipeline;
use super::progress::StageLine;
use super::rehearsal::{self, Rehearsed};
use super::unmet::unmet;
use super::{accompanying, memory, process};
use crate::audit::{self, Audit};
use crate::error::{Error, Result};
use crate::input;
use crate::job::{Holder, Job};
use crate::memory_forecast::Resources;
use crate::report::{Against, Reproduction, VerificationReport};
use crate::verification::check::Verdict;

pub(super) fn run(command: &VerifyCommand, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let (superelement, bytes) = input::superelement(&command.file)?;
    let rerun = match command.rerun {
        Rerun::No => None,
        Rerun::Compared => Some(job_to_run(command, &superelement)?),
    };
    let (rerun, remark) = rerun.map_or((None, None), |(job, remark)| (Some(job), remark));
    let resources = Resources { memory_bytes: memory::available_bytes(), cache: None };
    let to_read = command.job.as_ref().or(rerun.as_ref());
    let rehearsed = match to_read.filter(|_| terminal.program == Program::Supel) {
        Some(job) => rehearsal::rehearse(job, &[], resources.allowed(job))?,
        None => Rehearsed::Nothing,
    };
    if command.answer != Answer::Nothing {
        remark.iter().chain(&command.remark).for_each(|remark| terminal.complain(remark));
        terminal.tell_threads(command.threads);
    }
    let threads = process::threads(command.threads.used)?;
    let mut stage_line = StageLine::new(terminal.progress);
    // The job that is run again stays as it is: the superelement has it in its bytes.
    let compared = command.job.clone().map(|job| command.strictness.reading(job));
    let verify = || (pipeline.verify)(&superelement, compared.as_ref(), resources, &mut stage_line);
    let mut audit = threads.install(verify).map_err(|error| rehearsed.judge(error))?;
    audit.checks.push(audit::rewritten(&superelement, &bytes));
    let digest = superelement.to_bytes().map_err(|error| Error::of_superelement(&command.file, error))?.digest;
    audit.checks.extend(accompanying::check(&command.file, &superelement, &digest));
    if let Some(job) = &rerun {
        let again = threads.install(|| (pipeline.reduce)(job, resources, &mut stage_line))?.superelement;
        audit = reproduced(audit, &superelement, (&again, job))?;
    }
    drop(stage_line);
    let report = VerificationReport {
        digest,
        against: if command.job.is_some() { Against::Model } else { Against::File },
        reproduction: if rerun.is_some() { Reproduction::Compared } else { Reproduction::None },
        audit,
    };
    match command.answer {
        Answer::Text => {
            terminal.answer(&report.to_text(&superelement, command.strictness.reservations(), terminal.paint))
        }
        Answer::Json => terminal.answer(&report.to_json(&superelement)?),
        Answer::Nothing => {
            unmet(&report.audit.checks, &[], command.strictness).iter().for_each(|line| terminal.complain(line));
        }
    }
    Ok(match (report.audit.verdict(), command.strictness) {
        (Verdict::Info | Verdict::Pass, _) | (Verdict::Warn, Strictness::Normal) => ExitCode::Done,
        (Verdict::Warn, Strictness::Strict) | (Verdict::Fail, _) => ExitCode::CheckFailed,
    })
}

/// The job that is run again: the one given, or the one kept in the file with what is to be said of its paths.
fn job_to_run(command: &VerifyCommand, superelement: &Superelement) -> Result<(Job, Option<String>)> {
    if !audit::is_of_this_version(superelement) {
        let generator = &superelement.metadata().generator;
        let found = format!("{} {}", generator.name, generator.version);
        return Err(Error::OtherVersion { path: command.file.clone(), found });
    }
    if let Some(parts) = superelement.metadata().generator.parts_of_earlier_runs {
        return Err(Error::MadeOfParts { path: command.file.clone(), parts: parts.get() as usize });
    }
    if let Some(job) = &command.job {
        return Ok((job.clone(), None));
    }
    job_of_file(superelement, &command.file)
}

/// The job kept in the file at `path`, with its paths absolute, and what is to be said of the folder from which they count.
///
/// # Errors
/// [`Error::KeptJob`] where it is none of this version; those of [`Job::validate`] and [`Job::located`].
pub(super) fn job_of_file(superelement: &Superelement, path: &Path) -> Result<(Job, Option<String>)> {
    let kept = audit::kept_job(superelement).ok_or_else(|| Error::KeptJob { path: path.to_owned() })?;
    kept.validate()?;
    kept.located(path, Holder::Superelement)
}

/// An audit with what running the job again has shown: where the bytes are the same, it vouches for every field but the job
/// itself, whose paths were not compared.
fn reproduced(audit: Audit, superelement: &Superelement, (again, job): (&Superelement, &Job)) -> Result<Audit> {
    let check = audit::reproduced(superelement, again, job)?;
    let is_same = check.verdict() == Verdict::Pass;
    let Audit { mut checks, mut unvouched, notes } = audit;
    unvouched.retain(|unvouched| !is_same || unvouched.field == "job");
    checks.push(check);
    Ok(Audit { checks, notes, unvouched })
}
