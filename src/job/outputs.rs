//! Where inside the component the simulation looks.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use supel_runtime::Precision;

use super::node_selection::NodeSelection;
use super::recovery::{RecoveryJob, nodes_by_name};
use super::selection::{self, Selection};
use crate::error::{Result, Selector};

/// Nodes inside the component whose displacements matter, in all directions that they have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputsJob {
    /// Which nodes of the model.
    #[schemars(schema_with = "nodes_by_name")]
    pub nodes: NodeSelection,
}

impl OutputsJob {
    /// What it selects, with the name for messages.
    pub fn selection(&self) -> Selection<'_> {
        Selection { selector: Selector::Outputs, nodes: &self.nodes, directions: None }
    }

    /// The recovery of the nodes, where the job asks for no other.
    pub(crate) fn recovery(&self) -> RecoveryJob {
        RecoveryJob { nodes: self.nodes.clone(), precision: Precision::default() }
    }

    pub(super) fn validate(&self) -> Result<()> {
        let selection = self.selection();
        selection::validate(&selection, selection.selector.name())
    }
}
