//! What was typed after `supel plan`, checked.

use super::flags::PlanFlags;
use super::job_document;
use super::pipeline::Calibration;
use super::threads::Threads;
use crate::cost_forecast::Counting;
use crate::error::Result;
use crate::job::{Job, Skip};

/// The cost of a job.
#[derive(Debug)]
pub(super) struct PlanCommand {
    /// The job: checked, paths absolute.
    pub(super) job: Job,
    /// What is to be said of the folder from which its paths count.
    pub(super) remark: Option<String>,
    pub(super) threads: Threads,
    pub(super) counting: Counting,
    pub(super) calibration: Calibration,
    pub(super) answer: PlanAnswer,
}

/// What `supel plan` prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlanAnswer {
    Text,
    Json,
}

impl PlanCommand {
    pub(super) fn build(flags: PlanFlags) -> Result<Self> {
        let PlanFlags { job, count_modes, calibrate, no_skip, threads, memory_gib, json } = flags;
        let (mut job, remark) = job_document::read(&job)?;
        job.run.memory_gib = memory_gib.or(job.run.memory_gib);
        if no_skip {
            job.run.skip = Skip::Nothing;
        }
        job.validate()?;
        Ok(Self {
            job,
            remark,
            threads: Threads::of(threads),
            counting: if count_modes { Counting::Always } else { Counting::WhereQuick },
            calibration: if calibrate { Calibration::Again } else { Calibration::Kept },
            answer: if json { PlanAnswer::Json } else { PlanAnswer::Text },
        })
    }
}
