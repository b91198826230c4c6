//! The report: what was read, what was computed, what was checked, and what the run cost.
//!
//! The body depends on the job and its files alone: it is byte for byte the same for any number of threads, on any day
//! and in any folder. Times, memory, threads and paths are facts of the run and are kept apart from it.

mod assembly;
mod conclusion;
mod html;
mod inspection;
mod json;
mod junit;
mod load;
pub(crate) mod mode_table;
pub(crate) mod page;
mod printable;
mod rigid_body;
mod stages;
pub(crate) mod summary;
pub(crate) mod table;
mod trust;
mod verification;
mod words;

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Serialize;

use crate::error::Warning;
use crate::input::Digits;
use crate::job::{Coupling, Eigensolver, Method};
use crate::number;
use crate::partition::{Fit, HeldSelection};
use crate::rigid::RigidSource;
use crate::verification::check::{Check, Verdict};
use crate::verification::preservation::Preservation;

pub use assembly::ModesReport;
pub use html::{escaped, html};
pub use inspection::inspection;
pub use junit::{JunitWarnings, junit};
pub use load::{LoadReport, ResidualVector};
pub use page::Paint;
use printable::json_text;
pub(crate) use printable::{printable, value_text};
pub use rigid_body::{EffectiveMass, Grounding, MassRoute, RigidBodyEvidence};
pub use stages::{Observer, StageClock, StageTime};
pub use summary::summary;
pub use trust::TrustInterval;
pub use verification::{Against, Reproduction, VerificationReport};
pub use words::unmet_check;

/// Body and facts of one run; [`Report::to_json`] gives the document that `schemas/report.schema.json` describes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// What was read, computed and checked.
    pub body: ReportBody,
    /// What the run cost and where its files are.
    pub run: RunFacts,
}

/// What was read, computed and checked; the same for any thread count.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportBody {
    /// The program that wrote the report.
    pub generator: Generator,
    /// The finite element model as it was read.
    pub model: ModelReport,
    /// The reduction.
    pub reduction: ReductionReport,
    /// The measures, in the order of their identifiers.
    pub checks: Vec<Check>,
    /// What the user should know although no check failed.
    pub warnings: Vec<Warning>,
    /// Whether every mode of the band is known to have been found.
    pub completeness: Completeness,
    /// The intervals in which that is known.
    pub trust_intervals: Vec<TrustInterval>,
    /// The component as a rigid body.
    pub rigid_body: RigidBodyEvidence,
    /// The reduced model compared with the full one.
    pub preservation: Preservation,
}

/// The program that wrote the report.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Generator {
    /// Its name.
    pub name: &'static str,
    /// Its version.
    pub version: &'static str,
}

impl Default for Generator {
    fn default() -> Self {
        Self { name: env!("CARGO_PKG_NAME"), version: env!("CARGO_PKG_VERSION") }
    }
}

/// The finite element model as it was read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelReport {
    /// Degrees of freedom n: rows of K and M, held ones included.
    pub n_dofs: usize,
    /// Nodes, where the rows belong to nodes.
    pub n_nodes: Option<usize>,
    /// Bodies: connected components of K that can move.
    pub n_bodies: usize,
    /// What the job holds at rest; none where it holds nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held: Option<HeldReport>,
    /// K.
    pub stiffness: MatrixReport,
    /// M.
    pub mass: MatrixReport,
    /// BLAKE3 digests of the other files by their role: `dofs`, `nodes`, `nodes_data` for what those refer to, `quantities` and
    /// `quantity_names`.
    pub files: BTreeMap<&'static str, String>,
    /// What M says of the component as a rigid body.
    pub mass_properties: MassProperties,
    /// Motions without strain energy.
    pub rigid_body_modes: RigidBodyModes,
    /// Label of the unit system.
    pub units: Option<String>,
    /// What reading and checking did or found, one sentence each, without paths.
    pub notes: Vec<String>,
}

/// Dofs that the job holds at rest.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct HeldReport {
    /// How many, each counted once.
    pub n_dofs: usize,
    /// By which selections, in the order of the job.
    pub selections: Vec<HeldSelection>,
}

/// One matrix as it was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MatrixReport {
    /// Stored entries, both triangles counted.
    pub n_nonzeros: usize,
    /// How many digits or decimals the values carry.
    #[serde(flatten)]
    pub digits: Digits,
    /// BLAKE3 digest of the file's bytes.
    pub digest: String,
}

/// Mass properties; those that need coordinates or directions are absent without them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MassProperties {
    /// Total mass.
    pub mass: Option<f64>,
    /// Centre of mass.
    pub cg: Option<[f64; 3]>,
    /// Inertia tensor about the centre of mass.
    pub inertia: Option<[[f64; 3]; 3]>,
}

/// Motions without strain energy and where they come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct RigidBodyModes {
    /// How many.
    pub count: usize,
    /// From coordinates or from K.
    pub source: RigidSource,
}

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
    /// Loads that the superelement carries by name; absent where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<LoadReport>,
    /// Coordinates that were left out because others span them.
    pub dropped: Vec<DroppedCoordinate>,
    /// The elastic modes in ascending order.
    pub modes: Vec<ModeRow>,
}

impl ReductionReport {
    /// Residual vectors kept.
    pub fn n_residual_vectors(&self) -> usize {
        self.loads.iter().filter(|load| load.residual_vector == ResidualVector::Kept).count()
    }

    /// Coordinates that are none of the interface, of inertia relief, of an elastic mode or of a load: rigid-body motions of a
    /// component without an interface to carry them.
    pub fn n_rigid_body(&self) -> usize {
        let others = self.n_interface + self.n_inertia_relief + self.n_modes + self.n_residual_vectors();
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
}

/// Whether every mode of the band is known to have been found.
#[derive(Clone, Debug, PartialEq)]
pub enum Completeness {
    /// No certificate was computed.
    NotCertified {
        /// Why not, in a few words: `--certify none was asked`.
        reason: String,
    },
    /// A Sturm count below a shift, to be compared with the modes found.
    SturmCount {
        /// The shift as a frequency.
        below_hz: f64,
        /// Eigenvalues below it by the count, rigid-body modes included.
        n_counted: usize,
        /// Modes found below it, rigid-body modes included.
        n_found: usize,
        /// Pivot growth over the growth up to which the signs of the pivots are certain.
        doubt: f64,
    },
}

impl Completeness {
    /// True where a count proves that no mode is missing.
    pub fn is_certified(&self) -> bool {
        matches!(self, Self::SturmCount { n_counted, n_found, doubt, .. } if n_counted == n_found && *doubt <= 1.0)
    }

    /// The statement for people.
    pub fn statement(&self) -> String {
        match self {
            Self::NotCertified { reason } => format!("completeness of the modes is not certified: {reason}"),
            Self::SturmCount { below_hz, n_counted, n_found, doubt } if n_counted == n_found && *doubt > 1.0 => {
                format!(
                    "the modes are likely complete: a Sturm count finds {n_counted} below {} Hz and all were found, but its pivots \
                 grew {} times more than its signs can be trusted with",
                    number::quantity(*below_hz, 9),
                    number::quantity(*doubt, 2)
                )
            }
            Self::SturmCount { below_hz, n_counted, n_found, .. } if n_counted == n_found => format!(
                "the modes are complete: a Sturm count finds {n_counted} below {} Hz and all were found",
                number::quantity(*below_hz, 9)
            ),
            Self::SturmCount { below_hz, n_counted, n_found, .. } => format!(
                "the modes are incomplete: a Sturm count finds {n_counted} below {} Hz, found were {n_found}",
                number::quantity(*below_hz, 9)
            ),
        }
    }
}

/// What the run cost and where its files are.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RunFacts {
    /// Wall time of each stage, in order.
    pub stages: Vec<StageTime>,
    /// Largest resident memory of the process, where the system tells.
    pub peak_memory_bytes: Option<u64>,
    /// Size of the superelement file; absent where none was written.
    pub file_bytes: Option<u64>,
    /// BLAKE3 of the superelement file, as the file itself carries it; absent where none was written.
    pub file_digest: Option<String>,
    /// Working threads.
    pub n_threads: usize,
    /// What was done, counted.
    pub work: WorkCounters,
    /// The superelement file; absent where none was written.
    pub superelement: Option<PathBuf>,
    /// The report file.
    pub report: Option<PathBuf>,
}

/// What was done, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct WorkCounters {
    /// Numeric factorisations.
    pub n_factorisations: usize,
    /// Solves, counted by right-hand side.
    pub n_solves: usize,
    /// Restarts of the eigensolver.
    pub n_restarts: usize,
    /// Floating-point operations of the largest factorisation.
    pub factor_flops: f64,
    /// Entries of the largest factor L.
    pub factor_nonzeros: u64,
}

impl ReportBody {
    /// The worst verdict of the checks; with warnings at least [`Verdict::Warn`], with missing modes [`Verdict::Fail`].
    pub fn verdict(&self) -> Verdict {
        let floor = match &self.completeness {
            Completeness::SturmCount { n_counted, n_found, .. } if n_counted != n_found => Verdict::Fail,
            Completeness::SturmCount { .. } if !self.completeness.is_certified() => Verdict::Warn,
            _ if self.warnings.is_empty() => Verdict::Pass,
            _ => Verdict::Warn,
        };
        self.checks.iter().map(Check::verdict).fold(floor, Verdict::max)
    }
}
