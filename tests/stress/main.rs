//! The stress catalogue: models made to break a reduction, each with the outcome it must have.
//!
//! Outcomes are of three classes: right within a stated figure, a named warning, or a named error that says what to do.
//! Anything else is a failure. [`registry`] lists every line of the catalogue; it fails when a line has no test.

#[allow(dead_code, reason = "every table uses its part")]
mod oracle;
#[allow(dead_code, reason = "every table uses its part")]
mod program;

mod input;
mod mass;
mod registry;
mod scaling;
mod singularity;
mod spectrum;

use supel_testing::{chain, place};
