//! The numerical examples of the paper, section 5, from finite element matrices to curves.
//!
//! Each example writes the matrices of linear beams, has supel reduce them, assembles the superelements as modal
//! components into a mechanism, and moves it. Equation and figure numbers are those of Sonneville, Brüls and Bauchau,
//! *Modal Reduction Procedures for Flexible Multibody Dynamics*.

pub mod beam;
pub mod claims;
pub mod curve;
pub mod examples;
pub mod figure;
pub mod film;
pub mod integrator;
pub mod joint;
pub mod page;
pub mod part;
pub mod pendulum;
mod saddle;
pub mod selection;
pub mod spinning;
pub mod statics;
pub mod study;
pub mod summary;
pub mod system;
pub mod verdict;
#[cfg(feature = "vtkhdf")]
pub mod vtkhdf;

/// What every step returns; the message is for a person.
pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error + Send + Sync>>;
