//! What a pair of matrices is, on one page: `supel doctor`.
//!
//! A model is reduced without an interface to its lowest modes. Where a stage refuses it, the error becomes a finding with its remedy, and
//! the run goes on without what was refused: without the nodes, without the dof map, with K and M exchanged.

mod culprits;
mod document;
mod ends;
mod examined;
mod finding;
mod fitted_surface;
mod interfaces;
mod patches;
mod proposal;
mod retreat;
mod sizes;
mod surface;
mod text;
mod units;
mod units_finding;

pub use culprits::{Culprit, Grounded};
pub use examined::{Examination, Examined, N_MODES};
pub use finding::{Finding, Severity};
pub use fitted_surface::Surface;
pub use interfaces::Candidate;
pub use patches::SurfacePatch;
pub use proposal::proposal;
pub use retreat::{Retreat, is_of_model};
pub use units::{UnitGuess, Units};
