//! The stress catalogue: models made to break a reduction, each with the outcome it must have.
//!
//! Outcomes are of three classes: right within a stated figure, a named warning, or a named error that says what to do.
//! Anything else is a failure. [`registry`] lists every line of the catalogue; it fails when a line has no test.

#[path = "../chain/mod.rs"]
mod chain;
#[allow(dead_code, reason = "every table uses its part")]
mod oracle;
#[path = "../end_to_end/place.rs"]
#[allow(dead_code, reason = "every table uses its part")]
mod place;
#[allow(dead_code, reason = "every table uses its part")]
mod program;

mod input;
mod mass;
mod registry;
mod scaling;
mod singularity;
mod spectrum;
