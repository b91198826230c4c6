//! No mode is missing: M-06.

use super::Evidence;
use super::check::{Check, Limits};

/// M-06, where a count was made.
pub(super) fn count(evidence: &Evidence<'_>) -> Option<Check> {
    let certificate = evidence.certificate?;
    Some(Check {
        id: "M-06",
        name: "no mode is missing",
        equation: "|eigenvalues counted below σ − modes found|, by the inertia of K − σM",
        value: certificate.n_counted.abs_diff(certificate.n_found) as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some(format!(
            "counted {}, found {}, pivot growth {:.1}",
            certificate.n_counted, certificate.n_found, certificate.count.growth
        )),
    })
}
