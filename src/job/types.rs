//! The parts of a job document.
//!
//! `x-role` of a key says what it decides where it is not the result: `place`, where files are or how they are to be read, which
//! changes nothing; `place-of-one`, that of a file of which it matters whether there is one; `way`, how the result is found and
//! proved.

use std::path::PathBuf;

use clap::ValueEnum;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::added_mass::AddedMassJob;
use super::assumes::AssumesJob;
use super::damping::ComponentDampingJob;
use super::fixed::FixedJob;
use super::interface::InterfaceJob;
use super::layout::Layout;
use super::load::LoadJob;
use super::matrix::MatrixJob;
use super::mechanisms::Mechanisms;
use super::quantities::QuantitiesJob;
use super::ranges::{LARGEST, MAX_DIGITS, SMALLEST};
use super::recovery::RecoveryJob;
use super::reduction::ReductionJob;
use super::run::RunJob;
use super::scene::SceneJob;
use super::selection::first_repeated;
use crate::dofs::Direction;
use crate::sparse::Triangle;

/// What to read, how to reduce and what to write. Paths are relative to the folder of the document.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "if" = { "required": ["scene"], "anyOf": [
        { "properties": { "scene": { "required": ["band_hz"] } } },
        {
            "properties": {
                "scene": { "required": ["analysis"], "properties": { "analysis": { "const": "static" } } },
                "run": { "properties": { "skip": { "not": { "const": "nothing" } } } },
            },
        },
    ] },
    "else" = { "properties": { "reduction": { "anyOf": [
        { "required": ["modes"] },
        { "properties": { "method": { "const": "guyan" } } },
    ] } } },
    "anyOf" = [
        { "properties": { "model": { "required": ["mass"] } } },
        {
            "required": ["scene"],
            "properties": {
                "scene": {
                    "required": ["analysis", "gravity"],
                    "properties": { "analysis": { "const": "static" }, "gravity": { "const": false } },
                },
            },
        },
    ],
))]
pub struct Job {
    /// The finite element model.
    pub model: ModelJob,
    /// Masses at nodes that the mass matrix does not have.
    #[serde(default, rename = "added_mass", skip_serializing_if = "Vec::is_empty")]
    pub added_masses: Vec<AddedMassJob>,
    /// The interface nodes, in the order of the reduced coordinates.
    #[serde(default, rename = "interface", skip_serializing_if = "Vec::is_empty")]
    pub interfaces: Vec<InterfaceJob>,
    /// Degrees of freedom that are held at rest.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed: Vec<FixedJob>,
    /// Loads that the superelement carries by name.
    #[serde(default, rename = "load", skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<LoadJob>,
    /// Further matrices that the superelement carries by name.
    #[serde(default, rename = "matrix", skip_serializing_if = "Vec::is_empty")]
    pub matrices: Vec<MatrixJob>,
    /// Damping that the superelement carries.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<ComponentDampingJob>,
    /// Method and modes.
    pub reduction: ReductionJob,
    /// What the simulation will ask of the component.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<SceneJob>,
    /// How the run is done; changes no result.
    #[serde(default)]
    pub run: RunJob,
    /// What is written and where.
    pub write: WriteJob,
}

/// Where the matrices, the meaning of their rows and the nodes come from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "if" = { "properties": { "state": { "const": "preloaded" } }, "required": ["state"] },
    "then" = { "required": ["internal_forces"] },
    "else" = { "not": { "required": ["internal_forces"] } },
))]
pub struct ModelJob {
    /// File of K; inside an HDF5 file a group follows the colon: `model.h5:/K`.
    #[schemars(length(min = 1))]
    #[schemars(extend("x-role" = "place"))]
    pub stiffness: PathBuf,
    /// File of M; a static scene without gravity needs none.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place-of-one"))]
    pub mass: Option<PathBuf>,
    /// File that says which node and direction each row is.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place-of-one"))]
    pub dofs: Option<PathBuf>,
    /// File of the nodes: a table or a mesh.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place-of-one"))]
    pub nodes: Option<PathBuf>,
    /// File of the axes of nodes whose rows are along axes of their own: a table of the columns node, x1, x2, x3 for the direction of
    /// their x, and y1, y2, y3 for y. Results are along the axes of the model.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place-of-one"))]
    pub frames: Option<PathBuf>,
    /// The format of the files of K and M, where their content leaves several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<Layout>,
    /// The triangle of K and M that holds, where the other is incomplete.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symmetric: Option<Triangle>,
    /// What becomes of entries that repeat a position.
    #[serde(default, skip_serializing_if = "Duplicates::are_added")]
    #[schemars(extend("default" = "add", "x-role" = "place"))]
    pub duplicates: Duplicates,
    /// Whether rows without stiffness and mass are dropped; they are an error otherwise.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub drop_empty: bool,
    /// Significant digits that the numbers of the stiffness have, in place of those that they seem to have: 17 where they are exact or
    /// binary, 7 where they were computed in single precision. Of numbers that are added up, the digits of each.
    #[schemars(extend("minimum" = 1, "maximum" = MAX_DIGITS))]
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "super::whole::size")]
    pub stiffness_digits: Option<usize>,
    /// Significant digits that the numbers of the mass have, in place of those that they seem to have.
    #[schemars(extend("minimum" = 1, "maximum" = MAX_DIGITS))]
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "super::whole::size")]
    pub mass_digits: Option<usize>,
    /// Label of the unit system, copied to the superelement; no number is converted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<String>,
    /// Rotations that supports hold although they hold no translation; any other that costs energy then is an error.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "rotations")]
    #[schemars(schema_with = "rotations_schema")]
    pub held_rotations: Vec<Direction>,
    /// File of multipoint constraints, a Matrix Market file of a matrix G with G u = 0: a row for each constraint, a column for each row
    /// of K and M.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place-of-one"))]
    pub constraints: Option<PathBuf>,
    /// What becomes of constraints that resist rigid-body motion of the component.
    #[serde(default, skip_serializing_if = "ConstraintsToGround::are_refused")]
    #[schemars(extend("default" = "refuse"))]
    pub constraints_to_ground: ConstraintsToGround,
    /// What is said of motions inside the component that cost no energy.
    #[serde(default, skip_serializing_if = "Mechanisms::are_warned_of")]
    #[schemars(extend("default" = "warn"))]
    pub mechanisms: Mechanisms,
    /// The state that K is the tangent stiffness of.
    #[serde(default, skip_serializing_if = "ModelState::is_unloaded")]
    #[schemars(extend("default" = "unloaded"))]
    pub state: ModelState,
    /// File of the internal forces of a preloaded state, a value for each row of K: the forces and moments that the elements of the component
    /// take up at its nodes, the derivative of their energy. A Matrix Market file of one column.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place-of-one"))]
    pub internal_forces: Option<PathBuf>,
    /// What the user knows of the component, to be compared with what the matrices say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expect: Option<Expectation>,
    /// What the superelement whose matrices these are takes for granted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub assumes: Option<AssumesJob>,
}

/// Directions of which each is a rotation, none twice.
fn rotations<'de, D: serde::Deserializer<'de>>(deserializer: D) -> std::result::Result<Vec<Direction>, D::Error> {
    let directions = Vec::<Direction>::deserialize(deserializer)?;
    if let Some(other) = directions.iter().find(|direction| !direction.is_rotation()) {
        return Err(serde::de::Error::custom(format!("`{other}` is no rotation, expected rx, ry or rz")));
    }
    match first_repeated(&directions) {
        Some(twice) => Err(serde::de::Error::custom(format!("`{twice}` is listed twice, expected each rotation once"))),
        None => Ok(directions),
    }
}

/// What becomes of constraints that resist rigid-body motion, and so hold the component to the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum ConstraintsToGround {
    /// They are an error.
    #[default]
    Refuse,
    /// They are taken, with a warning.
    Accept,
}

impl ConstraintsToGround {
    fn are_refused(&self) -> bool {
        *self == Self::Refuse
    }
}

/// The state that K is the tangent stiffness of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ModelState {
    /// One without internal forces at the nodes: six rigid-body motions of a free body make no force.
    #[default]
    Unloaded,
    /// One with internal forces: translations make no force, and rotations turn the internal forces.
    Preloaded,
}

impl ModelState {
    fn is_unloaded(&self) -> bool {
        *self == Self::Unloaded
    }
}

/// What becomes of entries of a matrix that repeat a position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Duplicates {
    /// They are added, which is the rule of assembled formats; the report counts them.
    #[default]
    Add,
    /// They are an error.
    Refuse,
}

impl Duplicates {
    fn are_added(&self) -> bool {
        *self == Self::Add
    }
}

/// Mass properties known from elsewhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expectation {
    /// Total mass.
    #[schemars(extend("minimum" = SMALLEST, "maximum" = LARGEST))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cg: Option<[f64; 3]>,
}

/// What is written and where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WriteJob {
    /// The superelement file.
    #[schemars(regex(pattern = r"[^/]\.supel$"))]
    #[schemars(extend("x-role" = "place"))]
    pub superelement: PathBuf,
    /// The report; next to the superelement as `name.report.json` where absent.
    #[schemars(regex(pattern = r"[^/]\.json$"))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place"))]
    pub report: Option<PathBuf>,
    /// The report as a page for people, where it is wanted.
    #[schemars(regex(pattern = r"[^/]\.html$"))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place"))]
    pub html: Option<PathBuf>,
    /// The checks as JUnit XML, where they are wanted.
    #[schemars(regex(pattern = r"[^/]\.xml$"))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place"))]
    pub junit: Option<PathBuf>,
    /// Displacements inside the component that the superelement can recover, where they are wanted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recovery: Option<RecoveryJob>,
    /// Quantities that follow from displacements inside the component, stresses for instance, where they are wanted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantities: Option<QuantitiesJob>,
}

impl WriteJob {
    /// Where the report goes: as asked, or next to the superelement as `name.report.json`.
    pub fn report_path(&self) -> PathBuf {
        self.report.clone().unwrap_or_else(|| self.superelement.with_extension("report.json"))
    }
}

/// The directions that are rotations, each once.
fn rotations_schema(_: &mut SchemaGenerator) -> Schema {
    let names: Vec<String> =
        Direction::ALL.iter().filter(|direction| direction.is_rotation()).map(ToString::to_string).collect();
    json_schema!({ "type": "array", "items": { "enum": names }, "uniqueItems": true })
}
