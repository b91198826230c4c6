//! Interfaces of a job: which nodes, how they couple, where the interface node sits.

use schemars::JsonSchema;
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
    /// Position of the interface node of a `rigid` or `average` coupling.
    #[serde(default)]
    pub origin: Origin,
    /// Weights of the nodes in the mean of an `average` coupling; uniform if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Weights>,
    /// Axes of the interface nodes, for clients; those of the model if left out. No matrix depends on them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<Axes>,
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
    /// One node of six degrees of freedom that follows the weighted mean motion of the patch, which stays free to deform.
    Average,
}

impl Coupling {
    /// Its name in jobs and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Rigid => "rigid",
            Self::Average => "average",
        }
    }

    /// Whether the nodes of the interface have one node of their own.
    pub fn is_patch(self) -> bool {
        self != Self::Direct
    }
}

/// Where the interface node of a patch sits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"centroid\", \"area\", \"hole\", \"sphere\" or [x, y, z]")]
pub enum Origin {
    /// `"centroid"`: the mean of the patch's nodes, each counted once.
    #[default]
    #[serde(with = "centroid")]
    #[schemars(schema_with = "centroid::schema")]
    Centroid,
    /// `"area"`: the area-weighted centroid of the patch's faces.
    #[serde(with = "area")]
    #[schemars(schema_with = "area::schema")]
    Area,
    /// `"hole"`: on the axis of a cylinder fitted to the patch's nodes, in the middle of their extent along it.
    #[serde(with = "hole")]
    #[schemars(schema_with = "hole::schema")]
    Hole,
    /// `"sphere"`: the centre of a sphere fitted to the patch's nodes.
    #[serde(with = "sphere")]
    #[schemars(schema_with = "sphere::schema")]
    Sphere,
    /// `[x, y, z]`.
    Point([f64; 3]),
}

/// The weights of the nodes of a patch in its mean motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"uniform\", \"area\" or a list of numbers")]
pub enum Weights {
    /// `"uniform"`: one for each node.
    #[serde(with = "uniform")]
    #[schemars(schema_with = "uniform::schema")]
    Uniform,
    /// `"area"`: the share of each node in the area of the patch's faces.
    #[serde(with = "area")]
    #[schemars(schema_with = "area::schema")]
    Area,
    /// One positive number for each node, in the order of the list of nodes.
    Given(#[schemars(length(min = 1), extend("items" = { "type": "number", "exclusiveMinimum": 0 }))] Vec<f64>),
}

/// The axes of an interface node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"hole\" or the directions { z = [x, y, z], x = [x, y, z] }")]
pub enum Axes {
    /// `"hole"`: z along the axis of a cylinder fitted to the patch's nodes, x along what it leaves of the axis of the model that it
    /// leaves most of, the first of those that it leaves alike.
    #[serde(with = "hole")]
    #[schemars(schema_with = "hole::schema")]
    Hole,
    /// By two directions.
    Given(AxesGiven),
}

/// Axes by two directions of any length, in the frame of the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxesGiven {
    /// The direction of z.
    pub z: [f64; 3],
    /// The direction of x, of which the part perpendicular to z counts.
    pub x: [f64; 3],
}

/// A word as a unit variant of an untagged enum.
macro_rules! word {
    ($module:ident, $word:literal) => {
        mod $module {
            use schemars::{Schema, SchemaGenerator, json_schema};
            use serde::{Deserialize, Deserializer, Serializer, de::Error};

            pub(super) fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str($word)
            }

            pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
                let word = String::deserialize(deserializer)?;
                if word == $word { Ok(()) } else { Err(D::Error::custom(concat!("expected \"", $word, "\""))) }
            }

            pub(super) fn schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!({ "const": $word })
            }
        }
    };
}

word!(centroid, "centroid");
word!(area, "area");
word!(hole, "hole");
word!(sphere, "sphere");
word!(uniform, "uniform");

impl InterfaceJob {
    /// An interface that leaves out what may be left out: origin, weights, axes and a choice of dofs.
    pub fn new(name: impl Into<String>, nodes: NodeSelection, coupling: Coupling) -> Self {
        let origin = Origin::default();
        Self { name: name.into(), nodes, coupling, origin, weights: None, axes: None, dofs: None }
    }

    /// What it selects, with the name for messages.
    pub fn selection(&self) -> Selection<'_> {
        Selection {
            selector: Selector::Interface(self.name.clone()),
            nodes: &self.nodes,
            directions: self.dofs.as_deref(),
        }
    }
}
