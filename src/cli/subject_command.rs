//! A model that a command looks at without reducing it, as a job of nothing else.

use std::path::Path;

use super::selection_flags::fixed;
use super::subject_flags::{RowFlags, SubjectFlags};
use super::threads::Threads;
use crate::error::Result;
use crate::job::{Job, Method, ModeSelection, ModelJob, ReductionJob, RunJob, WriteJob};

/// A model that is looked at.
#[derive(Debug)]
pub(super) struct SubjectCommand {
    /// The job: checked, paths absolute. What it would write is not written.
    pub(super) job: Job,
    pub(super) threads: Threads,
}

impl SubjectCommand {
    /// A model with so many of its modes.
    ///
    /// # Errors
    /// Those of [`Job::validate`] and [`Job::resolve`]; [`Error::FlagText`](crate::error::Error::FlagText).
    pub(super) fn build(subject: SubjectFlags, rows: RowFlags, n_modes: usize) -> Result<Self> {
        let threads = Threads::of(rows.threads);
        let job = Job {
            model: ModelJob {
                stiffness: subject.stiffness,
                mass: Some(subject.mass),
                dofs: rows.dofs,
                nodes: rows.nodes,
                layout: rows.layout,
                symmetric: rows.symmetric,
                drop_empty: rows.drop_empty,
                frames: rows.frames,
                constraints: rows.constraints,
                constraints_to_ground: rows.constraints_to_ground.unwrap_or_default(),
                ..ModelJob::default()
            },
            interfaces: Vec::new(),
            fixed: fixed(&rows.fix)?,
            loads: Vec::new(),
            matrices: Vec::new(),
            added_masses: Vec::new(),
            damping: None,
            // Without an interface its modes are those of the model itself.
            reduction: ReductionJob::new(Method::CraigBampton, ModeSelection::Count { count: n_modes }),
            scene: None,
            run: RunJob { memory_gib: rows.memory_gib, ..RunJob::default() },
            write: WriteJob {
                superelement: "none.supel".into(),
                report: None,
                html: None,
                junit: None,
                recovery: None,
                quantities: None,
            },
        };
        job.validate()?;
        Ok(Self { job: job.resolve(Path::new(""))?, threads })
    }
}
