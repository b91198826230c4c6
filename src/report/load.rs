//! What a report says of a load.

use serde::Serialize;

/// A load that the superelement carries by name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadReport {
    /// Its name in the job.
    pub name: String,
    /// What it is made from, in words.
    pub source: String,
    /// BLAKE3 digest of its file; none where it is from no file.
    pub digest: Option<String>,
    /// Its total force along x, y and z in the units of the model; none without a dof map.
    pub resultant: Option<[f64; 3]>,
    /// What became of its residual vector.
    pub residual_vector: ResidualVector,
    /// What the reduced model lacks of the static answer with the interface held, as a share of it in energy's root; none where
    /// nothing answers.
    pub lacking: Option<f64>,
}

/// What became of the residual vector of a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ResidualVector {
    /// It is a coordinate.
    Kept,
    /// Others span it.
    LeftOut,
    /// The job asks for none.
    NotAsked,
    /// A free component without interface has no static answer.
    NoAnswer,
}
