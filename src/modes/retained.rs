//! The modes a method retains.

use super::boundary_problem::Boundary;
use crate::eigen::Modes;

/// The modes a method retains.
#[derive(Clone, Debug)]
pub struct Retained {
    /// The elastic modes.
    pub modes: Modes,
    /// The boundary they were computed under.
    pub boundary: Boundary,
}
