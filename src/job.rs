//! The job: one document that says what to read, how to reduce and what to write.
//!
//! Flags can give what a single run needs. Paths are relative to the folder of the document; [`Job::resolve`]
//! makes them absolute before any stage sees them. Unknown keys are errors.

mod accept;
mod added_mass;
mod damping;
mod document;
mod fixed;
mod held_interface;
mod interface;
mod load;
mod location;
mod matrix;
mod method;
mod node_selection;
mod quantities;
mod ranges;
mod reading;
mod recovery;
mod reduction;
mod scene;
mod schema;
mod selection;
mod shape;
mod types;
mod validation;
mod whole;

pub use crate::eigen::Eigensolver;
pub use accept::AcceptJob;
pub use added_mass::AddedMassJob;
pub use damping::{ComponentDampingJob, MassActsOn, ModalDampingJob, RayleighJob, RigidMotionDamping};
pub use document::Notation;
pub use fixed::FixedJob;
pub use held_interface::HeldInterface;
pub use interface::{Axes, AxesGiven, Coupling, InterfaceJob, Origin, Weights};
pub use load::{LoadJob, LoadPattern, RotationJob};
pub use location::Holder;
pub use matrix::MatrixJob;
pub use method::{Boundary, MassOf, Method, ModeOrigin};
pub use node_selection::{NodeSelection, Region};
pub use quantities::QuantitiesJob;
pub use recovery::RecoveryJob;
pub use reduction::{ModeSelection, ModesJob, ReductionJob};
pub use scene::{DampingJob, SceneJob, Support, boundary_in_words};
pub use schema::{Role, schema};
pub use selection::Selection;
pub(crate) use shape::nearest;
pub use types::{
    Certify, ConstraintsToGround, Duplicates, Expectation, Job, ModelJob, ModelState, Precision, RunJob, WriteJob,
};
pub(crate) use validation::ends_in;
