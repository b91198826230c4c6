//! The modes a method retains.

use super::coupling::{Coupling, couplings};
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
    /// What each contributes; empty where nobody has asked.
    pub couplings: Vec<Coupling>,
}

impl Retained {
    /// Modes as they are.
    pub fn of(modes: Modes, boundary: Boundary) -> Self {
        Self { modes, boundary, couplings: Vec::new() }
    }

    /// Modes as the eigenproblem of a boundary has them. Those of mixed boundaries get rows of zeros for what was held, n'.
    pub fn new(partition: &Partition, modes: Modes, boundary: Boundary) -> Self {
        Self::of(Modes { shapes: partition.whole_under(boundary, modes.shapes), ..modes }, boundary)
    }

    /// These modes with what each contributes; `gravity` is the one direction in which it acts, zero where it acts in none.
    pub fn ranked(self, partition: &Partition, gravity: Option<[f64; 3]>) -> Self {
        let couplings = couplings(partition, (&self.modes, self.boundary), gravity);
        Self { couplings, ..self }
    }
}
