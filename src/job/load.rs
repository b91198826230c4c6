//! Loads that the superelement carries by name.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::node_selection::NodeSelection;
use super::ranges;
use super::recovery::nodes_by_name;
use super::selection::{self, Selection};
use super::whole;
use crate::error::{Error, Result, Selector};

/// A load that the superelement carries by name: forces on nodes, a pressure on faces, a column of a file, or the centrifugal load of a
/// rotation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "dependentRequired" = { "force": ["nodes"], "pressure": ["nodes"], "column": ["file"] },
    "allOf" = [{ "oneOf": [
        { "required": ["nodes", "force"] }, { "required": ["nodes", "pressure"] }, { "required": ["file"] }, { "required": ["rotation"] },
    ] }, { "not": { "required": ["nodes", "file"] } }, { "not": { "required": ["nodes", "rotation"] } }],
))]
pub struct LoadJob {
    /// Name, unique among the loads of the job.
    #[schemars(regex(pattern = r"\S"))]
    pub name: String,
    /// Which nodes share out `force`, or between which faces take `pressure`.
    #[schemars(schema_with = "nodes_by_name")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nodes: Option<NodeSelection>,
    /// Total force along x, y and z, in units of the stiffness times a displacement; each of the nodes takes an equal share.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<[f64; 3]>,
    /// Pressure on the faces of the mesh all of whose nodes are selected, in units of force per area; above zero it pushes against them.
    #[schemars(range(min = -ranges::LARGEST, max = ranges::LARGEST), extend("not" = { "const": 0 }))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure: Option<f64>,
    /// Matrix Market file with a force for every row of the matrices, or the superelement that the matrices are of.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place-of-one"))]
    pub file: Option<PathBuf>,
    /// Column of the file, from zero; a file of one column needs none.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "whole::size")]
    pub column: Option<usize>,
    /// Axis whose centrifugal load per ω² it is, ω in rad per unit of time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<RotationJob>,
    /// Whether a residual vector joins the basis, the static answer of the interior, by which that of the superelement is exact.
    #[serde(default = "with_residual_vector")]
    pub residual: bool,
}

/// Whoever names a load wants its answer: a residual vector costs one solve and one coordinate.
fn with_residual_vector() -> bool {
    true
}

/// An axis of rotation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotationJob {
    /// Its direction, of any length.
    pub axis: [f64; 3],
    /// A point of it; the origin where absent.
    #[serde(default)]
    pub through: [f64; 3],
}

/// What a load is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadPattern<'a> {
    /// A total force, shared out among nodes.
    Force(&'a NodeSelection, &'a [f64; 3]),
    /// A pressure on the faces between nodes.
    Pressure(&'a NodeSelection, f64),
    /// A column of a file.
    File(&'a Path, Option<usize>),
    /// The centrifugal load per ω².
    Rotation(&'a RotationJob),
}

impl LoadJob {
    /// What it is made from.
    ///
    /// # Errors
    /// [`Error::LoadKeys`] where keys are missing or contradict each other.
    pub fn pattern(&self) -> Result<LoadPattern<'_>> {
        let on_nodes = (self.force.as_ref(), self.pressure);
        match (&self.nodes, on_nodes, &self.file, self.column, &self.rotation) {
            (Some(nodes), (Some(force), None), None, None, None) => Ok(LoadPattern::Force(nodes, force)),
            (Some(nodes), (None, Some(pressure)), None, None, None) => Ok(LoadPattern::Pressure(nodes, pressure)),
            (None, (None, None), Some(file), column, None) => Ok(LoadPattern::File(file, column)),
            (None, (None, None), None, None, Some(rotation)) => Ok(LoadPattern::Rotation(rotation)),
            _ => Err(Error::LoadKeys { load: self.name.clone(), found: self.keys() }),
        }
    }

    /// The keys in addition to its name that are there.
    fn keys(&self) -> Vec<&'static str> {
        let keys = [
            ("nodes", self.nodes.is_some()),
            ("force", self.force.is_some()),
            ("pressure", self.pressure.is_some()),
            ("file", self.file.is_some()),
            ("column", self.column.is_some()),
            ("rotation", self.rotation.is_some()),
        ];
        keys.into_iter().filter(|(_, is_there)| *is_there).map(|(key, _)| key).collect()
    }

    /// The nodes between which its pressure acts on faces, where it is one.
    pub fn pressed(&self) -> Option<Selection<'_>> {
        self.pressure.and(self.nodes.as_ref()).map(|nodes| self.selection(nodes))
    }

    /// The nodes that it selects, with the name for messages.
    pub fn selection<'a>(&self, nodes: &'a NodeSelection) -> Selection<'a> {
        Selection { selector: Selector::Load(self.name.clone()), nodes, directions: None }
    }
}

pub(super) fn validate(loads: &[LoadJob]) -> Result<()> {
    for (index, load) in loads.iter().enumerate() {
        let place = format!("load[{index}]");
        if load.name.trim().is_empty() {
            return Err(Error::JobEmpty { key: format!("{place}.name"), expected: "a name" });
        }
        if loads[..index].iter().any(|other| other.name == load.name) {
            return Err(Error::LoadTwice { name: load.name.clone() });
        }
        match load.pattern()? {
            LoadPattern::Force(nodes, force) => {
                selection::validate(&load.selection(nodes), &place)?;
                ranges::direction(&format!("{place}.force"), force)?;
            }
            LoadPattern::Pressure(nodes, pressure) => {
                selection::validate(&load.selection(nodes), &place)?;
                ranges::not_zero(&format!("{place}.pressure"), pressure)?;
            }
            LoadPattern::File(path, _) if path.as_os_str().is_empty() => {
                return Err(Error::JobEmpty { key: format!("{place}.file"), expected: "the name of a file" });
            }
            LoadPattern::File(..) => {}
            LoadPattern::Rotation(RotationJob { axis, through }) => {
                ranges::direction(&format!("{place}.rotation.axis"), axis)?;
                ranges::point(&format!("{place}.rotation.through"), through)?;
            }
        }
    }
    Ok(())
}
