//! tmp
pub mod basis;
pub mod dense;
pub mod cli;
pub mod error;
pub mod factor;
pub mod input;
pub mod job;
pub mod model;
pub mod modes;
pub mod partition;
pub mod reduction;
pub mod rigid;
pub mod outcome;
pub mod report;
pub mod sparse;
pub mod verification;
