//! Every error and every warning: a code, a line in `docs/errors.md`, and a test that provokes it.

mod advice;
#[path = "../chain/mod.rs"]
mod chain;
mod documented;
mod outputs;
#[path = "../end_to_end/place.rs"]
#[allow(dead_code, reason = "each test crate uses its part")]
mod place;
mod provoked;
mod rare;
mod resources;
mod warned;
