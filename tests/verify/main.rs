//! `supel verify`: healthy files pass, files altered in any tensor and sealed again do not, nor do files of another model.

#[allow(dead_code, reason = "each test crate uses its part")]
#[path = "../end_to_end/place.rs"]
mod place;

mod degenerate;
mod document;
mod healthy;
mod model;
mod reproduced;
mod tampered;
mod tampering;
