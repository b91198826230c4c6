//! What a file says of the program and version that made it.

use supel_runtime::{Generator, Superelement};

use crate::job::Job;

/// The job kept in a file, where it is one that this version makes a reduction of.
pub fn kept_job(superelement: &Superelement) -> Option<Job> {
    let job: Job = serde_json::from_value(superelement.metadata().job.clone()).ok()?;
    job.validate().is_ok().then_some(job)
}

/// Whether this program, in this version, made the file, as far as it says so.
pub fn is_of_this_version(superelement: &Superelement) -> bool {
    let Generator { name, version, .. } = &superelement.metadata().generator;
    name == env!("CARGO_PKG_NAME") && version == env!("CARGO_PKG_VERSION")
}

/// What rules of this version find, where the file says that it is of this version. Otherwise M-26 *it was made by this
/// version* says that they were not held against it.
pub(super) fn applied(superelement: &Superelement, found: Vec<String>) -> Vec<String> {
    if is_of_this_version(superelement) { found } else { Vec::new() }
}
