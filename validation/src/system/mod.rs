//! Modal components assembled into a mechanism.
//!
//! ```text
//! q   n = 6 k + Σ n_η   nodes of the mechanism, six each, then the amplitudes of each component
//! ```
//! A node's velocity is taken at the node and in its own axes, (Rᵀẋ; ω), so that "the node stays" is "the first three are
//! zero"; the component changes them to those of the point at the inertial origin, and its forces back.

mod assembly;
mod body;
mod configuration;
mod forces;

pub use assembly::{Load, System};
pub use body::Formulation;
pub use configuration::Configuration;
pub use forces::{Forces, Matrices};
