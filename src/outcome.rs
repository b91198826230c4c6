//! What a reduction is given in addition to the job, and what it hands back.

use supel_runtime::Superelement;

use crate::job::Job;
use crate::report::Report;

/// What the machine has. It decides whether a run starts and changes no result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Resources {
    /// Memory the run may use, in bytes; `None` sets no limit. `run.memory_gib` of the job takes precedence.
    pub memory_bytes: Option<u64>,
}

impl Resources {
    /// Memory that a job may use, in bytes: as it says itself, or what there is.
    pub fn allowed(self, job: &Job) -> Option<u64> {
        let stated = job.run.memory_gib.map(|gib| (gib * f64::from(1 << 30)) as u64);
        stated.or(self.memory_bytes)
    }
}

/// The superelement and the report on it; the caller that writes the files fills in files, times and memory.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The superelement.
    pub superelement: Superelement,
    /// The report; [`crate::report::RunFacts`] holds the work counters only.
    pub report: Report,
}
