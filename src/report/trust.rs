//! Intervals in which every eigenvalue is accounted for.

use serde::Serialize;

use super::ModeKind;

/// A frequency interval with a Sturm count at both ends.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrustInterval {
    /// Lower end; negative where the shift lies below zero, as −√(−σ)/2π.
    pub from_hz: f64,
    /// Upper end.
    pub to_hz: f64,
    /// Boundary of the modes counted.
    pub kind: ModeKind,
    /// Eigenvalues between the two shifts by the counts.
    pub n_counted: usize,
    /// Modes found between them.
    pub n_found: usize,
    /// Pivot growth of the two factorisations, the larger.
    pub pivot_growth: f64,
}
