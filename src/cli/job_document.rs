//! The document of a job that a command names: one that a person wrote, or a superelement, which is a model with a job of its own.

use std::path::Path;

use crate::error::Result;
use crate::export::job_of;
use crate::input;
use crate::job::{Holder, Job};

/// The job, checked, its paths made absolute, and what is to be said of the folder from which they count.
///
/// # Errors
/// The errors of [`Job::read_and_remark`], and for a superelement the errors of [`job_of`].
pub(super) fn read(path: &Path) -> Result<(Job, Option<String>)> {
    if !input::is_superelement(path)? {
        return Job::read_and_remark(path);
    }
    let (superelement, _) = input::superelement(path)?;
    let (text, left_behind) = job_of(&superelement, path)?;
    // Whatever the superelement is called, its job is TOML.
    let job = Job::parse(&text, &path.with_extension("toml"))?;
    job.validate()?;
    let (job, remark) = job.located(path, Holder::Document)?;
    let remarks: Vec<String> = left_behind.into_iter().chain(remark).collect();
    Ok((job, (!remarks.is_empty()).then(|| remarks.join("\n"))))
}
