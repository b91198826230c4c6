//! What the report says the reduction preserves, against dense computations of the full model.

mod boundaries;
#[path = "../chain/mod.rs"]
mod chain;
#[allow(dead_code, reason = "each test crate uses its part")]
#[path = "../measures/evidence.rs"]
mod evidence;
mod faults;
mod oracle;
mod policy;
mod published;
mod response;
mod run;
mod statics;
mod threads;
