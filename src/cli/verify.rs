//! `supel verify`: a superelement file checked again, by itself or against the full matrices.

use supel_runtime::{Superelement, file_bytes};

use super::answer::{Program, Terminal};
use super::command::{Answer, Strictness, VerifyCommand};
use super::exit_code::ExitCode;
use super::progress::StageLine;
use super::rehearsal::{self, Rehearsed};
use super::unmet::unmet;
use super::{accompanying, memory, process};
use crate::audit;
use crate::error::{Error, Result};
use crate::outcome::Resources;
use crate::report::{Against, VerificationReport};
use crate::verification::check::Verdict;

pub(super) fn run(command: &VerifyCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let failed = |error| Error::of_superelement(&command.file, error);
    let bytes = file_bytes(&command.file).map_err(failed)?;
    let superelement = Superelement::from_bytes(&bytes).map_err(failed)?;
    let resources = Resources { memory_bytes: memory::available_bytes() };
    let rehearsed = match command.job.as_ref().filter(|_| terminal.program == Program::Supel) {
        Some(job) => rehearsal::rehearse(&job.model, resources.allowed(job))?,
        None => Rehearsed::Nothing,
    };
    terminal.tell_threads(command.threads);
    let threads = process::threads(command.threads.used)?;
    let mut stage_line = StageLine::new(terminal.progress);
    let verify = || crate::verify(&superelement, command.job.as_ref(), resources, &mut stage_line);
    let mut audit = threads.install(verify).map_err(|error| rehearsed.judge(error))?;
    drop(stage_line);
    audit.checks.push(audit::rewritten(&superelement, &bytes));
    let digest = superelement.to_bytes().map_err(failed)?.digest;
    audit.checks.extend(accompanying::check(&command.file, &superelement, &digest));
    let report = VerificationReport {
        digest,
        against: if command.job.is_some() { Against::Model } else { Against::File },
        audit,
    };
    match command.answer {
        Answer::Text => terminal.answer(&report.to_text(&superelement, terminal.paint)),
        Answer::Json => terminal.answer(&report.to_json(&superelement)),
        Answer::Nothing => {
            unmet(&report.audit.checks, command.strictness).iter().for_each(|line| terminal.complain(line));
        }
    }
    Ok(match (report.audit.verdict(), command.strictness) {
        (Verdict::Info | Verdict::Pass, _) | (Verdict::Warn, Strictness::Normal) => ExitCode::Done,
        (Verdict::Warn, Strictness::Strict) | (Verdict::Fail, _) => ExitCode::CheckFailed,
    })
}
