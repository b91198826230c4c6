//! `supel verify`: healthy files pass, files altered in any tensor and sealed again do not, nor do files of another model.

mod accepted;
mod degenerate;
mod document;
mod frames;
mod healthy;
mod model;
mod no_stiffness;
mod reproduced;
mod tampered;
mod tampering;

use supel_testing::place;
