//! What a report says of the reduction: its interfaces, its coordinates, its modes.

use serde::Serialize;

use super::expansion::ExpansionReport;
use super::load::{LoadReport, ResidualVector};
use crate::eigen::Eigensolver;
use crate::job::{Coupling, Method};
use crate::partition::{Fit, Frame};

/// The reduction and its modes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReductionReport {
    /// The method.
    pub method: Method,
    /// The eigensolver.
    pub eigensolver: Eigensolver,
    /// Interface nodes in the order of the reduced coordinates.
    pub interfaces: Vec<InterfaceReport>,
    /// Interface degrees of freedom n_B.
    pub n_interface: usize,
    /// Inertia-relief modes kept.
    pub n_inertia_relief: usize,
    /// Elastic modes kept.
    pub n_modes: usize,
    /// Order of the reduced matrices.
    pub n_reduced: usize,
    /// Rank of the reduced mass, where the method makes it singular; absent elsewhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_rank: Option<usize>,
    /// Interfaces, and directions of them, held while the modes were computed; absent with methods that are not told what to hold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modes_held: Option<Vec<String>>,
    /// The modes of a file; absent where the method computes its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expansion: Option<ExpansionReport>,
    /// Loads that the superelement carries by name; absent where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<LoadReport>,
    /// Coordinates that were left out: others span them, or nothing starts and nothing sees them.
    pub dropped: Vec<DroppedCoordinate>,
    /// What the scene let the run leave out; nothing where it asks for everything.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub skipped: Vec<SkippedReport>,
    /// The elastic modes in ascending order.
    pub modes: Vec<ModeRow>,
    /// Numbers of the modes that interface, outputs and loads neither excite nor observe, from one.
    pub unseen: Vec<usize>,
}

impl ReductionReport {
    /// Residual vectors kept.
    pub fn n_residual_vectors(&self) -> usize {
        self.loads.iter().filter(|load| load.residual_vector == ResidualVector::Kept).count()
    }

    /// Coordinates that are none of the interface, of inertia relief, of a mode or of a load: rigid-body motions of a
    /// component without an interface to carry them.
    pub fn n_rigid_body(&self) -> usize {
        let modes = self.n_modes + self.expansion.as_ref().map_or(0, ExpansionReport::n_kept);
        let others = self.n_interface + self.n_inertia_relief + modes + self.n_residual_vectors();
        self.n_reduced.saturating_sub(others)
    }
}

/// One interface of the superelement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InterfaceReport {
    /// Its name in the job.
    pub name: String,
    /// How the nodes couple.
    pub coupling: Coupling,
    /// Nodes of the model that belong to it.
    pub n_nodes: usize,
    /// Degrees of freedom of it.
    pub n_dofs: usize,
    /// Its nodes in the superelement; none where coordinates are unknown.
    pub at: Vec<InterfacePosition>,
}

/// Where a node of an interface is, in the units of the model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InterfacePosition {
    /// Label of the node of the model, where it is one.
    pub node: Option<i64>,
    /// Its place.
    pub position: [f64; 3],
    /// Where that comes from.
    pub origin: PositionOrigin,
    /// The faces of a patch whose place is the mean of its nodes, where the mesh has faces.
    pub faces: Option<FacesReport>,
    /// Why these faces are not known although the mesh has cells.
    pub faces_unknown: Option<String>,
    /// The cylinder or the sphere whose axis or centre it is.
    pub fit: Option<Fit>,
    /// Rotation matrix whose columns are its axes; none where they are those of the model.
    pub axes: Option<Frame>,
}

/// The faces all of whose nodes belong to a patch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FacesReport {
    /// How many.
    pub count: usize,
    /// Their area-weighted centroid, in the units of the model.
    pub centroid: [f64; 3],
    /// From the place of the interface node to that centroid.
    pub distance: f64,
}

/// Where the place of an interface node comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PositionOrigin {
    /// It is a node of the model.
    Node,
    /// The mean of the nodes of a patch, each counted once: no centroid of its faces.
    MeanOfNodes,
    /// The area-weighted centroid of the faces of a patch.
    CentroidOfFaces,
    /// The axis of a cylinder fitted to the nodes of a patch, in the middle of their extent.
    Hole,
    /// The centre of a sphere fitted to the nodes of a patch.
    Sphere,
    /// The job says it.
    Job,
}

/// A coordinate that was left out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct DroppedCoordinate {
    /// What it was: `mode 7`, `inertia relief 2`.
    pub coordinate: String,
    /// Why, with the number that decided.
    pub reason: String,
}

/// What the scene let a run leave out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SkippedReport {
    /// The rule by which: `K-1`.
    pub rule: String,
    /// What, in words.
    pub what: String,
}

/// One elastic mode.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ModeRow {
    /// Number of the mode, from one.
    pub index: usize,
    /// Natural frequency.
    pub frequency_hz: f64,
    /// The true frequency lies within plus or minus this.
    pub error_bar_hz: f64,
    /// Backward error of the eigenpair (M-01).
    pub backward_error: f64,
    /// What the mode contributes at the interface, to outputs and under loads, the largest of them: displacement, reaction or work in units of
    /// what the stiffness of that dof alone makes of the energy of the mode.
    pub coupling: f64,
    /// Its place when modes are ordered by that, from one.
    pub rank: usize,
    /// Under which boundary the mode was computed.
    pub kind: ModeKind,
    /// An interval that is proved to hold an eigenvalue, where `--certify full` asked for it.
    pub enclosure_hz: Option<[f64; 2]>,
}

/// Under which boundary a mode was computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ModeKind {
    /// Interface free: elastic modes of the component as it is.
    FreeInterface,
    /// Interface held: fixed-interface normal modes.
    FixedInterface,
    /// Some interface dofs held, the others free.
    MixedInterface,
}
