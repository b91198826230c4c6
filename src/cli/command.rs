//! Checked commands, built from what was typed.

use std::path::{Path, PathBuf};

use super::export_command::ExportCommand;
use super::flags::{
    CommandLine, InspectFlags, ModelFlags, OutputFlags, ReduceFlags, ReductionFlags, Typed, VerifyFlags,
};
use super::modes_command::ModesCommand;
use super::process;
use super::recover_command::RecoverCommand;
use super::unverified::Unverified;
use crate::dofs::Direction;
use crate::error::{Error, Result};
use crate::job::{
    Boundary, Coupling, Duplicates, FixedJob, InterfaceJob, Job, Method, ModeOrigin, ModeSelection, ModelJob, ModesJob,
    NodeSelection, ReductionJob, RunJob, WriteJob,
};

/// One command, ready to run.
#[derive(Debug)]
pub(super) enum Command {
    Reduce(Box<ReduceCommand>),
    Verify(Box<VerifyCommand>),
    Inspect(InspectCommand),
    Modes(ModesCommand),
    Export(ExportCommand),
    Recover(RecoverCommand),
    /// What a child process does for its parent, see [`super::rehearsal`].
    RehearseReading,
}

/// Reduce a job.
#[derive(Debug)]
pub(super) struct ReduceCommand {
    /// The job: checked, paths absolute.
    pub(super) job: Job,
    /// The document it was read from.
    pub(super) document: Option<PathBuf>,
    pub(super) threads: Threads,
    pub(super) answer: Answer,
    pub(super) unverified: Unverified,
    pub(super) strictness: Strictness,
    /// From which folder the paths of the document count, and what the flags did to its interfaces and held dofs.
    pub(super) remarks: Vec<String>,
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

/// How many threads work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Threads {
    /// As many as were asked for, or as the machine runs at once.
    pub(super) asked: usize,
    /// As many as are of use.
    pub(super) used: usize,
}

impl Threads {
    fn of(asked: Option<u16>) -> Self {
        let asked = asked.map_or_else(process::available_threads, usize::from);
        Self { asked, used: process::useful_threads(asked) }
    }
}

/// What stdout carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Answer {
    Text,
    Json,
    Nothing,
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

/// Whether warnings count as failed checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Strictness {
    Normal,
    Strict,
}

impl Command {
    pub(super) fn build(line: CommandLine) -> Result<Self> {
        match line.command {
            Typed::Reduce(flags) => build_reduce(*flags).map(|command| Self::Reduce(Box::new(command))),
            Typed::Verify(flags) => build_verify(flags).map(|command| Self::Verify(Box::new(command))),
            Typed::Inspect(flags) => Ok(Self::Inspect(InspectCommand::of(flags))),
            Typed::Modes(flags) => ModesCommand::build(flags).map(Self::Modes),
            Typed::Export(flags) => ExportCommand::build(flags).map(Self::Export),
            Typed::Recover(flags) => RecoverCommand::build(flags).map(Self::Recover),
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
    let (job, remark) = flags.job.as_deref().map(Job::read_and_remark).transpose()?.unzip();
    Ok(VerifyCommand {
        file: flags.file,
        job,
        remark: remark.flatten(),
        rerun: if flags.reproduce { Rerun::Compared } else { Rerun::No },
        threads: Threads::of(flags.threads),
        answer: match (flags.json, flags.quiet) {
            (true, _) => Answer::Json,
            (false, true) => Answer::Nothing,
            (false, false) => Answer::Text,
        },
        strictness: if flags.strict { Strictness::Strict } else { Strictness::Normal },
    })
}

fn build_reduce(flags: ReduceFlags) -> Result<ReduceCommand> {
    let ReduceFlags { job: document, model, reduction, output, run } = flags;
    let answer = match (output.json, output.quiet) {
        (true, _) => Answer::Json,
        (false, true) => Answer::Nothing,
        (false, false) => Answer::Text,
    };
    let unverified = Unverified::from(output.allow_unverified);
    let strictness = if output.strict { Strictness::Strict } else { Strictness::Normal };
    let (mut job, remarks) = match &document {
        Some(path) => {
            let (job, remark) = Job::read_and_remark(path)?;
            let (job, of_interfaces) = override_job(job, model, &reduction, output)?;
            (job, remark.into_iter().chain(of_interfaces).collect())
        }
        None => (one_off_job(model, &reduction, output)?, Vec::new()),
    };
    if strictness == Strictness::Strict {
        job.model.duplicates = Duplicates::Refuse;
    }
    job.run.certify = reduction.certify.unwrap_or(job.run.certify);
    job.run.memory_gib = run.memory_gib.or(job.run.memory_gib);
    job.run.precision = run.precision.unwrap_or(job.run.precision);
    job.validate()?;
    // Paths of the document are absolute already; those of flags are relative to where the command was typed.
    let job = job.resolve(Path::new(""))?;
    Ok(ReduceCommand { job, document, threads: Threads::of(run.threads), answer, unverified, strictness, remarks })
}

/// The job with what the flags say in place of its own, and what they did to its interfaces and held dofs.
fn override_job(
    mut job: Job,
    model: ModelFlags,
    reduction: &ReductionFlags,
    output: OutputFlags,
) -> Result<(Job, Vec<String>)> {
    let (typed, held) = (interfaces(&model)?, fixed(&model)?);
    let twice = |name| Error::InterfaceTwice { name };
    let mut remarks = put_by_name(&mut job.interfaces, typed, "interface", |job| Some(&job.name), twice)?;
    let twice = |name| Error::FixedTwice { name };
    remarks.extend(put_by_name(&mut job.fixed, held, "fixed", |job| job.name.as_deref(), twice)?);
    replace(&mut job.model.stiffness, model.stiffness);
    replace(&mut job.model.mass, model.mass);
    job.model.dofs = model.dofs.or(job.model.dofs);
    job.model.nodes = model.nodes.or(job.model.nodes);
    job.model.symmetric = model.symmetric.or(job.model.symmetric);
    job.model.drop_empty |= model.drop_empty;
    replace(&mut job.reduction.method, reduction.method);
    job.reduction.modes = modes(reduction).or(job.reduction.modes);
    if reduction.method.is_some_and(|method| method.modes() == ModeOrigin::None) && modes(reduction).is_none() {
        // The modes of the job were meant for its own method.
        job.reduction.modes = None;
    }
    job.reduction.inertia_relief |= reduction.inertia_relief;
    let is_told = reduction.method.is_none_or(|method| method.boundary() == Boundary::MixedInterface);
    job.reduction.held = reduction.held().or(job.reduction.held.filter(|_| is_told));
    replace(&mut job.reduction.eigensolver, reduction.eigensolver);
    replace(&mut job.write.superelement, output.output);
    job.write.report = output.report.or(job.write.report);
    job.write.html = output.html.or(job.write.html);
    job.write.junit = output.junit.or(job.write.junit);
    Ok((job, remarks))
}

/// Puts what flags name in the places of those of their names, or after all others, and says which; `what` is what they are called.
///
/// # Errors
/// `twice` of a name that two flags have: the later one would replace the earlier one unseen.
fn put_by_name<T>(
    of_job: &mut Vec<T>,
    typed: Vec<T>,
    what: &str,
    name_of: fn(&T) -> Option<&str>,
    twice: fn(String) -> Error,
) -> Result<Vec<String>> {
    let n_own = of_job.len();
    let mut remarks = Vec::new();
    for new in typed {
        let name = name_of(&new).unwrap_or_default().to_owned();
        if remarks.iter().any(|(earlier, _)| *earlier == name) {
            return Err(twice(name));
        }
        let remark = match of_job[..n_own].iter_mut().find(|own| name_of(own) == name_of(&new)) {
            Some(own) => {
                *own = new;
                format!("supel: the flag replaces {what} {name:?} of the job")
            }
            None => {
                of_job.push(new);
                format!("supel: the flag adds {what} {name:?} to the {n_own} of the job")
            }
        };
        remarks.push((name, remark));
    }
    Ok(remarks.into_iter().map(|(_, remark)| remark).collect())
}

fn one_off_job(model: ModelFlags, reduction: &ReductionFlags, output: OutputFlags) -> Result<Job> {
    let (interfaces, fixed) = (interfaces(&model)?, fixed(&model)?);
    let modes = modes(reduction);
    let are_modes_told = modes.is_some() || reduction.method.is_some_and(|method| method.modes() == ModeOrigin::None);
    let (Some(stiffness), Some(mass), Some(method), true, Some(superelement)) =
        (&model.stiffness, &model.mass, reduction.method, are_modes_told, &output.output)
    else {
        let flags = [
            ("--stiffness", model.stiffness.is_some()),
            ("--mass", model.mass.is_some()),
            ("--method", reduction.method.is_some()),
            (flag_of_modes(reduction.method), are_modes_told),
            ("--output", output.output.is_some()),
        ];
        let missing = flags.into_iter().filter(|(_, is_given)| !is_given).map(|(flag, _)| flag);
        return Err(Error::MissingFlags { flags: missing.collect() });
    };
    let (inertia_relief, eigensolver) = (reduction.inertia_relief, reduction.eigensolver.unwrap_or_default());
    Ok(Job {
        model: ModelJob {
            stiffness: stiffness.clone(),
            mass: mass.clone(),
            dofs: model.dofs,
            nodes: model.nodes,
            symmetric: model.symmetric,
            drop_empty: model.drop_empty,
            ..ModelJob::default()
        },
        interfaces,
        fixed,
        loads: Vec::new(),
        matrices: Vec::new(),
        added_masses: Vec::new(),
        damping: None,
        reduction: ReductionJob { method, modes, inertia_relief, held: reduction.held(), eigensolver },
        scene: None,
        run: RunJob::default(),
        write: WriteJob {
            superelement: superelement.clone(),
            report: output.report,
            html: output.html,
            junit: output.junit,
            recovery: None,
            quantities: None,
        },
    })
}

fn replace<T>(value: &mut T, new: Option<T>) {
    if let Some(new) = new {
        *value = new;
    }
}

fn modes(reduction: &ReductionFlags) -> Option<ModesJob> {
    let up_to = reduction.up_to_hz.map(|up_to_hz| ModeSelection::UpTo { up_to_hz }.into());
    let count = || reduction.modes.map(|count| ModeSelection::Count { count }.into());
    up_to.or_else(count).or_else(|| reduction.modes_from.clone().map(|file| ModesJob::File { file }))
}

/// The flag that tells the modes of a method.
fn flag_of_modes(method: Option<Method>) -> &'static str {
    match method.map(Method::modes) {
        Some(ModeOrigin::File) => "--modes-from",
        Some(ModeOrigin::Computed | ModeOrigin::None) | None => "--up-to-hz or --modes",
    }
}

/// The interfaces of the flags: the direct ones, then the rigid ones, each in the order typed.
fn interfaces(model: &ModelFlags) -> Result<Vec<InterfaceJob>> {
    let direct = model.interface.iter().map(|text| interface("--interface", text, Coupling::Direct));
    let rigid = model.rigid_interface.iter().map(|text| interface("--rigid-interface", text, Coupling::Rigid));
    direct.chain(rigid).collect()
}

fn interface(flag: &'static str, text: &str, coupling: Coupling) -> Result<InterfaceJob> {
    let wrong = |expected| Error::FlagText { flag, text: text.to_owned(), expected };
    let (name, nodes) = text.split_once('=').ok_or_else(|| wrong("NAME=NODES, as in hub=12,17,19"))?;
    let nodes = nodes_of(nodes).map_err(wrong)?;
    Ok(InterfaceJob::new(name, nodes, coupling))
}

/// The held dofs of the flags, in the order typed.
fn fixed(model: &ModelFlags) -> Result<Vec<FixedJob>> {
    let of_flag = |text: &String| {
        let wrong = |expected| Error::FlagText { flag: "--fix", text: text.clone(), expected };
        let (name, nodes) = text.split_once('=').ok_or_else(|| wrong("NAME=NODES[:DOFS], as in foot=12,17:ux,uy"))?;
        let (nodes, dofs) = match nodes.rsplit_once(':').map(|(nodes, last)| (nodes, directions(last))) {
            // `group:ux` is the group of that name.
            Some((nodes, Some(dofs))) if nodes != "group" => (nodes, Some(dofs)),
            _ => (nodes, None),
        };
        Ok(FixedJob { name: Some(name.to_owned()), nodes: nodes_of(nodes).map_err(wrong)?, dofs })
    };
    model.fix.iter().map(of_flag).collect()
}

/// The nodes that follow the name in a flag; what was expected where they are none.
fn nodes_of(text: &str) -> std::result::Result<NodeSelection, &'static str> {
    if text.starts_with("group:") {
        return Ok(NodeSelection::Group(text.to_owned()));
    }
    if let Some(rows) = text.strip_prefix("rows:") {
        let rows = numbers(rows).ok_or("row numbers from zero, as in hub=rows:0,1,2")?;
        return Ok(NodeSelection::Rows { rows });
    }
    numbers(text).map(NodeSelection::Labels).ok_or("node labels, group:NAME or rows:0,1,2 after the =")
}

fn directions(text: &str) -> Option<Vec<Direction>> {
    let direction = |word: &str| Direction::ALL.into_iter().find(|direction| direction.to_string() == word.trim());
    text.split(',').map(direction).collect()
}

fn numbers<T: std::str::FromStr>(text: &str) -> Option<Vec<T>> {
    text.split(',').map(|number| number.trim().parse().ok()).collect()
}
