//! tmp
pub mod cli;
pub mod error;
pub mod input;
pub mod job;
pub mod outcome;
pub mod report;
pub mod sparse;
pub mod verification;
