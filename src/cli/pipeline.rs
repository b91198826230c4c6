//! What the command line is given to run.

use crate::error::Result;
use crate::forecast::Resources;
use crate::job::Job;
use crate::outcome::Outcome;
use crate::report::Observer;

/// The function that turns a job into a superelement and its report.
pub type Pipeline = fn(&Job, Resources, &mut dyn Observer) -> Result<Outcome>;
