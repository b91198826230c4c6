//! The fewest modes with which the reduced model meets what the scene accepts.

use super::super::evidence::Evidence;
use super::compared::Compared;
use super::interfaces::interfaces;
use super::policy::Plan;
use super::response;
use super::sizes::{self, size_error};
use crate::error::Result;
use crate::factor::Analysis;
use crate::job::{AcceptJob, Job};

/// The fewest of the lowest modes in the basis with which frequencies and response are within what the scene accepts, by the answers of the
/// full model at the places where the whole basis errs; none where all of them are not enough, or where it cannot be measured.
///
/// A smaller basis may err most at another place: what it is worth is measured once it is there.
///
/// # Errors
/// No memory.
pub fn fewest_modes(evidence: &Evidence<'_>, analysis: &Analysis, job: &Job) -> Result<Option<usize>> {
    let (plan, accept) = (Plan::new(evidence, analysis, job), job.accepted());
    let Some(band_hz) = plan.band_hz else { return Ok(None) };
    let mut compared = Compared::default();
    let references = match accept.frequency {
        Some(_) => compared.references(evidence, analysis, &interfaces(evidence.partition), &plan)?,
        None => Vec::new(),
    };
    let response = match accept.response_db {
        Some(_) => compared.kept("response", response::compared(evidence, evidence.factor, band_hz, plan.eta))?,
        None => None,
    };
    let is_measured = accept.frequency.is_none() || references.len() == plan.supports.len();
    if !is_measured || accept.response_db.is_some() && response.is_none() {
        return Ok(None);
    }
    let full = response.as_ref().map(|response| &response.full);
    let n_modes = sizes::n_modes(evidence);
    // A basis whose pencil is not definite is none that could be enough.
    let is_enough = |count: usize| {
        size_error(evidence, &references, full, (count, band_hz))
            .is_ok_and(|error| is_within(accept, error.frequency_error, error.response_error_db))
    };
    if !is_enough(n_modes) {
        return Ok(None);
    }
    // Between one that is too few, or none, and one that is enough.
    let (mut lower, mut enough) = (0, n_modes);
    while lower < enough {
        let middle = lower + (enough - lower) / 2;
        if is_enough(middle) { enough = middle } else { lower = middle + 1 }
    }
    Ok(Some(enough))
}

fn is_within(accept: AcceptJob, frequency: f64, response_db: Option<f64>) -> bool {
    accept.frequency.is_none_or(|limit| frequency <= limit)
        && accept.response_db.is_none_or(|limit| response_db.is_some_and(|error| error <= limit))
}
