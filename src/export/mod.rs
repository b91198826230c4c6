//! Exports: a superelement in the formats that other programs read.
//!
//! To add a format: its file, and its line in [`FORMATS`]. Numbers leave in the units of the model. No format verifies
//! anything; what the file records of its verification is for the caller to say.

mod assumed;
mod format;
mod job_text;
mod joined;
mod left_behind;
mod load_transformation;
mod matrix_market;
mod model_job;
mod names;
mod op4;
mod op4_binary;
mod op4_content;
mod strainless_motion;

pub use format::{ExportedFile, Format};
pub use joined::Joined;
pub use model_job::job_of;
pub use names::Names;

/// Every format, in the order in which help and documentation list them.
pub const FORMATS: [&dyn Format; 3] = [&matrix_market::MatrixMarket, &op4::Op4, &op4_binary::Op4Binary];
