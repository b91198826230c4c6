//! Interfaces of a job: which nodes, how they couple, where the interface node sits.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, de};

use super::whole;
use crate::dofs::Direction;

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

/// Nodes by label, by group, by region, or rows by number where the model has no nodes.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(deny_unknown_fields)]
pub enum NodeSelection {
    /// `"group:HUB"`, the name of a group with its leading word.
    Group(#[schemars(regex(pattern = "^group:.+"), extend("examples" = ["group:HUB"]))] String),
    /// `[412, 413]`, labels of nodes.
    Labels(#[schemars(length(min = 1), extend("uniqueItems" = true))] Vec<i64>),
    /// `{ within = … }`.
    Region {
        /// The region that holds the nodes.
        within: Region,
    },
    /// `{ rows = [0, 1, 2] }`, zero-based, for a model without nodes.
    Rows {
        /// Rows of the files, from zero; those that `drop_empty` drops are counted.
        #[schemars(length(min = 1), extend("uniqueItems" = true))]
        rows: Vec<usize>,
    },
}

/// A region of space; a node belongs to it when it is inside or on the border.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Region {
    /// Axis-parallel box.
    Box {
        /// Smallest corner.
        min: [f64; 3],
        /// Largest corner.
        max: [f64; 3],
    },
    /// Slab about a plane.
    Plane {
        /// A point of the plane.
        point: [f64; 3],
        /// Its normal, of any length.
        normal: [f64; 3],
        /// Half thickness.
        #[schemars(range(min = 0))]
        tolerance: f64,
    },
    /// Finite cylinder, solid or (with an inner radius) a shell.
    Cylinder {
        /// Centre of one end.
        from: [f64; 3],
        /// Centre of the other end.
        to: [f64; 3],
        /// Outer radius.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
        /// Inner radius.
        #[schemars(range(min = 0))]
        #[serde(default)]
        inner_radius: f64,
    },
    /// Ball.
    Sphere {
        /// Centre.
        center: [f64; 3],
        /// Radius.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
    },
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

impl NodeSelection {
    /// The name after `group:`, where nodes are given by group.
    pub fn group_name(&self) -> Option<&str> {
        match self {
            Self::Group(text) => text.strip_prefix("group:"),
            _ => None,
        }
    }
}

/// The two ways to give nodes by a table; exactly one of them is there.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SelectionTable {
    within: Option<Region>,
    #[serde(default, deserialize_with = "whole::sizes")]
    rows: Option<Vec<usize>>,
}

// A derived untagged enum would answer every mistake inside a region with "did not match any variant".
impl<'de> Deserialize<'de> for NodeSelection {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SelectionVisitor)
    }
}

struct SelectionVisitor;

impl<'de> de::Visitor<'de> for SelectionVisitor {
    type Value = NodeSelection;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("\"group:NAME\", a list of node labels, { within = … } or { rows = … }")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Self::Value, E> {
        Ok(NodeSelection::Group(text.to_owned()))
    }

    fn visit_seq<A: de::SeqAccess<'de>>(self, labels: A) -> Result<Self::Value, A::Error> {
        whole::labels(de::value::SeqAccessDeserializer::new(labels)).map(NodeSelection::Labels)
    }

    fn visit_map<A: de::MapAccess<'de>>(self, table: A) -> Result<Self::Value, A::Error> {
        match SelectionTable::deserialize(de::value::MapAccessDeserializer::new(table))? {
            SelectionTable { within: Some(within), rows: None } => Ok(NodeSelection::Region { within }),
            SelectionTable { within: None, rows: Some(rows) } => Ok(NodeSelection::Rows { rows }),
            _ => Err(de::Error::custom("expected exactly one of `within` and `rows`")),
        }
    }
}

/// The word for the mean of a patch's nodes.
fn centroid(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "const": "centroid" })
}
