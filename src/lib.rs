//! tmp
pub mod error;
pub mod input;
pub mod job;
pub mod report;
pub mod sparse;
pub mod verification;
