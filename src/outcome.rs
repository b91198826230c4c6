//! What a reduction hands back.

use supel_runtime::Superelement;

use crate::report::Report;

/// The superelement and the report on it; the caller that writes the files fills in files, times and memory.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The superelement.
    pub superelement: Superelement,
    /// The report; [`crate::report::RunFacts`] holds the work counters only.
    pub report: Report,
}
