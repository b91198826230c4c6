//! Modes: the expansion modes V that the reduction method keeps.
//!
//! ```text
//! free-free modes             K x = λ M x on all dofs, rigid-body modes deflated
//! fixed-interface modes       K_II v = λ M_II v
//! mixed-interface modes       K x = λ M x without the interface dofs that are held, motions that pass deflated
//! ```
//! All come from the factor of K_II at shift zero. Eigenvalues are recomputed as Rayleigh quotients, whose error is the
//! square of the vector's; each carries the bar that rounding and the digits of the data put on it. Which modes, in which
//! slices, and certified how is decided here; [`crate::eigen`] finds them.

mod attachment;
mod boundary_problem;
mod certificate;
mod component;
mod counts;
mod coupling;
mod dense_spectrum;
mod earlier;
mod finite;
mod indefinite;
mod retained;
mod search;
mod slices;

pub use attachment::StaticSet;
pub(crate) use attachment::answers;
pub(crate) use boundary_problem::massive;
pub use boundary_problem::{AtShift, BoundaryProblem};
pub use certificate::{Certificate, CountedInterval, Mending, certified};
pub use component::Component;
pub use coupling::{Coupling, MAX_UNSEEN_COUPLING};
pub(crate) use coupling::{clusters, couplings};
pub use retained::Retained;
pub(crate) use search::mode_wish;
pub use search::{SLICED_FROM, Search};
pub use slices::{LARGEST_SEARCH, ModeSource, SLICE};
