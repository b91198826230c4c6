//! What the matrices of a model take for granted because they are those of a superelement.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use supel_runtime::{Superelement, Validity};

use super::gravity::GravityJob;
use super::interface_part::InterfacePart;
use super::ranges;
use crate::error::{Error, Result};

/// What the superelement whose matrices these are takes for granted of the simulation; what is made of it does so, too. `supel reduce
/// x.supel` and the jobs of `supel export` say it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AssumesJob {
    /// Sentences for clients.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sentences: Vec<String>,
    /// Along what alone gravity may act, in the axes of the model; zero where it may not act at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<[f64; 3]>,
    /// Directions of interfaces that are at rest, and no dofs of the model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub at_rest: Vec<InterfacePart>,
    /// Directions of interfaces that move, and are no dofs of the model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<InterfacePart>,
    /// Frequencies in Hz of modes that the matrices lack because nothing starts or sees them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0 }))]
    pub unseen_hz: Vec<f64>,
}

impl AssumesJob {
    /// Takes what another model of the same simulation assumes as well. Of two directions of gravity none is left.
    pub fn add(&mut self, other: Self) {
        self.sentences.extend(other.sentences);
        self.at_rest.extend(other.at_rest);
        self.left_out.extend(other.left_out);
        self.unseen_hz.extend(other.unseen_hz);
        self.gravity = match (self.gravity, other.gravity) {
            (Some(own), Some(other)) if allows(own, other) => Some(other),
            (Some(own), Some(other)) if allows(other, own) => Some(own),
            (Some(_), Some(_)) => Some([0.0; 3]),
            (own, other) => own.or(other),
        };
    }
}

/// Frequencies in Hz of the modes that a superelement lacks because nothing starts or sees them: those that its own reduction left out, and those
/// that its model lacked before. Such a mode is an eigenvector of the component however that is held, joined or reduced again.
pub fn unseen_hz(superelement: &Superelement) -> Vec<f64> {
    let metadata = superelement.metadata();
    let of_model = metadata.job["model"]["assumes"]["unseen_hz"].as_array().into_iter().flatten();
    let frequencies = &superelement.tensors().frequencies;
    let own =
        metadata.unseen_modes().filter_map(|mode| frequencies.get(mode)).map(|omega| omega / std::f64::consts::TAU);
    of_model.filter_map(serde_json::Value::as_f64).chain(own).collect()
}

/// Whether gravity that is assumed to act along one direction alone may act along another.
fn allows(assumed: [f64; 3], gravity: [f64; 3]) -> bool {
    Validity { gravity: Some(assumed), ..Validity::default() }.allows_gravity(gravity)
}

pub(super) fn validate(assumes: &AssumesJob, scene: Option<GravityJob>) -> Result<()> {
    for (key, parts) in [("at_rest", &assumes.at_rest), ("left_out", &assumes.left_out)] {
        if parts.iter().any(|part| part.0.is_empty()) {
            return Err(Error::JobEmpty { key: format!("model.assumes.{key}"), expected: "directions of interfaces" });
        }
    }
    for (index, hz) in assumes.unseen_hz.iter().enumerate() {
        ranges::positive(&format!("model.assumes.unseen_hz[{index}]"), *hz)?;
    }
    let Some(assumed) = assumes.gravity else { return Ok(()) };
    ranges::finite("model.assumes.gravity", &assumed)?;
    let Some(stated) = scene else { return Ok(()) };
    match stated.direction() {
        Some(gravity) if allows(assumed, gravity) => Ok(()),
        gravity => Err(Error::AssumedGravity { gravity, assumed }),
    }
}
