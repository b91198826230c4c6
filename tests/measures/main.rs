//! The measures of the report: no false alarm on healthy models, and for every measure a fault that it finds.
//!
//! A fault is put into the evidence itself – a mode, a column of Ψ_S, an entry of K̂ – so that nothing but the checks can
//! notice it: the checker is checked.

mod clusters;
mod digits;
mod error_bars;
mod facts;
mod faults;
mod grounded;
mod healthy;
mod roundings;
mod scales;

use supel_testing::{cases, chain, evidence};
