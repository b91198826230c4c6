//! What a reduction hands back.

use supel_runtime::Superelement;

use crate::report::Report;

/// The superelement and the report on it; files, times and memory are filled in by whoever writes them.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The superelement.
    pub superelement: Superelement,
    /// The report; [`crate::report::RunFacts`] holds the work counters only.
    pub report: Report,
}
