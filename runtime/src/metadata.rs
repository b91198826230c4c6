//! What a superelement says about itself besides its numbers.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::further_matrix::NamedMatrix;

/// The metadata document, without format version and digest, which writer and reader handle themselves.
///
/// Its JSON form follows `schemas/superelement.schema.json`. Every number must be finite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Metadata {
    /// The program that made the superelement.
    pub generator: Generator,
    /// The reduction method.
    pub method: Method,
    /// Label of the unit system, for example `mm-t-s`; no number depends on it.
    pub units: Option<String>,
    /// The interface nodes, in the order of the coordinates.
    pub interface_nodes: Vec<InterfaceNode>,
    /// What each of the r reduced coordinates is: first the dofs of the interface nodes, node by node, then interface
    /// rows, then modal amplitudes.
    pub coordinates: Vec<Coordinate>,
    /// Modes that were left out because others span them already.
    pub dropped: Vec<DroppedColumn>,
    /// Name of each column of `load_vectors`.
    pub load_names: Vec<String>,
    /// What each row of the tensor `quantities` is. Absent from the file where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<Quantity>,
    /// What each matrix of the tensor `matrices` is. Absent from the file where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub matrices: Vec<NamedMatrix>,
    /// What the superelement may be used for.
    pub validity: Validity,
    /// Properties that a client must know before it uses the matrices.
    pub flags: BTreeSet<Flag>,
    /// The model that was reduced.
    pub model: ModelSummary,
    /// BLAKE3 digest of each input file, 64 lower-case hexadecimal digits, by its role (`stiffness`, `mass`, …).
    pub inputs: BTreeMap<String, String>,
    /// The resolved job, as the generator writes it.
    pub job: serde_json::Value,
    /// What the verification said when the superelement was made.
    pub verification: Verification,
}

impl Metadata {
    /// Every column that the reduction made: the coordinates, then what was left out because others span it.
    pub fn named_columns(&self) -> impl Iterator<Item = &Coordinate> {
        self.coordinates.iter().chain(self.dropped.iter().map(|dropped| &dropped.column))
    }
}

/// A program and its version.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Generator {
    /// Name of the program.
    pub name: String,
    /// Version of the program.
    pub version: String,
}

/// The reduction method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Constraint modes and fixed-interface normal modes.
    CraigBampton,
    /// Constraint modes, inertia-relief modes and mode-accelerated free-free modes.
    Herting,
    /// Residual attachment modes and free-free modes, in Herting's variables.
    Rubin,
    /// Rubin's without residual mass.
    Macneal,
    /// Constraint modes alone.
    Guyan,
    /// Mode acceleration with modes of the user's choice.
    ModeAcceleration,
}

/// The direction of a degree of freedom, in the order of the classical six.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Translation along x.
    Ux,
    /// Translation along y.
    Uy,
    /// Translation along z.
    Uz,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}

/// The six unit motions of a free body, the columns of U of equation (8): translations first, then rotations about the origin.
pub const MOTIONS: [&str; 6] = [
    "translation along x",
    "translation along y",
    "translation along z",
    "rotation about x",
    "rotation about y",
    "rotation about z",
];

impl Direction {
    /// All six, in order; their places are the numbers in `recovery_dofs`.
    pub const ALL: [Self; 6] = [Self::Ux, Self::Uy, Self::Uz, Self::Rx, Self::Ry, Self::Rz];

    /// The axis 0, 1 or 2.
    pub fn axis(self) -> usize {
        self as usize % 3
    }

    /// True for a rotation.
    pub fn is_rotation(self) -> bool {
        self as usize >= 3
    }
}

impl core::fmt::Display for Direction {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(["ux", "uy", "uz", "rx", "ry", "rz"][*self as usize])
    }
}

/// A node at which the superelement is joined to others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InterfaceNode {
    /// Name of the interface; several nodes may share it.
    pub name: String,
    /// Label of the node in the model; none for a node that the reduction added.
    pub label: Option<i64>,
    /// Its degrees of freedom, any subset of the six in their order.
    pub dofs: Vec<Direction>,
    /// Its position in the reference configuration, equal to its row of `interface_positions`.
    pub position: [f64; 3],
}

/// What one reduced coordinate is.
///
/// `mode` counts the entries of `frequencies` from 0. Where the tensor `mixing` is present the modal coordinates name
/// the columns *before* mixing: stored dynamic modes = named modes · mixing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Coordinate {
    /// Displacement or rotation of an interface node.
    Interface {
        /// Number of the interface node, from 0.
        node: usize,
        /// Direction.
        direction: Direction,
    },
    /// Displacement of an interface row of a model that has no nodes.
    InterfaceRow {
        /// Row of the model's matrices, from 0.
        row: u64,
    },
    /// Amplitude of a rigid-body mode, in a component without interface.
    RigidBodyMode {
        /// Number of the rigid-body mode, from 0.
        index: usize,
    },
    /// Amplitude of an inertia-relief mode.
    InertiaRelief {
        /// Number of the rigid-body mode whose inertia loads it answers, from 0.
        index: usize,
    },
    /// Amplitude of a mode-accelerated expansion mode: the static answer to the inertia forces of a mode that a file gave.
    ExpansionMode {
        /// Column of the file, from 0.
        column: usize,
    },
    /// Amplitude of a residual vector, the static answer to a load.
    ResidualVector {
        /// Number of the load among `load_names`, from 0.
        load: usize,
    },
    /// Amplitude of a free-free normal mode.
    ElasticMode {
        /// Number of the mode.
        mode: usize,
        /// Natural frequency.
        frequency_hz: f64,
        /// Bound of the error of the natural frequency.
        error_bar_hz: Option<f64>,
    },
    /// Amplitude of a fixed-interface normal mode.
    FixedInterfaceMode {
        /// Number of the mode.
        mode: usize,
        /// Natural frequency.
        frequency_hz: f64,
        /// Bound of the error of the natural frequency.
        error_bar_hz: Option<f64>,
    },
}

impl Coordinate {
    /// True for u_B, false for η.
    pub fn is_interface(&self) -> bool {
        matches!(self, Self::Interface { .. } | Self::InterfaceRow { .. })
    }

    /// What the amplitude of a mode is called in messages, counted from one: `mode 3`, `residual vector of thrust`; none for an interface
    /// coordinate. `load_names` are those of the file.
    pub fn mode_name(&self, load_names: &[String]) -> Option<String> {
        Some(match self {
            Self::Interface { .. } | Self::InterfaceRow { .. } => return None,
            Self::RigidBodyMode { index } => format!("rigid-body mode {}", index + 1),
            Self::InertiaRelief { index } => format!("inertia relief {}", index + 1),
            Self::ExpansionMode { column } => format!("expansion mode {}", column + 1),
            Self::ResidualVector { load } => {
                format!("residual vector of {}", load_names.get(*load).map_or("no load", String::as_str))
            }
            Self::ElasticMode { mode, .. } | Self::FixedInterfaceMode { mode, .. } => format!("mode {}", mode + 1),
        })
    }

    /// Number of the mode and its frequency in Hz, for a coordinate that has them.
    pub fn mode(&self) -> Option<(usize, f64)> {
        match *self {
            Self::ElasticMode { mode, frequency_hz, .. } | Self::FixedInterfaceMode { mode, frequency_hz, .. } => {
                Some((mode, frequency_hz))
            }
            _ => None,
        }
    }
}

/// A mode that was left out of the basis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DroppedColumn {
    /// The mode.
    pub column: Coordinate,
    /// Why it was left out.
    pub reason: String,
}

/// A quantity that follows from the displacements inside the component: a stress, a strain, the elongation of a spring.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// Its name, by which it is told from the others.
    pub name: String,
    /// Its unit; empty where nobody said it. No number depends on it.
    pub unit: String,
}

/// What the superelement may be used for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Validity {
    /// Lowest and highest frequency of excitation for which it was made.
    pub band_hz: Option<[f64; 2]>,
    /// What was taken for granted about the simulation, one sentence each.
    pub assumptions: Vec<String>,
    /// Interface dofs on which no load may act: the reduction was told that none does. Absent from the file where there are
    /// none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unloaded: Vec<InterfaceDof>,
}

/// A degree of freedom of an interface node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InterfaceDof {
    /// Number of the interface node, from 0.
    pub node: usize,
    /// Direction.
    pub direction: Direction,
}

/// A property that a client must know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Flag {
    /// The mass matrix is semidefinite: it cannot be factored, and an explicit integrator cannot be used.
    SingularMass,
}

/// The model that was reduced.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelSummary {
    /// Degrees of freedom, without those that were held.
    pub n_dofs: u64,
    /// What the columns of `rigid_body_modes` are.
    pub rigid_body_modes: RigidBodyModes,
    /// Mass, centre of mass and inertia; none where the model has no coordinates to tell them.
    pub mass_properties: Option<MassProperties>,
}

/// What the columns of `rigid_body_modes` are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RigidBodyModes {
    /// For each component of the model three unit translations along x, y, z and three unit rotations about the axes
    /// through the model's origin.
    Geometric,
    /// A basis of the null space of the stiffness matrix, with no geometric meaning.
    Algebraic,
}

/// Mass, centre of mass and inertia of a component, in the model's units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MassProperties {
    /// Total mass.
    pub mass: f64,
    /// Centre of mass, in the model's frame.
    pub center_of_mass: [f64; 3],
    /// Inertia tensor about the centre of mass, in the directions of the model's frame.
    pub inertia: [[f64; 3]; 3],
}

/// What the verification said.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Verification {
    /// The whole of it, no better than the worst check.
    pub verdict: Verdict,
    /// Its lines.
    pub checks: Vec<CheckSummary>,
}

/// One line of the verification.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckSummary {
    /// Stable identifier, `M-05`.
    pub id: String,
    /// The measured value; none where it was not a finite number.
    pub value: Option<f64>,
    /// The limit it was judged by.
    pub limit: f64,
    /// What was said.
    pub verdict: Verdict,
}

/// What a check says, from good to bad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Within the limit.
    Pass,
    /// Past the limit, not past the point of failure.
    Warn,
    /// Past the point of failure.
    Fail,
}

impl Method {
    /// Its name in reports, after those who published it.
    pub fn name(self) -> &'static str {
        match self {
            Self::CraigBampton => "Craig-Bampton",
            Self::Herting => "Herting",
            Self::Rubin => "Rubin",
            Self::Macneal => "MacNeal",
            Self::Guyan => "Guyan",
            Self::ModeAcceleration => "mode acceleration",
        }
    }
}

impl Verdict {
    /// The worst of several verdicts, `Pass` for none.
    pub fn worst(verdicts: impl IntoIterator<Item = Self>) -> Self {
        verdicts.into_iter().max().unwrap_or(Self::Pass)
    }
}
