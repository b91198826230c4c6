//! Interfaces of a job: which nodes, how they couple, where the interface node sits.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::node_selection::NodeSelection;
use super::selection::Selection;
use crate::dofs::Direction;
use crate::error::Selector;

/// One interface node of the superelement, or a set of nodes that all become interface nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InterfaceJob {
    /// Name, unique in the job.
    #[schemars(regex(pattern = r"\S"))]
    pub name: String,
    /// Which nodes of the model.
    pub nodes: NodeSelection,
    /// How they couple to the interface.
    #[serde(default)]
    pub coupling: Coupling,
    /// Position of the interface node of a `rigid` coupling.
    #[serde(default)]
    pub origin: Origin,
    /// Directions that belong to the interface; for `direct`, those of the six that the nodes have.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dofs: Option<Vec<Direction>>,
}

/// How nodes of the model couple to an interface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Coupling {
    /// The nodes' own degrees of freedom.
    #[default]
    Direct,
    /// One node of six degrees of freedom that moves the patch as a rigid body.
    Rigid,
}

impl Coupling {
    /// Its name in jobs and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Rigid => "rigid",
        }
    }

    /// Whether the nodes of the interface are tied to one node of their own.
    pub fn is_patch(self) -> bool {
        self == Self::Rigid
    }
}

/// Where the interface node of a rigid patch sits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"centroid\" or [x, y, z]")]
pub enum Origin {
    /// `"centroid"`: the mean of the patch's nodes.
    #[default]
    #[serde(with = "centroid")]
    #[schemars(schema_with = "centroid")]
    Centroid,
    /// `[x, y, z]`.
    Point([f64; 3]),
}

mod centroid {
    //! The word `"centroid"` as a unit variant of an untagged enum.

    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str("centroid")
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        let word = String::deserialize(deserializer)?;
        if word == "centroid" { Ok(()) } else { Err(D::Error::custom("expected \"centroid\" or [x, y, z]")) }
    }
}

impl InterfaceJob {
    /// What it selects, with the name for messages.
    pub fn selection(&self) -> Selection<'_> {
        Selection {
            selector: Selector::Interface(self.name.clone()),
            nodes: &self.nodes,
            directions: self.dofs.as_deref(),
        }
    }
}

/// The word for the mean of a patch's nodes.
fn centroid(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "const": "centroid" })
}
