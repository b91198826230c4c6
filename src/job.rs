//! The job: one document that says what to read, how to reduce and what to write.
//!
//! Everything in it can also be given by flags. Paths are relative to the folder of the document; [`Job::resolve`]
//! makes them absolute before any stage sees them. Unknown keys are errors.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::input::Direction;

/// A whole job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Job {
    /// The finite element model.
    pub model: ModelJob,
    /// The interface nodes, in the order of the reduced coordinates.
    #[serde(default, rename = "interface", skip_serializing_if = "Vec::is_empty")]
    pub interfaces: Vec<InterfaceJob>,
    /// Method and modes.
    pub reduction: ReductionJob,
    /// How the run is done; changes no result.
    #[serde(default)]
    pub run: RunJob,
    /// What is written and where.
    pub write: WriteJob,
}

/// Where the matrices, the meaning of their rows and the nodes come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelJob {
    /// File of K; inside an HDF5 file a group follows the colon: `model.h5:/K`.
    pub stiffness: PathBuf,
    /// File of M.
    pub mass: PathBuf,
    /// File that says which node and direction each row is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dofs: Option<PathBuf>,
    /// File of the nodes: a table or a mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nodes: Option<PathBuf>,
    /// Label of the unit system, copied to the superelement; no number is converted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<String>,
    /// What the user knows of the component, to be compared with what the matrices say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expect: Option<Expectation>,
}

/// Mass properties known from elsewhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expectation {
    /// Total mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cg: Option<[f64; 3]>,
}

/// One interface node of the superelement, or a set of nodes that all become interface nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InterfaceJob {
    /// Name, unique in the job.
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
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dofs: Option<Vec<Direction>>,
}

/// Nodes by label, by group, by region, or rows by number where the model has no nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum NodeSelection {
    /// `"group:HUB"`.
    Group(String),
    /// `[412, 413]`.
    Labels(Vec<i64>),
    /// `{ within = … }`.
    Region {
        /// The region that holds the nodes.
        within: Region,
    },
    /// `{ rows = [0, 1, 2] }`, zero-based, for a model without nodes.
    Rows {
        /// Row numbers of the matrices, from zero.
        rows: Vec<usize>,
    },
}

/// A region of space; a node belongs to it when it is inside or on the border.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
        tolerance: f64,
    },
    /// Finite cylinder, solid or (with an inner radius) a shell.
    Cylinder {
        /// Centre of one end.
        from: [f64; 3],
        /// Centre of the other end.
        to: [f64; 3],
        /// Outer radius.
        radius: f64,
        /// Inner radius.
        #[serde(default)]
        inner_radius: f64,
    },
    /// Ball.
    Sphere {
        /// Centre.
        center: [f64; 3],
        /// Radius.
        radius: f64,
    },
}

/// How nodes of the model couple to an interface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Coupling {
    /// The nodes' own degrees of freedom.
    #[default]
    Direct,
    /// One node of six degrees of freedom that moves the patch as a rigid body.
    Rigid,
}

/// Where the interface node of a rigid patch sits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Origin {
    /// `"centroid"`: the mean of the patch's nodes.
    #[default]
    #[serde(with = "centroid")]
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
        if word == "centroid" {
            Ok(())
        } else {
            Err(D::Error::custom("expected \"centroid\" or [x, y, z]"))
        }
    }
}

/// Method and modes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReductionJob {
    /// The method.
    pub method: Method,
    /// How many elastic modes.
    pub modes: ModeSelection,
    /// Which eigensolver finds them.
    #[serde(default)]
    pub eigensolver: Eigensolver,
}

/// The reduction method: which modes fill the dynamic mode matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Constraint modes and fixed-interface normal modes.
    CraigBampton,
    /// Constraint modes, inertia-relief modes and mode-accelerated free-free modes.
    Herting,
}

/// How many elastic modes are kept.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum ModeSelection {
    /// `{ count = 40 }`, extended to complete clusters.
    Count {
        /// The number.
        count: usize,
    },
    /// `{ up_to_hz = 1000 }`.
    UpTo {
        /// The highest frequency.
        up_to_hz: f64,
    },
}

/// Which eigensolver finds the modes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Eigensolver {
    /// Block Lanczos with thick restart.
    #[default]
    Lanczos,
    /// ARPACK-NG, an independent witness.
    Arpack,
}

/// How completeness of the modes is certified.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Certify {
    /// Not at all; the report says so.
    None,
    /// By a Sturm count above the highest mode.
    #[default]
    Count,
}

/// How the run is done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunJob {
    /// Certificate of completeness.
    #[serde(default)]
    pub certify: Certify,
    /// Memory the run may use, in GiB; what the machine has free where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_gib: Option<f64>,
}

/// What is written and where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WriteJob {
    /// The superelement file.
    pub superelement: PathBuf,
    /// The report; beside the superelement as `name.report.json` where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub report: Option<PathBuf>,
}
