//! The modes of a report, with the rank of each.

use super::results::Results;
use crate::job::Boundary;
use crate::modes::Coupling;
use crate::report::{ModeKind, ModeRow};

/// Numbers of the kept modes that nothing sees, from one.
pub(super) fn unseen(results: &Results<'_>) -> Vec<usize> {
    let couplings = results.evidence.retained.couplings.iter().enumerate();
    couplings.filter(|(_, coupling)| !coupling.is_seen).map(|(index, _)| index + 1).collect()
}

/// The place of each mode when they are ordered by what they contribute, from one; the lower frequency first of equals.
fn ranks(couplings: &[Coupling]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..couplings.len()).collect();
    order.sort_by(|a, b| couplings[*b].size.total_cmp(&couplings[*a].size));
    let mut ranks = vec![0; couplings.len()];
    order.into_iter().zip(1..).for_each(|(mode, rank)| ranks[mode] = rank);
    ranks
}

/// A row for each kept mode.
pub(super) fn modes(results: &Results<'_>) -> Vec<ModeRow> {
    let evidence = &results.evidence;
    let modes = &evidence.retained.modes;
    let kind = kind(evidence.retained.boundary);
    let couplings = &evidence.retained.couplings;
    let ranks = ranks(couplings);
    let row = |(index, (lambda, error)): (usize, (&f64, &crate::eigen::ModeError))| {
        let frequency_hz = evidence.partition.scaling.hertz(*lambda);
        ModeRow {
            index: index + 1,
            frequency_hz,
            error_bar_hz: error.bar_of(frequency_hz),
            backward_error: error.backward,
            coupling: couplings[index].size,
            rank: ranks[index],
            kind,
            enclosure_hz: enclosure(results, index),
        }
    };
    results.eigenvalues().iter().zip(&modes.errors).enumerate().map(row).collect()
}

/// The proven interval of a mode as frequencies, rounded outwards.
fn enclosure(results: &Results<'_>, index: usize) -> Option<[f64; 2]> {
    const OUTWARD: f64 = 4.0 * f64::EPSILON;
    let [low, high] = results.evidence.enclosures?.intervals.get(index).copied()??;
    let scaling = results.evidence.partition.scaling;
    Some([scaling.hertz(low) * (1.0 - OUTWARD), scaling.hertz(high) * (1.0 + OUTWARD)])
}

/// Under which boundary modes are computed, as the report has it.
pub(super) fn kind(boundary: Boundary) -> ModeKind {
    match boundary {
        Boundary::FreeInterface => ModeKind::FreeInterface,
        Boundary::FixedInterface => ModeKind::FixedInterface,
        Boundary::MixedInterface => ModeKind::MixedInterface,
    }
}
