//! What was typed after `supel reduce`, checked: a job with what flags say in place of its own.

use std::path::{Path, PathBuf};

use super::cache_choice::CacheChoice;
use super::flags::{ModelFlags, OutputFlags, ReduceFlags, ReductionFlags};
use super::job_document;
use super::judging::{Answer, Strictness};
use super::selection_flags::{fixed, interfaces};
use super::threads::Threads;
use super::unverified::Unverified;
use super::up_to_date::Repetition;
use crate::error::{Error, Result};
use crate::job::{
    Boundary, Job, Method, ModeOrigin, ModeSelection, ModelJob, ModesJob, ReductionJob, RunJob, Skip, WriteJob,
};

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
    pub(super) repetition: Repetition,
    pub(super) cache: Option<CacheChoice>,
    /// Memory of a run that another one has started, in bytes.
    pub(super) available_bytes: Option<u64>,
    /// From which folder the paths of the document count, and what the flags did to its interfaces and held dofs.
    pub(super) remarks: Vec<String>,
}

impl ReduceCommand {
    /// # Errors
    /// Those of the job document and of the flags, see [`Job::validate`].
    pub(super) fn build(flags: ReduceFlags) -> Result<Self> {
        let ReduceFlags { job: document, all: _, model, reduction, output, run } = flags;
        let answer = Answer::from((output.json, output.quiet));
        let unverified = Unverified::from(output.allow_unverified);
        let strictness = Strictness::from(output.strict);
        let (mut job, remarks) = match &document {
            Some(path) => {
                let (job, remark) = job_document::read(path)?;
                let (job, of_interfaces) = override_job(job, model, &reduction, output)?;
                (job, remark.into_iter().chain(of_interfaces).collect())
            }
            None => (one_off_job(model, &reduction, output)?, Vec::new()),
        };
        job = strictness.reading(job);
        job.run.certify = reduction.certify.unwrap_or(job.run.certify);
        job.run.memory_gib = run.memory_gib.or(job.run.memory_gib);
        job.run.precision = run.precision.unwrap_or(job.run.precision);
        if run.no_skip {
            job.run.skip = Skip::Nothing;
        }
        job.validate()?;
        // Paths of the document are absolute already; those of flags are relative to where the command was typed.
        let job = job.resolve(Path::new(""))?;
        Ok(Self {
            job,
            document,
            threads: Threads::of(run.threads),
            answer,
            unverified,
            strictness,
            repetition: Repetition::from(run.force),
            cache: CacheChoice::of(&run)?,
            available_bytes: run.available_bytes,
            remarks,
        })
    }
}

/// The job with what the flags say in place of its own, and what they did to its interfaces and held dofs.
fn override_job(
    mut job: Job,
    model: ModelFlags,
    reduction: &ReductionFlags,
    output: OutputFlags,
) -> Result<(Job, Vec<String>)> {
    let (typed, held) = (interfaces(&model)?, fixed(&model.fix)?);
    let twice = |name| Error::InterfaceTwice { name };
    let mut remarks = put_by_name(&mut job.interfaces, typed, "interface", |job| Some(&job.name), twice)?;
    let twice = |name| Error::FixedTwice { name };
    remarks.extend(put_by_name(&mut job.fixed, held, "fixed", |job| job.name.as_deref(), twice)?);
    replace(&mut job.model.stiffness, model.stiffness);
    job.model.mass = model.mass.or(job.model.mass);
    job.model.dofs = model.dofs.or(job.model.dofs);
    job.model.nodes = model.nodes.or(job.model.nodes);
    job.model.frames = model.frames.or(job.model.frames);
    job.model.layout = model.layout.or(job.model.layout);
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
    let (interfaces, fixed) = (interfaces(&model)?, fixed(&model.fix)?);
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
            mass: Some(mass.clone()),
            dofs: model.dofs,
            nodes: model.nodes,
            frames: model.frames,
            layout: model.layout,
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
