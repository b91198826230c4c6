//! Interfaces that move together.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rigid body that interfaces are parts of: it becomes one interface node of six dofs, at the mean of theirs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CarrierJob {
    /// Name of the interface that it becomes.
    #[schemars(regex(pattern = r"\S"))]
    pub name: String,
    /// Names of the interfaces that are parts of it.
    #[schemars(length(min = 1), extend("uniqueItems" = true, "items" = { "type": "string", "minLength": 1 }))]
    pub interfaces: Vec<String>,
}
