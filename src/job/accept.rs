//! What errors of the reduced model the simulation accepts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ranges::{LARGEST, SMALLEST, size};
use crate::error::Result;

/// The largest errors that the simulation accepts, each measured against the full model. One that is exceeded, or that cannot be
/// measured, is a failed check; what is left out is compared with limits of practice, and exceeding those is a warning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AcceptJob {
    /// Relative error of a frequency in the band, under each of the boundaries.
    #[schemars(extend("minimum" = SMALLEST, "maximum" = LARGEST))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency: Option<f64>,
    /// Error of the frequency response in the band between any two interface dofs, in dB.
    #[schemars(extend("minimum" = SMALLEST, "maximum" = LARGEST))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub response_db: Option<f64>,
    /// Relative error of the internal loads in the band under forces on the interface dofs, as stresses weighted by their strains.
    #[schemars(extend("minimum" = SMALLEST, "maximum" = LARGEST))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub internal_load: Option<f64>,
    /// Relative error of the static stiffness of each interface, and of the static answer to each load that the job names.
    #[schemars(extend("minimum" = SMALLEST, "maximum" = LARGEST))]
    #[serde(default, rename = "static", skip_serializing_if = "Option::is_none")]
    pub statics: Option<f64>,
}

impl AcceptJob {
    /// Whether it limits an error that more modes make smaller.
    pub fn limits_modes(&self) -> bool {
        self.frequency.is_some() || self.accepts_response()
    }

    /// Whether it limits an error of the frequency response.
    pub fn accepts_response(&self) -> bool {
        self.response_db.is_some() || self.internal_load.is_some()
    }

    pub(super) fn validate(&self) -> Result<()> {
        let limits = [
            ("scene.accept.frequency", self.frequency),
            ("scene.accept.response_db", self.response_db),
            ("scene.accept.internal_load", self.internal_load),
            ("scene.accept.static", self.statics),
        ];
        limits.into_iter().try_for_each(|(key, limit)| limit.map_or(Ok(()), |limit| size(key, limit)))
    }
}
