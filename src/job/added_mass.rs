//! Masses at nodes that are part of the model although its mass matrix does not have them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ranges::{LARGEST, not_large, number, point};
use super::whole;
use crate::error::Result;

/// A rigid mass at a node: part of the model before its modes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddedMassJob {
    /// Label of the node.
    #[serde(deserialize_with = "whole::label")]
    pub node: i64,
    /// The mass.
    #[schemars(extend("minimum" = 0, "maximum" = LARGEST))]
    pub mass: f64,
    /// Inertia tensor about its own centre: xx, yy, zz, xy, yz, zx; nothing where absent.
    #[schemars(schema_with = "tensor_schema")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<[f64; 6]>,
    /// The way from the node to its centre; at the node where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<[f64; 3]>,
}

/// Six numbers.
fn tensor_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    let number = serde_json::json!({ "type": "number", "minimum": -LARGEST, "maximum": LARGEST });
    schemars::json_schema!({ "type": "array", "items": number, "minItems": 6, "maxItems": 6 })
}

pub(super) fn validate(masses: &[AddedMassJob]) -> Result<()> {
    for (index, AddedMassJob { mass, inertia, offset, .. }) in masses.iter().enumerate() {
        let key = |name: &str| format!("added_mass[{index}].{name}");
        not_large(&key("mass"), *mass)?;
        if let Some(value) = inertia.iter().flatten().find(|value| value.is_nan() || value.abs() > LARGEST) {
            return Err(number(key("inertia"), *value, "a number of at most 1e48 in size"));
        }
        offset.as_ref().map_or(Ok(()), |offset| point(&key("offset"), offset))?;
    }
    Ok(())
}
