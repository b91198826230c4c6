//! `supel reduce`: from a job to its files.

use std::path::{Path, PathBuf};

use supel_runtime::{StagedFile, Superelement, abandoned_parts};

use super::answer::{Program, Terminal};
use super::command::{Answer, ReduceCommand, Strictness, Unverified};
use super::exit_code::ExitCode;
use super::progress::StageLine;
use super::{Pipeline, memory, process, rehearsal};
use crate::error::{Error, Result};
use crate::job::WriteJob;
use crate::outcome::{Outcome, Resources};
use crate::report::{JunitWarnings, Observer, Report, StageClock, html, junit, summary};
use crate::verification::check::{Check, Limits, Verdict};

pub(super) fn run(command: &ReduceCommand, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    refuse_unwritable(&command.job.write)?;
    if terminal.program == Program::Supel {
        rehearsal::rehearse(&command.job.model)?;
    }
    let n_threads = command.n_threads;
    let threads = process::threads(n_threads)?;
    let mut stage_line = StageLine::new(terminal.progress);
    let mut clock = StageClock::new(&mut stage_line);
    let resources = Resources { memory_bytes: memory::available_bytes() };
    let Outcome { superelement, mut report } = threads.install(|| pipeline(&command.job, resources, &mut clock))?;
    clock.stage("write");
    report.run.n_threads = n_threads;
    let (code, superelement) = stage_superelement(command, &superelement, &mut report)?;
    report.run.stages = clock.finish();
    drop(stage_line);
    report.run.peak_memory_bytes = process::peak_memory_bytes();
    report.run.report = Some(command.job.write.report_path());
    write_all(command, &report, superelement)?;
    match command.answer {
        Answer::Text => terminal.answer(&summary(&report, terminal.paint)),
        Answer::Json => terminal.answer(&report.to_json()),
        Answer::Nothing => {}
    }
    explain(command, code, terminal);
    Ok(code)
}

/// Refuses an output that has no place before the model is read, with the error that its writing would end in: an empty
/// file is written beside each and dropped.
fn refuse_unwritable(write: &WriteJob) -> Result<()> {
    let report = write.report_path();
    let others = [Some(&report), write.html.as_ref(), write.junit.as_ref()];
    std::iter::once(&write.superelement)
        .chain(others.into_iter().flatten())
        .try_for_each(|path| StagedFile::write(path, &[]).map(drop).map_err(|error| Error::from_file(path, error)))
}

/// Writes the superelement under a temporary name and reads it back; hands it on if it may have its name.
fn stage_superelement(
    command: &ReduceCommand,
    superelement: &Superelement,
    report: &mut Report,
) -> Result<(ExitCode, Option<StagedFile>)> {
    let path = command.job.write.superelement.as_path();
    let failed = |error| Error::from_file(path, error);
    let sealed = superelement.to_bytes().map_err(failed)?;
    let staged = StagedFile::write(path, &sealed.bytes).map_err(failed)?;
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

/// Writes everything under temporary names before anything gets its own: a report that cannot be written leaves no
/// superelement without one. The superelement comes last, because others wait for it.
fn write_all(command: &ReduceCommand, report: &Report, superelement: Option<StagedFile>) -> Result<()> {
    let write = &command.job.write;
    let warnings = match command.strictness {
        Strictness::Normal => JunitWarnings::Pass,
        Strictness::Strict => JunitWarnings::Fail,
    };
    let mut files = vec![(write.report_path(), report.to_json())];
    files.extend(write.html.clone().map(|path| (path, html(report))));
    files.extend(write.junit.clone().map(|path| (path, junit(report, warnings))));
    let stage = |(path, text): (PathBuf, String)| match StagedFile::write(&path, text.as_bytes()) {
        Ok(staged) => Ok((path, staged)),
        Err(source) => Err(Error::from_file(&path, source)),
    };
    let mut staged: Vec<(PathBuf, StagedFile)> = files.into_iter().map(stage).collect::<Result<_>>()?;
    staged.extend(superelement.map(|file| (write.superelement.clone(), file)));
    staged.into_iter().try_for_each(|(path, file)| file.commit().map_err(|source| Error::from_file(&path, source)))
}

/// M-26: the written file, read back, is the superelement in memory to the last bit.
fn file_check(written: &Path, superelement: &Superelement) -> Check {
    let difference = match Superelement::open(written) {
        Ok(read) if read == *superelement => None,
        Ok(_) => Some("its content differs from what was computed".to_owned()),
        Err(error) => Some(error.to_string()),
    };
    Check {
        id: "M-26",
        name: "file read back",
        equation: "1 where the written file is not the superelement, else 0",
        value: if difference.is_some() { 1.0 } else { 0.0 },
        limits: Limits::default(),
        fail_above: 0.0,
        worst: difference,
    }
}

/// What the exit code and the folder do not say by themselves.
fn explain(command: &ReduceCommand, code: ExitCode, terminal: &mut Terminal<'_>) {
    let path = command.job.write.superelement.as_path();
    if code == ExitCode::CheckFailed && command.unverified == Unverified::Refused {
        let cause = match command.strictness {
            Strictness::Normal => "a check failed",
            Strictness::Strict => "a check failed or warned, with --strict",
        };
        let earlier = if path.exists() { "; the file of that name is from an earlier run" } else { "" };
        let advice = "see the report, or write it anyway with --allow-unverified";
        terminal.complain(&format!("supel: {}: not written: {cause}{earlier} – {advice}", path.display()));
    }
    for part in abandoned_parts(path) {
        terminal.complain(&format!("supel: {}: left by an interrupted run – it can be removed", part.display()));
    }
}
