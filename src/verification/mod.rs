//! Proof of what the reduction preserves.
//!
//! Verification never changes a result. It measures, names the equation and compares with a limit of the form
//! max(engineering, arithmetic, data). Each check says which of the three was active. Identifiers of checks are stable.

mod attached;
mod attachment;
pub mod catalogue;
pub mod check;
mod completeness;
mod conditioning;
pub(crate) mod damping;
mod directions;
mod eigenpairs;
mod enclosed;
mod enclosure;
mod evidence;
mod findings;
pub(crate) mod force;
mod grounding;
pub(crate) mod limits;
mod loads;
mod mass;
mod named_loads;
mod penalty;
mod place;
pub mod preservation;
mod probes;
mod reduced;
mod repeated;
mod residual;
mod rigid_body;
mod rigid_motion;
mod solves;
mod spectrum;
pub(crate) mod unseen;

pub use enclosure::{CountProof, Enclosures, enclosures, enclosures_where_asked};
pub use evidence::Evidence;
pub use findings::{Findings, RigidBody, verify, verify_statics};
pub use grounding::{Grounding, Restraint};
pub use loads::EffectiveMasses;
pub(crate) use mass::{
    comparable, expected_by_weight, not_comparable, of_a_body, of_inertia, of_parts, of_weighed_body,
};
pub(crate) use penalty::LARGEST_OF_MESHES;
pub use penalty::{Penalties, penalties};
pub(crate) use place::ALL_AXES;
pub use preservation::{Compared, fewest_modes, preservation, preservation_of_file};
pub use rigid_body::MassRoutes;
pub(crate) use rigid_body::mass_difference;
