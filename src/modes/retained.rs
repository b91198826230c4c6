//! The modes a method retains.

use crate::eigen::Modes;
use crate::job::Boundary;
use crate::partition::Partition;

/// The modes a method retains.
#[derive(Clone, Debug)]
pub struct Retained {
    /// The elastic modes.
    pub modes: Modes,
    /// The boundary they were computed under.
    pub boundary: Boundary,
}

impl Retained {
    /// Modes as the eigenproblem of a boundary has them. Those of mixed boundaries get rows of zeros for what was held, n'.
    pub fn new(partition: &Partition, modes: Modes, boundary: Boundary) -> Self {
        Self { modes: Modes { shapes: partition.whole_under(boundary, modes.shapes), ..modes }, boundary }
    }
}
