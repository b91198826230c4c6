//! `supel reduce --all`: many jobs side by side, and how their interfaces fit each other.

use std::ffi::OsString;

use supel_runtime::Superelement;

use super::admission::{Limits, run_admitted};
use super::all_command::{AllCommand, Member};
use super::answer::{Program, Terminal};
use super::exit_code::ExitCode;
use super::job_process::{self, Ended, RunLine};
use super::judging::Answer;
use super::pipeline::Pipeline;
use super::progress::StageLine;
use super::up_to_date::{self, Repetition};
use super::{memory, overwriting, process, rehearsal};
use crate::assembly::{self, Assembly, Component};
use crate::cost_forecast::Counting;
use crate::error::{Error, Result};
use crate::memory_forecast::Resources;
use crate::report::{ComponentOutcome, ComponentRow, ErrorLine, JoinRow, ReductionsReport};

pub(super) fn run(command: &AllCommand, here: (Pipeline, RunLine), terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    refuse_shared_files(&command.members)?;
    announce(command, terminal);
    let threads = process::threads(command.threads.used)?;
    let up_to_date: Vec<Option<ComponentRow>> =
        threads.install(|| command.members.iter().map(up_to_date_row).collect());
    let is_stale = command.members.iter().zip(&up_to_date).filter(|(_, row)| row.is_none());
    let stale: Vec<&Member> = is_stale.map(|(member, _)| member).collect();
    let shares = Shares::of(stale.len(), command, terminal.program);
    let forecasts = threads.install(|| shares.forecasts(&stale, here.0));
    drop(threads);
    let (line, program) = (StageLine::new(terminal.progress), terminal.program);
    let (more, n_up_to_date, n_all) = (shares.words(), command.members.len() - stale.len(), command.members.len());
    let run_alone = |at: usize| {
        let words: Vec<OsString> = stale[at].words.iter().chain(&more).cloned().collect();
        job_process::run(program, &words, here)
    };
    let limits = Limits { at_once: shares.at_once, budget: shares.budget };
    let ended = run_admitted(&forecasts, limits, run_alone, |running, n_ended| {
        let names: Vec<&str> = running.iter().map(|at| stale[*at].name.as_str()).collect();
        line.show(&format!("  {} of {n_all} done · {} …", n_up_to_date + n_ended, names.join(", ")));
    });
    drop(line);
    let (made, mut said) = rows(&stale, ended);
    let mut made = made.into_iter();
    let of_jobs: Vec<ComponentRow> = up_to_date.into_iter().filter_map(|row| row.or_else(|| made.next())).collect();
    let named = |(name, at): &(String, usize)| ComponentRow { name: name.clone(), ..of_jobs[*at].clone() };
    let components: Vec<ComponentRow> = command.components.iter().map(named).collect();
    let joins = joins(command, &components, shares.budget);
    said.extend(joins.iter().filter_map(JoinRow::refusal));
    answer(&ReductionsReport { components, joins, budget_bytes: shares.budget }, (command.answer, &said), terminal)
}

/// What became of the jobs that ran, and what they said; of one that was ended from outside its error, which it could not say.
fn rows(members: &[&Member], ended: Vec<Ended>) -> (Vec<ComponentRow>, Vec<String>) {
    let (mut rows, mut said) = (Vec::new(), Vec::new());
    for (member, ended) in members.iter().zip(ended) {
        said.extend(ended.said.lines().map(str::to_owned));
        let is_silent = ended.code.is_none();
        let row = row(member, ended);
        said.extend(row.error.as_ref().filter(|_| is_silent).map(|error| error.line(&row.name)));
        rows.push(row);
    }
    (rows, said)
}

fn announce(command: &AllCommand, terminal: &mut Terminal<'_>) {
    if command.answer == Answer::Nothing {
        return;
    }
    for path in &command.passed_over {
        terminal.complain(&format!("supel: {}: passed over: it has no table of a job", path.display()));
    }
    terminal.tell_threads(command.threads);
}

/// What the jobs that run at the same time share.
struct Shares {
    /// Jobs.
    at_once: usize,
    /// Threads of each.
    threads: usize,
    /// Memory of all, in bytes; none where nothing limits it.
    budget: Option<u64>,
}

impl Shares {
    fn of(n_stale: usize, command: &AllCommand, program: Program) -> Self {
        let at_once = match program {
            Program::Supel => n_stale.clamp(1, command.threads.used),
            // The jobs share what the process has one of.
            Program::Other => 1,
        };
        let budget = command.budget_bytes.or_else(memory::available_bytes);
        Self { at_once, threads: (command.threads.used / at_once).max(1), budget }
    }

    /// What each job is going to hold at once, in bytes. Jobs one after the other need no forecast.
    fn forecasts(&self, jobs: &[&Member], pipeline: Pipeline) -> Vec<u64> {
        let of_job = |member: &&Member| if self.at_once > 1 { forecast(member, self.budget, pipeline) } else { 0 };
        jobs.iter().map(of_job).collect()
    }

    /// What the command line of each job says of its share.
    fn words(&self) -> Vec<OsString> {
        let (threads, bytes) = (self.threads.to_string(), self.budget.unwrap_or(u64::MAX).to_string());
        ["--threads", &threads, "--available-bytes", &bytes].into_iter().map(OsString::from).collect()
    }
}

fn answer(
    report: &ReductionsReport,
    (answer, said): (Answer, &[String]),
    terminal: &mut Terminal<'_>,
) -> Result<ExitCode> {
    match answer {
        Answer::Text => terminal.answer(&report.to_text(terminal.paint)),
        Answer::Json => terminal.answer(&report.to_json()?),
        Answer::Nothing => report.unmet().iter().for_each(|line| terminal.complain(line)),
    }
    if answer != Answer::Nothing {
        said.iter().for_each(|line| terminal.complain(line));
    }
    Ok(ExitCode::of_process(report.exit_code().into()))
}

/// Refuses jobs of which one writes what another one reads or writes, before anything is started.
fn refuse_shared_files(members: &[Member]) -> Result<()> {
    overwriting::refuse_shared(members.iter().filter_map(|member| {
        let command = member.command.as_deref()?;
        Some((member.document.as_path(), &command.job, command.document.as_deref()))
    }))
}

/// What an earlier run made of a job, where that is up to date.
fn up_to_date_row(member: &Member) -> Option<ComponentRow> {
    let command = member.command.as_deref().filter(|command| command.repetition == Repetition::Skipped)?;
    let made = up_to_date::made_earlier(&command.job, command.strictness).ok()?;
    let report = serde_json::from_str(&made.to_json().ok()?).ok()?;
    Some(ComponentRow::of_report(&member.name, &member.document, (ComponentOutcome::UpToDate, &report)))
}

/// What a job is going to hold at once, in bytes; nothing where its files cannot be read, which its run finds out as well.
fn forecast(member: &Member, budget: Option<u64>, pipeline: Pipeline) -> u64 {
    let Some(command) = member.command.as_deref() else { return 0 };
    let resources = Resources { memory_bytes: budget, cache: None };
    if rehearsal::rehearse(&command.job, &[], resources.allowed(&command.job)).is_err() {
        return 0;
    }
    let forecast = (pipeline.forecast)(&command.job, resources, Counting::WhereQuick, &mut ());
    forecast.map_or(0, |forecast| forecast.memory.total())
}

fn row(member: &Member, ended: Ended) -> ComponentRow {
    let (name, document) = (&member.name, &member.document);
    let Ended { code, answer, cause, .. } = ended;
    match code {
        Some(ExitCode::Done | ExitCode::CheckFailed) if answer["body"].is_object() => {
            let row = ComponentRow::of_report(name, document, (ComponentOutcome::Reduced, &answer));
            ComponentRow { exit_code: code.map_or(0, |code| code as u8), ..row }
        }
        Some(code) => ComponentRow::failed(name, document, (code as u8, ErrorLine::of_document(&answer, &cause))),
        None => {
            let error = Error::JobProcess { document: document.clone(), cause };
            ComponentRow::failed(name, document, (error.class() as u8, ErrorLine::of(&error)))
        }
    }
}

/// How the interfaces fit each other that an assembly joins. Those of a component without a verified superelement are not compared.
fn joins(command: &AllCommand, rows: &[ComponentRow], budget: Option<u64>) -> Vec<JoinRow> {
    if command.joins.is_empty() {
        return Vec::new();
    }
    let mut parts = joined_parts(rows, budget);
    let row = |(a, b): &(String, String)| match (unmade(rows, [a, b]), &mut parts) {
        (Some(component), _) => JoinRow::not_compared(a, b, component),
        (None, Ok(assembly)) => joined(assembly, (a, b)),
        (None, Err(error)) => JoinRow::refused(a, b, error),
    };
    command.joins.iter().map(row).collect()
}

/// The component of one of two interfaces that there is no verified superelement of; none also where an interface names no component.
fn unmade<'a>(rows: &'a [ComponentRow], interfaces: [&String; 2]) -> Option<&'a str> {
    let is_of = |row: &ComponentRow, name: &str| name.strip_prefix(&row.name).is_some_and(|rest| rest.starts_with('.'));
    let components = interfaces.into_iter().filter_map(|name| rows.iter().find(|row| is_of(row, name)));
    components.map(|row| (row, row.name.as_str())).find(|(row, _)| !is_verified(row)).map(|(_, name)| name)
}

fn is_verified(row: &ComponentRow) -> bool {
    row.exit_code == ExitCode::Done as u8 && row.superelement.is_some()
}

fn joined(assembly: &mut Assembly, (a, b): (&str, &str)) -> JoinRow {
    match assembly.join(a, b) {
        Ok(()) => JoinRow::fitting(&assembly.joints[assembly.joints.len() - 1]),
        Err(error) => JoinRow::refused(a, b, &error),
    }
}

/// The components of which there is a verified superelement.
fn joined_parts(rows: &[ComponentRow], budget: Option<u64>) -> Result<Assembly> {
    let mut components = Vec::new();
    for row in rows.iter().filter(|row| is_verified(row)) {
        let Some(path) = &row.superelement else { continue };
        let read = Superelement::open(path).map_err(|error| Error::of_superelement(path, error))?;
        components.push((row.name.clone(), read));
    }
    let n = components.iter().map(|(_, superelement)| superelement.n_coordinates()).sum();
    assembly::within_memory(n, Resources { memory_bytes: budget, cache: None })?;
    let components = components.into_iter().map(|(name, read)| Component::new(name, read)).collect::<Result<_>>()?;
    Assembly::new(components)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A job whose process was ended from outside is an error of its own, and the rows of the others stay.
    #[test]
    fn a_process_that_leaves_no_exit_code_is_an_error_of_its_job() {
        let member = Member { name: "arm".into(), document: "arm.toml".into(), words: Vec::new(), command: None };
        let row = row(&member, Ended::without_code("signal: 9 (SIGKILL)".into()));
        let error = row.error.expect("an error");
        assert_eq!((error.code.as_str(), row.exit_code), ("E-JOB-PROCESS", ExitCode::Resources as u8));
        assert!(error.message.contains("arm.toml") && error.message.contains("SIGKILL"), "{}", error.message);
    }
}
