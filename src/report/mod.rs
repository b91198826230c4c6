//! The report: what was read, what was computed, what was checked, and what the run cost.
//!
//! The body depends on the job and its files alone: it is byte for byte the same for any number of threads, on any day
//! and in any folder. Times, memory, threads and paths are facts of the run and are kept apart from it.

mod assembly;
mod certification;
mod certified_result;
mod conclusion;
mod expansion;
mod html;
mod inspection;
mod json;
mod junit;
mod load;
pub(crate) mod mode_table;
pub(crate) mod page;
mod plan;
mod printable;
mod recorded;
mod reduction;
mod reductions;
mod rigid_body;
mod stages;
pub(crate) mod summary;
mod superelement;
pub(crate) mod table;
mod trust;
mod verification;
mod words;
mod written_with;

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Serialize;

use crate::cache;
use crate::error::Warning;
use crate::input::Digits;
use crate::number;
use crate::partition::HeldSelection;
use crate::rigid::RigidSource;
use crate::verification::check::{Check, Verdict};
use crate::verification::preservation::Preservation;

pub use assembly::ModesReport;
pub use certification::{CertificationReport, CertifiedModel, ResultReport};
pub use certified_result::CertifiedResult;
pub use conclusion::Reservations;
pub use expansion::{ExpansionReport, ExpansionRow};
pub use html::{escaped, html};
pub use inspection::inspection;
pub use junit::junit;
pub use load::{LoadReport, ResidualVector};
pub use page::Paint;
pub use plan::PlanReport;
pub(crate) use printable::json_text;
pub(crate) use printable::{field, is_plain_field, printable, value_text};
pub use recorded::{RecordedReport, RecordedVerdict};
pub use reduction::{
    DroppedCoordinate, FacesReport, InterfacePosition, InterfaceReport, ModeKind, ModeRow, PositionOrigin,
    ReductionReport, SkippedReport,
};
pub use reductions::{ComponentOutcome, ComponentRow, ErrorLine, JoinRow, ReductionsReport};
pub use rigid_body::{EffectiveMass, Grounding, MassRoute, RigidBodyEvidence};
pub use stages::{Observer, StageClock, StageTime};
pub use summary::summary;
pub use superelement::{ReducedReport, ReducedSource};
pub use trust::TrustInterval;
pub use verification::{Against, Reproduction, VerificationReport};
pub(crate) use words::file as file_words;
pub use words::unmet_check;
pub use written_with::WrittenWith;

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
    /// M; none where its file was not opened, because nothing asked depends on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<MatrixReport>,
    /// BLAKE3 digests of the other files by their role: `dofs`, `dofs_data` for what CalculiX wrote next to the map, `nodes`, `nodes_data` for what those refer to, `quantities` and
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
    /// What the run had of its cache; absent where it had none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cache: Option<cache::Tally>,
    /// Whether the run accepts warnings. The document has none of it: its verdict is the worst one.
    #[serde(skip)]
    pub reservations: Reservations,
}

/// What was done, counted; where results are those of earlier runs, what was done for these.
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
        self.verdict_with(self.warnings.len())
    }

    /// The verdict that a superelement keeps: without warnings of how it suits the scene, which a file for another scene need not have.
    /// What the scene accepts are checks, and count.
    pub fn verdict_of_reduction(&self) -> Verdict {
        self.verdict_with(self.warnings.iter().filter(|warning| !warning.is_of_scene()).count())
    }

    fn verdict_with(&self, n_warnings: usize) -> Verdict {
        let floor = match &self.completeness {
            Completeness::SturmCount { n_counted, n_found, .. } if n_counted != n_found => Verdict::Fail,
            Completeness::SturmCount { .. } if !self.completeness.is_certified() => Verdict::Warn,
            _ if n_warnings == 0 => Verdict::Pass,
            _ => Verdict::Warn,
        };
        self.checks.iter().map(Check::verdict).fold(floor, Verdict::max)
    }
}
