//! Which nodes or rows of the model a part of the job names.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, de};

use super::whole;

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
