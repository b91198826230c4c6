//! What the eigenproblem of one boundary is made of, and where its entries come from.

use faer::{Mat, MatRef};

use crate::factor::Pencil;
use crate::model::Precision;
use crate::partition::Partition;
use crate::rigid::RigidBodyModes;
use crate::sparse::Leading;

/// A symmetric pencil whose modes are wanted, with what is deflated.
#[derive(Clone, Copy, Debug)]
pub struct ModalProblem<'a> {
    /// K, n × n.
    pub stiffness: Leading<'a>,
    /// M, n × n.
    pub mass: Leading<'a>,
    /// Rigid-body modes of the same dofs, where the component is free.
    pub rigid: Option<&'a RigidBodyModes>,
    /// Relative precision of the data.
    pub precision: Precision,
    /// Where the entries of K come from, where that is known.
    pub data: Option<DataSource<'a>>,
}

impl<'a> ModalProblem<'a> {
    /// That of a pencil, with its rigid-body modes where it is free.
    pub fn of(pencil: Pencil<'a>, rigid: Option<&'a RigidBodyModes>, precision: Precision) -> Self {
        let Pencil { stiffness, mass } = pencil;
        Self { stiffness, mass, rigid, precision, data: None }
    }

    /// That of a partition with its interface free.
    pub fn free(partition: &'a Partition, rigid: Option<&'a RigidBodyModes>) -> Self {
        let data = Some(DataSource { partition, kept: None });
        Self { data, ..Self::of(partition.pencil(), rigid, partition.precision) }
    }

    /// That of a partition with its interface held.
    pub fn held(partition: &'a Partition) -> Self {
        let data = Some(DataSource { partition, kept: None });
        Self { data, ..Self::of(partition.internal(), None, partition.precision) }
    }

    /// The same with entries of K that are those of a partition at these dofs, ascending.
    pub fn with_entries_of(self, partition: &'a Partition, kept: &'a [usize]) -> Self {
        Self { data: Some(DataSource { partition, kept: Some(kept) }), ..self }
    }

    /// K and M.
    pub fn pencil(&self) -> Pencil<'a> {
        Pencil { stiffness: self.stiffness, mass: self.mass }
    }
}

/// The partition whose entries a pencil has.
#[derive(Clone, Copy, Debug)]
pub struct DataSource<'a> {
    partition: &'a Partition,
    /// Its dofs that the pencil has, ascending; all leading ones where nothing is said.
    kept: Option<&'a [usize]>,
}

impl DataSource<'_> {
    /// What the digits of K leave open of xᵀKx, where they are few.
    pub(super) fn energy_noise(&self, x: MatRef<'_, f64>) -> Option<Vec<f64>> {
        if x.ncols() == 0 || !self.partition.has_few_digits() {
            return None;
        }
        Some(self.of_partition(x, Partition::energy_noise))
    }

    /// Terms of xᵀKx that rigid patches have taken up.
    pub(super) fn patch_terms(&self, x: MatRef<'_, f64>) -> Vec<f64> {
        self.of_partition(x, Partition::patch_terms)
    }

    fn of_partition(&self, x: MatRef<'_, f64>, of: impl Fn(&Partition, MatRef<'_, f64>) -> Vec<f64>) -> Vec<f64> {
        let Some(kept) = self.kept else { return of(self.partition, x) };
        let mut whole = Mat::zeros(self.partition.n_dofs(), x.ncols());
        for (row, dof) in kept.iter().enumerate() {
            (0..x.ncols()).for_each(|j| whole[(*dof, j)] = x[(row, j)]);
        }
        of(self.partition, whole.as_ref())
    }
}
