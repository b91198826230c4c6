//! What a report says of the modes of a file.

use serde::Serialize;

/// The expansion modes of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExpansionReport {
    /// BLAKE3 digest of the file.
    pub digest: String,
    /// The lowest natural frequencies of the reduced model with its interface free, without those of rigid-body motion, as many as the
    /// file has modes: upper bounds of those of the full model, one by one (Rayleigh and Ritz).
    pub reduced_hz: Vec<f64>,
    /// The modes in the order of the file.
    pub modes: Vec<ExpansionRow>,
}

impl ExpansionReport {
    /// Modes that were kept.
    pub fn n_kept(&self) -> usize {
        self.modes.iter().filter(|mode| mode.is_kept).count()
    }
}

/// A mode of a file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ExpansionRow {
    /// Number of its column, from one.
    pub index: usize,
    /// Whether it is a coordinate; others span it otherwise.
    #[serde(rename = "kept")]
    pub is_kept: bool,
    /// The share of it, in the mass, that held dofs and rigid patches cannot follow.
    pub not_followed: f64,
}
