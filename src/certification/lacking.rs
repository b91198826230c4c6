//! What a result lacks of the modes of a band.

use std::ops::Range;

use super::band::{CLUSTER, Completed};
use super::claims::Claims;
use super::measured::Measured;
use super::pair::MissingMode;
use super::rounding::of_digits_in_frequency;
use super::truth::Truth;

/// The modes of a band that no pair is.
#[derive(Clone, Debug, Default)]
pub(super) struct Lacking {
    /// Those that a result has to have.
    pub(super) missing: Vec<MissingMode>,
    /// Modes of the cluster at the end of the band that the result lacks: it ends inside of it.
    pub(super) n_cut: usize,
    /// Modes that were found outside of the band.
    pub(super) n_outside: usize,
    /// λ of the highest mode of the band, zero where none is in it.
    pub(super) counted_to: f64,
}

impl Lacking {
    /// Of the modes that there are, with the pairs that each cluster has.
    pub(super) fn of(
        truth: &Truth<'_>,
        taken: &[Vec<usize>],
        (claims, measured): (&Claims, &Measured),
        hertz: impl Fn(f64) -> f64,
    ) -> Self {
        let Truth { lambda, clusters, completed, .. } = truth;
        let mut found = Self::default();
        for (at, (cluster, taken_of)) in clusters.iter().zip(taken).enumerate() {
            let (within, n_taken) = (within(completed, lambda, cluster, taken_of), taken_of.len());
            found.n_outside += cluster.len() - within.len();
            let n_lacking = within.len().saturating_sub(n_taken);
            if let Some(last) = within.clone().last() {
                found.counted_to = found.counted_to.max(lambda[last]);
            }
            if n_lacking > 0 && ends_inside(truth, (at, taken), (claims, measured)) {
                found.n_cut += n_lacking;
                continue;
            }
            let missing = |mode: usize| {
                let frequency_hz = hertz(lambda[mode]);
                let error_bar_hz = completed.modes.errors[mode].bar_of(frequency_hz);
                MissingMode { frequency_hz, error_bar_hz, of_frequency: [cluster.len(), n_taken] }
            };
            found.missing.extend((within.end - n_lacking..within.end).map(missing));
        }
        found
    }
}

/// The modes of a cluster that are in the band: all that lie within the distance of a cluster of it where the result has one of them, and those
/// that lie in it where it has none.
fn within(completed: &Completed, lambda: &[f64], cluster: &Range<usize>, taken: &[usize]) -> Range<usize> {
    let is_in = |mode: &usize| match taken.is_empty() && completed.is_asked {
        true => completed.holds_strictly(lambda[*mode]),
        false => completed.holds(lambda[*mode]),
    };
    let start = cluster.clone().find(is_in).unwrap_or(cluster.end);
    start..(start..cluster.end).rev().find(is_in).map_or(start, |last| last + 1)
}

/// Whether a result ends inside of a cluster. A poor shape at its end has a frequency of its own above the cluster; what is stated of it tells
/// then that it is one of these modes.
fn ends_inside(
    truth: &Truth<'_>,
    (at, taken): (usize, &[Vec<usize>]),
    (claims, measured): (&Claims, &Measured),
) -> bool {
    let Truth { lambda, clusters, completed, .. } = truth;
    if completed.is_asked {
        return false;
    }
    if !taken[at].is_empty() {
        return lambda[clusters[at].end - 1] >= completed.ends[1] * (1.0 - CLUSTER);
    }
    let Some(stated) = &claims.lambda else { return false };
    let is_stated = |claim: &usize| {
        let of_digits = 2.0 * (claims.value_rounding[*claim] + of_digits_in_frequency(measured, *claim));
        let is_of = |mode: usize| (stated[*claim] / lambda[mode] - 1.0).abs() <= CLUSTER + of_digits;
        clusters[at].clone().any(is_of)
    };
    let above: Vec<&usize> = taken[at + 1..].iter().flatten().collect();
    !above.is_empty() && above.into_iter().all(is_stated)
}
