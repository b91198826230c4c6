//! Displacements inside the component: which nodes, and how many digits of their rows of the basis are kept.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use supel_runtime::Precision;

use super::node_selection::NodeSelection;
use super::selection::{self, Selection};
use crate::error::{Result, Selector};

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

impl RecoveryJob {
    /// What it selects, with the name for messages.
    pub fn selection(&self) -> Selection<'_> {
        Selection { selector: Selector::Recovery, nodes: &self.nodes, directions: None }
    }
}

pub(super) fn validate(recovery: &RecoveryJob) -> Result<()> {
    let selection = recovery.selection();
    selection::validate(&selection, selection.selector.name())
}

/// Nodes, not rows.
pub(super) fn nodes_by_name(generator: &mut SchemaGenerator) -> Schema {
    let mut nodes = NodeSelection::json_schema(generator);
    let has_rows = |choice: &Value| choice.pointer("/properties/rows").is_some();
    if let Some(choices) = nodes.get_mut("anyOf").and_then(Value::as_array_mut) {
        choices.retain(|choice| !has_rows(choice));
    }
    nodes
}
