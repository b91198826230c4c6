//! What a superelement says about itself besides its numbers.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::string::String;
use alloc::vec::Vec;
use core::num::NonZero;

use serde::{Deserialize, Serialize};

use crate::coordinate::Coordinate;
use crate::direction::Direction;
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
    /// Columns that were left out: others span them already, or nothing starts or sees them.
    pub dropped: Vec<DroppedColumn>,
    /// Name of each column of `load_vectors`.
    pub load_names: Vec<String>,
    /// What each row of the tensor `quantities` is. Absent from the file where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<Quantity>,
    /// What each matrix of the tensor `matrices` is. Absent from the file where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub matrices: Vec<NamedMatrix>,
    /// Interface coordinates that were held while mixed-interface modes were computed, ascending; the others were free. Absent from the
    /// file where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub modes_held: Vec<usize>,
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
    /// Every column that the reduction made: the coordinates, then what was left out.
    pub fn named_columns(&self) -> impl Iterator<Item = &Coordinate> {
        self.coordinates.iter().chain(self.dropped.iter().map(|dropped| &dropped.column))
    }

    /// Numbers of the modes that are no coordinates because nothing starts them and nothing sees them.
    pub fn unseen_modes(&self) -> impl Iterator<Item = usize> {
        let unseen = self.dropped.iter().filter(|dropped| dropped.cause == DropCause::Unseen);
        unseen.filter_map(|dropped| dropped.column.mode().map(|(mode, _)| mode))
    }

    /// A label for each interface node: its own in the model or, for a node that the reduction added, the next number from 1 that no other
    /// interface node has.
    pub fn interface_labels(&self) -> Vec<i64> {
        let taken: BTreeSet<i64> = self.interface_nodes.iter().filter_map(|node| node.label).collect();
        let mut free = (1..).filter(|label| !taken.contains(label));
        self.interface_nodes.iter().map(|node| node.label.or_else(|| free.next()).unwrap_or_default()).collect()
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
    /// Results that were parts of what earlier runs had kept for more than was asked: right to their error bars, but no other run has their
    /// last bits. Absent from the file where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parts_of_earlier_runs: Option<NonZero<u64>>,
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
    /// Constraint modes and mode-accelerated modes computed with some interface dofs held and the others free.
    MixedInterface,
    /// Constraint modes alone.
    Guyan,
    /// Mode acceleration with modes of the user's choice.
    ModeAcceleration,
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

/// A mode that was left out of the basis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DroppedColumn {
    /// The mode.
    pub column: Coordinate,
    /// Why it was left out.
    pub reason: String,
    /// Why nothing lacks it. Absent from the file where others span it.
    #[serde(default, skip_serializing_if = "DropCause::is_spanned")]
    pub cause: DropCause,
}

/// Why nothing lacks a column that was left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DropCause {
    /// Others span it.
    #[default]
    Spanned,
    /// It is a mode that neither interface, loads and gravity start nor outputs see: the coordinates move without it.
    Unseen,
}

impl DropCause {
    fn is_spanned(&self) -> bool {
        *self == Self::Spanned
    }
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
    /// Along what alone gravity may act on the component, in axes of the model: a direction of any length, or zero where it may not act at all.
    /// Absent from the file where it may act along anything.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<[f64; 3]>,
}

impl Validity {
    /// Sine of the angle up to which gravity acts along a direction: what the answer lacks of the deflection is as small a share of it.
    const ALONG: f64 = 0.01;

    /// Whether gravity may act as this acceleration in axes of the model.
    pub fn allows_gravity(&self, g: [f64; 3]) -> bool {
        let Some(along) = self.gravity else { return true };
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        // Vectors of any length: their largest entry is one before they are multiplied.
        let scaled = |vector: [f64; 3]| {
            let largest = vector.into_iter().fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
            vector.map(|entry| if largest > 0.0 { entry / largest } else { entry })
        };
        let square = |vector: [f64; 3]| vector.into_iter().map(|entry| entry * entry).sum::<f64>();
        let (along, g) = (scaled(along), scaled(g));
        // Without a direction nothing is along it.
        square(g) == 0.0
            || square(along) > 0.0 && square(cross(along, g)) <= Self::ALONG * Self::ALONG * square(along) * square(g)
    }
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
    /// The mass matrix is semidefinite: it cannot be factored, and an explicit integrator cannot be used. An implicit one needs numerical
    /// damping, because motions without mass follow at once.
    SingularMass,
    /// The stiffness is the tangent of a preloaded state: it lets translations pass and answers rotations with the forces of the preload
    /// that turn, so that the component may not turn far.
    Preloaded,
    /// The superelement was made for statics alone: it has neither a mass matrix nor modes, and cannot be used where anything accelerates.
    StiffnessOnly,
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
            Self::MixedInterface => "mixed-interface",
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
