//! Matrices written again in the formats of other programs, every bit kept.
//!
//! A matrix that is symmetric to the bit is written as such. Numbers in text have as many digits as bring the double back.

mod by_columns;
mod content;
mod matlab;
mod matrix_market;
mod npz;
mod op4;
mod target;

pub use content::{Content, Shape};
pub use target::Target;
