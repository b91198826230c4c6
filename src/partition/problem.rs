//! The eigenproblems of a partition, its interface free or held.

use faer::{Mat, MatRef};

use super::partition::Partition;
use crate::eigen::{EnergyNoise, ModalProblem};
use crate::job::Boundary;

impl Partition {
    /// The eigenproblem with the interface free; nothing is deflated.
    pub fn free_problem(&self) -> ModalProblem<'_> {
        ModalProblem::of(self.pencil(), self.precision).with_noise(self)
    }

    /// The eigenproblem with the interface held.
    pub fn held_problem(&self) -> ModalProblem<'_> {
        ModalProblem::of(self.internal(), self.precision).with_noise(self)
    }

    /// The eigenproblem of the dofs that a boundary leaves free; nothing is deflated.
    pub fn problem_under(&self, boundary: Boundary) -> ModalProblem<'_> {
        ModalProblem::of(self.pencil_under(boundary), self.precision).with_noise(self)
    }
}

impl EnergyNoise for Partition {
    fn energy_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>> {
        let whole = self.with_all_dofs(x);
        let x = whole.as_ref().map_or(x, Mat::as_ref);
        (x.ncols() > 0 && self.has_few_digits()).then(|| Self::energy_noise(self, x))
    }

    fn mass_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>> {
        let whole = self.with_all_dofs(x);
        let x = whole.as_ref().map_or(x, Mat::as_ref);
        if x.ncols() > 0 { Self::mass_noise(self, x) } else { None }
    }

    fn hidden_terms(&self, x: MatRef<'_, f64>) -> Vec<f64> {
        let whole = self.with_all_dofs(x);
        self.patch_terms(whole.as_ref().map_or(x, Mat::as_ref))
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

impl EntriesAt<'_> {
    /// A motion of the dofs that are kept, with the others at rest, n' × k.
    fn whole(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        let mut whole = Mat::zeros(self.partition.n_dofs(), x.ncols());
        for (row, dof) in self.kept.iter().enumerate() {
            (0..x.ncols()).for_each(|j| whole[(*dof, j)] = x[(row, j)]);
        }
        whole
    }
}

impl EnergyNoise for EntriesAt<'_> {
    fn energy_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>> {
        (x.ncols() > 0 && self.partition.has_few_digits()).then(|| self.partition.energy_noise(self.whole(x).as_ref()))
    }

    fn mass_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>> {
        if x.ncols() > 0 { self.partition.mass_noise(self.whole(x).as_ref()) } else { None }
    }

    fn hidden_terms(&self, x: MatRef<'_, f64>) -> Vec<f64> {
        self.partition.patch_terms(self.whole(x).as_ref())
    }
}
