//! Calls of the system that fail, one after the other: the program ends as its contract says, and its files are those of one run.
//!
//! A shared object made of `shim.c` is preloaded; Linux with a C compiler is needed, which the program itself needs to be built.
#![cfg(all(target_os = "linux", target_env = "gnu"))]

mod files;
mod memory;
#[path = "../end_to_end/place.rs"]
#[allow(dead_code, reason = "each test crate uses its part")]
mod place;
mod shim;
mod streams;
