//! What leaves the tool: the superelement and the report, in the user's units.
//!
//! The stages work in scaled units; here, and only here, the powers of two are put back. Modal coordinates are scaled so
//! that named modes are mass-normalised in the user's units.

mod both;
mod expansion;
mod mode_rows;
mod recovery;
mod report;
mod results;
mod rigid_body;
mod scene;
mod soft_rotation;
mod superelement;
mod user_basis;
mod warnings;

pub use both::output;
pub use results::Results;
pub use superelement::job_document;
