//! What the command line is given to run.

use supel_runtime::Superelement;

use crate::audit::Audit;
use crate::certification::{Band, ResultFiles};
use crate::cost_forecast::{Counting, Forecast, Rates};
use crate::error::Result;
use crate::examination::Examined;
use crate::job::Job;
use crate::memory_forecast::Resources;
use crate::outcome::Outcome;
use crate::report::{CertifiedResult, Observer};

/// The function that turns a job into a superelement and its report.
pub type Reduce = fn(&Job, Resources, &mut dyn Observer) -> Result<Outcome>;

/// The function that checks a superelement, by itself or against the model of a job.
pub type Verify = fn(&Superelement, Option<&Job>, Resources, &mut dyn Observer) -> Result<Audit>;

/// The function that holds a result of another program against the model of a job.
pub type Certify = fn(&Job, &ResultFiles, Option<Band>, (Resources, &mut dyn Observer)) -> Result<CertifiedResult>;

/// The function that finds out what the matrices of a job are.
pub type Examine = fn(&Job, (Resources, &mut dyn Observer)) -> Result<Examined>;

/// The function that says what a job will cost.
pub type Foresee = fn(&Job, Resources, Counting, &mut dyn Observer) -> Result<Forecast>;

/// The function that knows how fast this machine is with so many threads; [`Calibration`] says whether from memory.
pub type Measure = fn(usize, Calibration, &mut dyn Observer) -> Result<Rates>;

/// Whether what is known of a machine from earlier is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibration {
    /// It is; what is not known is measured and kept.
    Kept,
    /// It is measured again, and kept.
    Again,
}

/// The functions that commands run.
#[derive(Clone, Copy, Debug)]
pub struct Pipeline {
    /// Runs `supel reduce`, and the second run of `supel verify --reproduce`.
    pub reduce: Reduce,
    /// Runs `supel verify`.
    pub verify: Verify,
    /// Runs `supel certify`.
    pub certify: Certify,
    /// Runs `supel doctor`.
    pub examine: Examine,
    /// Runs `supel plan`.
    pub forecast: Foresee,
    /// Turns work into seconds for `supel plan`.
    pub rates: Measure,
}
