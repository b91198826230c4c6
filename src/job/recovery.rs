//! Displacements inside the component: which nodes, and how many digits of their rows of the basis are kept.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use supel_runtime::Precision;

use super::interface::{Coupling, InterfaceJob, NodeSelection, Origin};
use super::selection::selection;
use crate::error::Result;

/// Nodes whose displacements the superelement recovers: their rows of the basis Ψ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecoveryJob {
    /// Which nodes of the model; rows have no name to be recovered by.
    #[schemars(schema_with = "nodes_by_name")]
    pub nodes: NodeSelection,
    /// How the rows are stored.
    #[serde(default)]
    pub precision: Precision,
}

/// The key, by which messages call the selection.
const KEY: &str = "write.recovery";

impl RecoveryJob {
    /// The selection in the form that interfaces have.
    pub fn selection(&self) -> InterfaceJob {
        InterfaceJob {
            name: KEY.to_owned(),
            nodes: self.nodes.clone(),
            coupling: Coupling::Direct,
            origin: Origin::Centroid,
            dofs: None,
        }
    }
}

pub(super) fn validate(recovery: &RecoveryJob) -> Result<()> {
    selection(&recovery.selection(), KEY)
}

/// Nodes, not rows.
fn nodes_by_name(generator: &mut SchemaGenerator) -> Schema {
    let mut nodes = NodeSelection::json_schema(generator);
    let has_rows = |choice: &Value| choice.pointer("/properties/rows").is_some();
    if let Some(choices) = nodes.get_mut("anyOf").and_then(Value::as_array_mut) {
        choices.retain(|choice| !has_rows(choice));
    }
    nodes
}
