//! What kind of analysis the simulation makes of the component.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The analysis that the superelement is for. What it never asks is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AnalysisJob {
    /// Equilibrium alone: nothing moves, and no mode is computed.
    Static,
    /// Natural frequencies and shapes.
    Modal,
    /// Harmonic response over the band.
    FrequencyResponse,
    /// Motion in time.
    Transient,
}

impl AnalysisJob {
    /// Its name in jobs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Static => "static",
            Self::Modal => "modal",
            Self::FrequencyResponse => "frequency-response",
            Self::Transient => "transient",
        }
    }
}
