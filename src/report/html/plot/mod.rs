//! Drawings of the report, as SVG without scripts and without anything from elsewhere.

mod axis;
mod boundaries;
mod chart;
mod effective_mass;
mod frequency_error;
mod mac;
mod response;
mod size_error;
mod stage_times;

pub(super) use axis::power_of_ten;
pub(super) use boundaries::boundaries;
pub(super) use effective_mass::effective_mass;
pub(super) use frequency_error::frequency_error;
pub(super) use mac::mac;
pub(super) use response::response;
pub(super) use size_error::size_error;
pub(super) use stage_times::stage_times;
