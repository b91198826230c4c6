//! `supel modes`: the modes of superelements that are joined, held and loaded at their interfaces.

use supel_runtime::Verdict;

use super::answer::Terminal;
use super::assembled::Files;
use super::exit_code::ExitCode;
use super::modes_command::{ModesAnswer, ModesCommand};
use crate::error::Result;
use crate::report::ModesReport;

pub(super) fn run(command: &ModesCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let mut files = Files::read(&command.assembly)?;
    let digests = std::mem::take(&mut files.digests);
    let has_failed = files.verdicts().any(|verdict| verdict == Verdict::Fail);
    let assembly = files.assembled(&command.assembly)?;
    let modes = assembly.modes(command.wanted)?;
    let report = ModesReport { assembly: &assembly, digests: &digests, modes: &modes };
    match command.answer {
        ModesAnswer::Text => terminal.answer(&report.to_text(terminal.paint)),
        ModesAnswer::Json => terminal.answer(&report.to_json()?),
    }
    Ok(if has_failed { ExitCode::CheckFailed } else { ExitCode::Done })
}
