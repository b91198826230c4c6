//! The job: one document that says what to read, how to reduce and what to write.
//!
//! Flags can give what a single run needs. Paths are relative to the folder of the document; [`Job::resolve`]
//! makes them absolute before any stage sees them. Unknown keys are errors.

mod accept;
mod added_mass;
mod analysis;
mod assumes;
mod carrier;
mod damping;
mod document;
mod fixed;
mod gravity;
mod interface;
mod interface_part;
mod layout;
mod load;
mod location;
mod matrix;
mod mechanisms;
mod method;
mod node_selection;
mod outputs;
mod quantities;
mod ranges;
mod reading;
mod recovery;
mod reduction;
mod scene;
mod scene_validation;
mod schema;
mod selection;
mod shape;
mod statements;
mod support;
mod types;
mod validation;
mod whole;

pub use crate::eigen::Eigensolver;
pub use accept::AcceptJob;
pub use added_mass::AddedMassJob;
pub use analysis::AnalysisJob;
pub use assumes::{AssumesJob, unseen_hz};
pub use carrier::CarrierJob;
pub use damping::{ComponentDampingJob, MassActsOn, ModalDampingJob, RayleighJob, RigidMotionDamping};
pub use document::Notation;
pub(crate) use document::{text_of, toml_failure};
pub use fixed::FixedJob;
pub use gravity::GravityJob;
pub use interface::{Axes, AxesGiven, Coupling, InterfaceJob, Origin, Weights};
pub use interface_part::InterfacePart;
pub use layout::Layout;
pub use load::{LoadJob, LoadPattern, RotationJob};
pub use location::Holder;
pub use matrix::MatrixJob;
pub use mechanisms::Mechanisms;
pub use method::{Boundary, MassOf, Method, ModeOrigin};
pub use node_selection::{NodeSelection, Region};
pub use outputs::OutputsJob;
pub use quantities::QuantitiesJob;
pub use recovery::RecoveryJob;
pub use reduction::{ModeSelection, ModesJob, ReductionJob};
pub use scene::{DampingJob, SceneJob};
pub use schema::{Role, schema};
pub use selection::Selection;
pub(crate) use shape::nearest;
pub use statements::DofUse;
pub use support::{Support, boundary_in_words};
pub use types::{
    Certify, ConstraintStorage, ConstraintsToGround, Duplicates, Expectation, Job, ModelJob, ModelState, Precision,
    RunJob, Skip, WriteJob,
};
pub(crate) use validation::ends_in;
