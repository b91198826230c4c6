//! Matrices written again in the formats of other programs, every bit kept, and meshes in that of VTK.
//!
//! A matrix that is symmetric to the bit is written as such. Numbers in text have as many digits as bring the double back.

mod by_columns;
mod content;
mod matlab;
mod matrix_market;
mod npz;
mod op4;
mod target;
mod vtkhdf;

pub use content::{Content, Shape};
pub(crate) use op4::LETTERS_OF_AN_OP4_NAME;
pub use target::Target;
pub use vtkhdf::write_mesh;
