//! `supel reduce`: from a job to its files.

use std::path::{Path, PathBuf};

use supel_runtime::{StagedFile, Superelement};

use super::answer::{Program, Terminal};
use super::cache_choice::CacheChoice;
use super::exit_code::ExitCode;
use super::judging::{Answer, Strictness};
use super::outputs::{Outputs, abandoned, refuse_unwritable, staged};
use super::overwriting::OwnFiles;
use super::pipeline::Pipeline;
use super::progress::StageLine;
use super::reduce_command::ReduceCommand;
use super::rehearsal::{self, Rehearsed};
use super::unmet::unmet;
use super::unverified::Unverified;
use super::up_to_date::{self, MadeEarlier, Repetition, Stale};
use super::{memory, overwriting, process};
use crate::audit::flaw;
use crate::cache::Cache;
use crate::error::{Error, Result};
use crate::memory_forecast::Resources;
use crate::outcome::Outcome;
use crate::report::{Observer, Report, StageClock, html, junit, summary};
use crate::verification::check::{Check, Verdict};

pub(super) fn run(command: &ReduceCommand, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let own = own_files(command)?;
    if command.answer != Answer::Nothing {
        command.remarks.iter().for_each(|remark| terminal.complain(remark));
    }
    let threads = process::threads(command.threads.used)?;
    match threads.install(|| made_earlier(command)) {
        Ok(made) => return answer_up_to_date(&made, command.answer, terminal),
        Err(Stale::Because(reason)) if command.answer != Answer::Nothing => {
            let path = command.job.write.superelement.display();
            terminal.complain(&format!("supel: {path}: not up to date: {reason}"));
        }
        Err(_) => {}
    }
    let mut complaints = abandoned(&own);
    refuse_unwritable(&own)?;
    if command.available_bytes.is_some() && terminal.program == Program::Supel {
        process::end_with_parent()?;
    }
    let cache = command.cache.as_ref().map(CacheChoice::open).transpose()?;
    let memory_bytes = command.available_bytes.or_else(memory::available_bytes);
    let resources = Resources { memory_bytes, cache: cache.as_ref() };
    let rehearsed = match terminal.program {
        Program::Supel => rehearsal::rehearse(&command.job, &[], resources.allowed(&command.job))?,
        Program::Other => Rehearsed::Nothing,
    };
    if command.answer != Answer::Nothing {
        terminal.tell_threads(command.threads);
    }
    let mut stage_line = StageLine::new(terminal.progress);
    let mut clock = StageClock::new(&mut stage_line);
    let outcome = threads.install(|| (pipeline.reduce)(&command.job, resources, &mut clock));
    let of_cache = cache_complaints(command, cache.as_ref());
    let Outcome { superelement, mut report } = match outcome {
        Ok(outcome) => outcome,
        Err(error) => {
            drop(stage_line);
            of_cache.iter().for_each(|complaint| terminal.complain(complaint));
            return Err(rehearsed.judge(error));
        }
    };
    clock.stage("write");
    report.run.n_threads = command.threads.used;
    report.run.reservations = command.strictness.reservations();
    report.run.cache = cache.as_ref().map(Cache::tally);
    let (code, superelement) = stage_superelement((command, &own), &superelement, &mut report)?;
    report.run.stages = clock.finish();
    drop(stage_line);
    report.run.peak_memory_bytes = process::peak_memory_bytes();
    report.run.report = Some(command.job.write.report_path());
    let outputs = stage_all((command, &own), &report, superelement)?;
    // The answer is composed before the files are written: a lack of memory afterwards would be reported of a run that is done.
    let answer = composed(command.answer, &report, terminal)?;
    complaints.extend(of_cache);
    complaints.splice(0..0, explanation(command, code));
    if command.answer == Answer::Nothing {
        complaints.splice(0..0, unmet(&report.body.checks, &report.body.warnings, command.strictness));
    }
    outputs.commit()?;
    answer.iter().for_each(|answer| terminal.answer(answer));
    complaints.iter().for_each(|complaint| terminal.complain(complaint));
    Ok(code)
}

/// What is said of a run that is done; nothing where that was asked for.
fn composed(answer: Answer, report: &Report, terminal: &Terminal<'_>) -> Result<Option<String>> {
    Ok(match answer {
        Answer::Text => Some(summary(report, terminal.paint)),
        Answer::Json => Some(report.to_json()?),
        Answer::Nothing => None,
    })
}

/// What went wrong with the cache of the run, which is no error.
fn cache_complaints(command: &ReduceCommand, cache: Option<&Cache>) -> Vec<String> {
    match (&command.cache, cache) {
        (Some(choice), Some(cache)) if command.answer != Answer::Nothing => choice.complaints(&cache.tally()),
        _ => Vec::new(),
    }
}

/// What the run writes. A cache that is an input or an output of it is refused.
fn own_files(command: &ReduceCommand) -> Result<OwnFiles> {
    let inputs = overwriting::inputs(&command.job, command.document.as_deref());
    let mut outputs = overwriting::outputs(&command.job.write);
    let own = OwnFiles::of(&inputs, &outputs)?;
    if let Some(choice) = &command.cache {
        outputs.push((choice.key, choice.folder.clone()));
        OwnFiles::of(&inputs, &outputs)?;
    }
    Ok(own)
}

/// What the job asks for, where an earlier run has made all of it and nothing has changed since.
fn made_earlier(command: &ReduceCommand) -> Result<MadeEarlier, Stale> {
    match command.repetition {
        Repetition::Skipped => up_to_date::made_earlier(&command.job, command.strictness),
        Repetition::Forced => Err(Stale::NotMade),
    }
}

/// Answers a run that has nothing to do. Only what was verified is up to date.
fn answer_up_to_date(made: &MadeEarlier, answer: Answer, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    match answer {
        Answer::Text => terminal.answer(&made.to_text()),
        Answer::Json => terminal.answer(&made.to_json()?),
        Answer::Nothing => {}
    }
    Ok(ExitCode::Done)
}

/// Writes the superelement under a temporary name and reads it back; hands it on if it may have its name.
fn stage_superelement(
    (command, own): (&ReduceCommand, &OwnFiles),
    superelement: &Superelement,
    report: &mut Report,
) -> Result<(ExitCode, Option<StagedFile>)> {
    let path = command.job.write.superelement.as_path();
    let sealed = superelement.to_bytes().map_err(|error| Error::of_superelement(path, error))?;
    let staged = staged(own, path, &sealed.bytes)?;
    report.body.checks.push(file_check(staged.path(), superelement));
    let is_verified = match (report.body.verdict(), command.strictness) {
        (Verdict::Info | Verdict::Pass, _) | (Verdict::Warn, Strictness::Normal) => true,
        (Verdict::Warn, Strictness::Strict) | (Verdict::Fail, _) => false,
    };
    let is_kept = is_verified || command.unverified == Unverified::Written;
    if is_kept {
        report.run.superelement = Some(path.to_owned());
        report.run.file_bytes = Some(sealed.bytes.len() as u64);
        report.run.file_digest = Some(sealed.digest);
    }
    Ok((if is_verified { ExitCode::Done } else { ExitCode::CheckFailed }, is_kept.then_some(staged)))
}

/// Writes everything else under temporary names before anything gets its own: a report that cannot be written leaves no
/// superelement without one. The superelement comes last, because others wait for it and all others carry its digest.
fn stage_all<'a>(
    (command, own): (&ReduceCommand, &'a OwnFiles),
    report: &Report,
    superelement: Option<StagedFile>,
) -> Result<Outputs<'a>> {
    let write = &command.job.write;
    let mut files: Vec<(PathBuf, String)> = vec![(write.report_path(), report.to_json()?)];
    files.extend(write.html.clone().map(|path| (path, html(report))));
    files.extend(write.junit.clone().map(|path| (path, junit(report))));
    let mut outputs = Outputs::new(own);
    files.iter().try_for_each(|(path, text)| outputs.stage(path, text.as_bytes()))?;
    superelement.into_iter().for_each(|file| outputs.push(file));
    Ok(outputs)
}

/// M-26: the written file, read back, is the superelement in memory to the last bit.
fn file_check(written: &Path, superelement: &Superelement) -> Check {
    let difference = match Superelement::open(written) {
        Ok(read) if read == *superelement => None,
        Ok(_) => Some("its content differs from what was computed".to_owned()),
        Err(error) => Some(error.to_string()),
    };
    flaw("file read back", "1 where the written file is not the superelement, else 0", difference.as_slice())
}

/// What the exit code and the folder do not say by themselves.
fn explanation(command: &ReduceCommand, code: ExitCode) -> Option<String> {
    if code != ExitCode::CheckFailed || command.unverified == Unverified::Written {
        return None;
    }
    let path = command.job.write.superelement.as_path();
    let cause = match command.strictness {
        Strictness::Normal => "a check failed",
        Strictness::Strict => "a check failed or warned, with --strict",
    };
    let earlier = if path.exists() { "; the file of that name is from an earlier run" } else { "" };
    let advice = "see the report, or write it anyway with --allow-unverified";
    Some(format!("supel: {}: not written: {cause}{earlier} – {advice}", path.display()))
}
