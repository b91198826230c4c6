//! The modes a method retains.

use crate::eigen::Modes;
use crate::job::Boundary;

/// The modes a method retains.
#[derive(Clone, Debug)]
pub struct Retained {
    /// The elastic modes.
    pub modes: Modes,
    /// The boundary they were computed under.
    pub boundary: Boundary,
}
