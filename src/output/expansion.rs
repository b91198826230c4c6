//! What the report says of the modes of a file.

use super::results::Results;
use crate::basis::DynamicCoordinate;
use crate::error::Warning;
use crate::partition::ExpansionFacts;
use crate::report::{ExpansionReport, ExpansionRow};
use crate::verification::Evidence;

/// The modes of a file, where the job names one.
pub(super) fn report(results: &Results<'_>) -> Option<ExpansionReport> {
    let Evidence { partition, basis, .. } = results.evidence;
    let row = |(mode, facts): (usize, &ExpansionFacts)| ExpansionRow {
        index: mode + 1,
        is_kept: basis.coordinates.contains(&DynamicCoordinate::Expansion(mode)),
        not_followed: facts.not_followed,
    };
    let modes: Vec<ExpansionRow> = partition.expansion.facts.iter().enumerate().map(row).collect();
    let elastic = results.findings.elastic.iter().take(modes.len());
    Some(ExpansionReport {
        digest: results.input.modes.clone()?,
        reduced_hz: elastic.map(|lambda| partition.scaling.hertz(*lambda)).collect(),
        modes,
    })
}

/// Modes of a file of which held dofs and rigid patches take more than what test engineers call another shape.
pub(super) fn not_followed(results: &Results<'_>) -> Option<Warning> {
    /// A modal assurance criterion of 0.9 with what follows, the usual limit of one shape: the square of the share is 0.1.
    const LARGEST_SQUARE: f64 = 0.1;
    let facts = results.evidence.partition.expansion.facts.iter().enumerate();
    let lost: Vec<String> = facts
        .filter(|(_, facts)| facts.not_followed.powi(2) > LARGEST_SQUARE)
        .map(|(mode, facts)| format!("{:.0} % of mode {}", 100.0 * facts.not_followed, mode + 1))
        .collect();
    (!lost.is_empty()).then(|| Warning {
        code: "W-MODES-HELD",
        message: format!("held dofs and rigid patches cannot follow {} of the file", lost.join(", ")),
    })
}
