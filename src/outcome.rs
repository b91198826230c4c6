//! What a reduction hands back.

use supel_runtime::Superelement;

use crate::error::{Error, Result};
use crate::job::Job;
use crate::report::{Observer, Report};

/// The superelement and the report on it; files, times and memory are filled in by whoever writes them.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The superelement.
    pub superelement: Superelement,
    /// The report; [`crate::report::RunFacts`] holds the work counters only.
    pub report: Report,
}

/// Stands where the pipeline will be.
///
/// # Errors
///
/// Always.
pub fn reduce(_job: &Job, _observer: &mut dyn Observer) -> Result<Outcome> {
    Err(Error::MissingFlags {
        flags: vec!["the pipeline"],
    })
}
