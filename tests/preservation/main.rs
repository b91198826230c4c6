//! What the report says the reduction preserves, against dense computations of the full model.

mod accuracy;
mod boundaries;
mod chosen;
mod faults;
mod oracle;
mod policy;
mod published;
mod response;
mod run;
mod statics;
mod threads;

use supel_testing::{chain, evidence};
