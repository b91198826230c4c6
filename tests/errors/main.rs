//! Every error and every warning: a code, a line in `docs/errors.md`, and a test that provokes it.

mod advice;
mod documented;
mod outputs;
mod provoked;
mod rare;
mod resources;
mod warned;

use supel_testing::{chain, place};
