//! The fewest modes with which the reduced model meets what the scene accepts.

use super::super::evidence::Evidence;
use super::compared::Compared;
use super::interfaces::interfaces;
use super::outcome::SizeError;
use super::policy::{Plan, ResponseExtent};
use super::response;
use super::sizes::{self, size_error};
use crate::error::Result;
use crate::factor::Analysis;
use crate::job::{AcceptJob, Job};

/// So many modes fewer are tried where one fewer is too few.
const FEWER: usize = 4;

/// The fewest of the lowest modes in the basis with which frequencies and response are within what the scene accepts, by the answers of the
/// full model at the places where the whole basis errs; none where all of them are not enough, or where it cannot be measured.
///
/// More than four below a number that is too few nothing is tried. A smaller basis may err most at another place: what it is worth is
/// measured once it is there.
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
    let extent = match accept.internal_load {
        Some(_) => ResponseExtent::WithInternalLoads,
        None => ResponseExtent::AtInterfaces,
    };
    // A component without an interface has none, whatever is accepted of it.
    let response = match accept.accepts_response() && plan.response != ResponseExtent::NotCompared {
        true => compared.kept("response", response::compared((evidence, evidence), extent, (band_hz, plan.eta)))?,
        false => None,
    };
    let is_measured = accept.frequency.is_none() || references.len() == plan.supports.len();
    if !is_measured || accept.accepts_response() && response.is_none() {
        return Ok(None);
    }
    let full = response.as_ref().map(|response| &response.full);
    let n_modes = sizes::n_modes(evidence);
    // A basis whose pencil is not definite is none that could be enough.
    let is_enough = |count: usize| {
        size_error(evidence, &references, full, (count, band_hz)).is_ok_and(|error| is_within(accept, &error))
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
    // An error need not fall with every mode: a few fewer may do as well.
    while let Some(fewer) = (1..=FEWER).filter_map(|n| enough.checked_sub(n)).find(|count| is_enough(*count)) {
        enough = fewer;
    }
    Ok(Some(enough))
}

fn is_within(accept: AcceptJob, error: &SizeError) -> bool {
    let limits = [
        (accept.frequency, Some(error.frequency_error)),
        (accept.response_db, error.response_error_db),
        (accept.internal_load, error.internal_load_error),
    ];
    limits.into_iter().all(|(limit, error)| limit.is_none_or(|limit| error.is_some_and(|error| error <= limit)))
}
