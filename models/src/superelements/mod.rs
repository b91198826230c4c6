//! Superelements that need no reduction.

#![allow(missing_docs, reason = "names and symbols say it")]

pub mod beam;
mod motions;
pub mod particle;
