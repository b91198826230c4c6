//! Calls of the system that fail, one after the other: the program ends as its contract says, and its files are those of one run.
//!
//! A shared object made of `shim.c` is preloaded; Linux with a C compiler is needed, which the program itself needs to be built.
#![cfg(all(target_os = "linux", target_env = "gnu"))]

mod files;
mod memory;
mod shim;
mod streams;

use supel_testing::place;
