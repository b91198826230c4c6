//! `supel verify`: a superelement file checked again, by itself or against the full matrices.

use supel_runtime::{FileError, Superelement};

use super::answer::{Program, Terminal};
use super::command::{Answer, Strictness, VerifyCommand};
use super::exit_code::ExitCode;
use super::progress::StageLine;
use super::{process, rehearsal};
use crate::audit;
use crate::error::{Error, Result};
use crate::report::{Against, VerificationReport};
use crate::verification::check::Verdict;

pub(super) fn run(command: &VerifyCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let failed = |error| Error::from_file(&command.file, error);
    let superelement = Superelement::open(&command.file).map_err(failed)?;
    let bytes = std::fs::read(&command.file)
        .map_err(|source| failed(FileError::Read { path: command.file.clone(), source }))?;
    if let Some(job) = command.job.as_ref().filter(|_| terminal.program == Program::Supel) {
        rehearsal::rehearse(&job.model)?;
    }
    let threads = process::threads(command.n_threads)?;
    let mut stage_line = StageLine::new(terminal.progress);
    let mut audit = threads.install(|| crate::verify(&superelement, command.job.as_ref(), &mut stage_line))?;
    drop(stage_line);
    audit.checks.push(audit::rewritten(&superelement, &bytes));
    let report = VerificationReport {
        digest: superelement.to_bytes().map_err(failed)?.digest,
        against: if command.job.is_some() { Against::Model } else { Against::File },
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
