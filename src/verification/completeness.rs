//! No mode is missing: M-06.

use super::check::{Check, Limits};
use super::evidence::Evidence;
use crate::modes::Mending;
use crate::number;

/// M-06, where a count was made. Each interval is judged by itself, so that a mode too many in one does not hide a mode
/// missing in another.
pub(super) fn count(evidence: &Evidence<'_>) -> Option<Check> {
    let certificate = evidence.certificate?;
    let differences = certificate.intervals.iter().map(|interval| interval.n_counted.abs_diff(interval.n_found));
    let mended = match certificate.mending {
        Mending::None => "",
        Mending::Restart => ", after a restart",
        Mending::Slices => ", after slicing the band",
    };
    let left_out = match evidence.unseen.len() {
        0 => String::new(),
        n => format!(" ({} in the superelement, {n} left out)", certificate.n_found.saturating_sub(n)),
    };
    Some(Check {
        id: "M-06",
        name: "no mode is missing",
        equation: "|eigenvalues counted between shifts − modes found|, by the inertia of K − σM at both ends",
        value: differences.sum::<usize>().max(certificate.n_counted.abs_diff(certificate.n_found)) as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some(format!(
            "counted {}, found {}{left_out}{mended}; {} with the interface held, {} free; pivot growth {:.1}; doubt {} (limit 1)",
            certificate.n_counted,
            certificate.n_found,
            certificate.count.clamped,
            certificate.count.free,
            certificate.count.growth,
            number::scientific(certificate.doubt(), 2)
        )),
    })
}
