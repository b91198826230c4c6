//! Coordinates and dof maps that do not belong to K: none of them may end as verified, whatever ties the interface.
//!
//! [`faults`] changes one thing of a sound model; [`table`] reduces the result with every coupling and method. What no
//! program can see from K, M, dof map and coordinates stands there too, and in `docs/what-the-report-proves.md`.

mod faults;
mod mass;
mod sound;
mod table;
mod thin;
mod told;

use supel_testing::{chain, place};
