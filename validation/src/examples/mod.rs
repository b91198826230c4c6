//! The five examples of section 5.

pub mod bend;
pub mod crank;
pub mod elbow;
mod example;
pub mod rotating;
mod run;
pub mod spherical;
mod variant;

pub use crate::part::reduced_parts;
pub use example::Example;
pub use run::Run;
pub use variant::{Variant, classical, motion_based};
