//! What the command line is given to run.

use supel_runtime::Superelement;

use crate::audit::Audit;
use crate::error::Result;
use crate::job::Job;
use crate::memory_forecast::Resources;
use crate::outcome::Outcome;
use crate::report::Observer;

/// The function that turns a job into a superelement and its report.
pub type Reduce = fn(&Job, Resources, &mut dyn Observer) -> Result<Outcome>;

/// The function that checks a superelement, by itself or against the model of a job.
pub type Verify = fn(&Superelement, Option<&Job>, Resources, &mut dyn Observer) -> Result<Audit>;

/// The two functions that commands run.
#[derive(Clone, Copy, Debug)]
pub struct Pipeline {
    /// Runs `supel reduce`, and the second run of `supel verify --reproduce`.
    pub reduce: Reduce,
    /// Runs `supel verify`.
    pub verify: Verify,
}
