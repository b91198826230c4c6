//! The scene: what the simulation will ask of the component. What it never asks is left out, see [`crate::plan`]; what it asks is compared
//! with the full model.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::accept::AcceptJob;
use super::analysis::AnalysisJob;
use super::carrier::CarrierJob;
use super::gravity::GravityJob;
use super::interface_part::InterfacePart;
use super::outputs::OutputsJob;
use super::ranges::{LARGEST, SMALLEST};
use super::support::Support;

/// What the simulation will ask of the component. Whatever is given here is compared, at any cost; what is absent is
/// compared with defaults where that is cheap, and nothing is left out for it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneJob {
    /// What kind of analysis the superelement is for; for every kind where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub analysis: Option<AnalysisJob>,
    /// Lowest and highest frequency of interest, in Hz.
    #[schemars(schema_with = "band_schema")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band_hz: Option<[f64; 2]>,
    /// Gravity, and acceleration of the whole component: `true` where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<GravityJob>,
    /// Interfaces, or directions of them, that something is connected to: nothing acts on the others.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub connected: Option<Vec<InterfacePart>>,
    /// Interfaces, or directions of them, that nothing is connected to and no load acts on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unloaded: Vec<InterfacePart>,
    /// Interfaces, or directions of them, that are at rest.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub grounded: Vec<InterfacePart>,
    /// Interfaces that move together as one rigid body, whose motion is prescribed or that of something stiff.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub prescribed: Vec<CarrierJob>,
    /// Nodes inside the component whose response matters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outputs: Option<OutputsJob>,
    /// Supports under which frequencies are compared; an empty list compares none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundaries: Option<Vec<Support>>,
    /// Damping of the frequency response.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<DampingJob>,
    /// Errors that are accepted; beyond them the reduction fails.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accept: Option<AcceptJob>,
}

/// Damping of the component.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DampingJob {
    /// Share ζ of critical damping of every mode; the structural damping factor of K (1 + iη) is η = 2ζ.
    #[schemars(extend("minimum" = SMALLEST, "exclusiveMaximum" = 1, "default" = 0.01))]
    pub ratio: f64,
}

impl Default for DampingJob {
    /// One per cent of critical damping: welded and bolted metal.
    fn default() -> Self {
        Self { ratio: 0.01 }
    }
}

/// Two frequencies, the higher one above zero.
fn band_schema(_: &mut SchemaGenerator) -> Schema {
    let (low, high) = (
        json!({ "type": "number", "minimum": 0 }),
        json!({ "type": "number", "minimum": SMALLEST, "maximum": LARGEST }),
    );
    json_schema!({ "type": "array", "prefixItems": [low, high], "minItems": 2, "maxItems": 2 })
}

impl SceneJob {
    /// The keys that ask for something that moves, as far as they are given.
    pub(super) fn dynamic_keys(&self) -> impl Iterator<Item = &'static str> {
        let accept = self.accept.unwrap_or_default();
        let keys = [
            ("band_hz", self.band_hz.is_some()),
            ("boundaries", self.boundaries.as_ref().is_some_and(|boundaries| !boundaries.is_empty())),
            ("damping", self.damping.is_some()),
            ("accept.frequency", accept.frequency.is_some()),
            ("accept.response_db", accept.response_db.is_some()),
            ("accept.internal_load", accept.internal_load.is_some()),
        ];
        keys.into_iter().filter(|(_, is_given)| *is_given).map(|(key, _)| key)
    }
}
