//! What the report says the reduction preserves, against dense computations of the full model.

mod boundaries;
#[path = "../chain/mod.rs"]
mod chain;
mod faults;
mod oracle;
mod policy;
mod published;
mod response;
mod run;
mod statics;
mod threads;
