//! `supel plan`: what a job will do and what it will cost.

use super::answer::{Program, Terminal};
use super::exit_code::ExitCode;
use super::pipeline::Pipeline;
use super::plan_command::{PlanAnswer, PlanCommand};
use super::progress::StageLine;
use super::rehearsal::{self, Rehearsed};
use super::{memory, process};
use crate::error::Result;
use crate::memory_forecast::Resources;
use crate::plan::Plan;
use crate::report::PlanReport;

pub(super) fn run(command: &PlanCommand, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    command.remark.iter().for_each(|remark| terminal.complain(remark));
    let resources = Resources { memory_bytes: memory::available_bytes(), cache: None };
    let needed = Plan::of(&command.job);
    let rehearsed = match terminal.program {
        Program::Supel => rehearsal::rehearse(needed.job(), &[], resources.allowed(&command.job))?,
        Program::Other => Rehearsed::Nothing,
    };
    terminal.tell_threads(command.threads);
    let n_threads = command.threads.used;
    let threads = process::threads(n_threads)?;
    let mut stage_line = StageLine::new(terminal.progress);
    let rates = threads.install(|| (pipeline.rates)(n_threads, command.calibration, &mut stage_line))?;
    let forecast = threads.install(|| (pipeline.forecast)(&command.job, resources, command.counting, &mut stage_line));
    let forecast = forecast.map_err(|error| rehearsed.judge(error))?;
    drop(stage_line);
    let report = PlanReport { forecast: &forecast, rates: &rates, n_threads };
    match command.answer {
        PlanAnswer::Text => terminal.answer(&report.to_text(terminal.paint)),
        PlanAnswer::Json => terminal.answer(&report.to_json()?),
    }
    Ok(ExitCode::Done)
}
