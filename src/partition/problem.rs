//! The eigenproblems of a partition, its interface free or held.

use faer::{Mat, MatRef};

use super::partition::Partition;
use crate::eigen::{EnergyNoise, ModalProblem};

impl Partition {
    /// The eigenproblem with the interface free; nothing is deflated.
    pub fn free_problem(&self) -> ModalProblem<'_> {
        ModalProblem::of(self.pencil(), self.precision).with_noise(self)
    }

    /// The eigenproblem with the interface held.
    pub fn held_problem(&self) -> ModalProblem<'_> {
        ModalProblem::of(self.internal(), self.precision).with_noise(self)
    }
}

impl EnergyNoise for Partition {
    fn energy_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>> {
        (x.ncols() > 0 && self.has_few_digits()).then(|| Self::energy_noise(self, x))
    }
}

/// The entries of a partition's K at some of its dofs.
#[derive(Clone, Copy, Debug)]
pub struct EntriesAt<'a> {
    /// The partition.
    pub partition: &'a Partition,
    /// Its dofs that the pencil has, ascending.
    pub kept: &'a [usize],
}

impl EnergyNoise for EntriesAt<'_> {
    fn energy_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>> {
        if x.ncols() == 0 || !self.partition.has_few_digits() {
            return None;
        }
        let mut whole = Mat::zeros(self.partition.n_dofs(), x.ncols());
        for (row, dof) in self.kept.iter().enumerate() {
            (0..x.ncols()).for_each(|j| whole[(*dof, j)] = x[(row, j)]);
        }
        Some(self.partition.energy_noise(whole.as_ref()))
    }
}
