//! A partition under the boundary that modes are computed under: which dofs are left, and K and M of these.

use faer::{Mat, MatRef};

use super::mixed_interface::{MixedInterface, MixedPencil};
use super::partition::Partition;
use crate::error::Result;
use crate::job::{Boundary, InterfacePart};
use crate::sparse::Pencil;

impl Partition {
    /// Resolves what a job holds of the interface while modes with mixed boundaries are computed.
    ///
    /// # Errors
    /// A direction that no node of the interface has.
    pub fn hold_for_modes(&mut self, held: &[InterfacePart]) -> Result<()> {
        self.mixed = Some(MixedInterface::new(&self.interface, held, [&self.stiffness, &self.mass])?);
        Ok(())
    }

    /// The boundary that modes are computed under where a method asks for one: with all of the interface held, or nothing, mixed boundaries
    /// are those of the held and of the free interface.
    pub fn boundary(&self, of_method: Boundary) -> Boundary {
        of_method.holding(self.modes_held().len(), self.n_interface())
    }

    /// Numbers of the interface dofs that are held while mixed-interface modes are computed, as the file names them.
    pub fn modes_held(&self) -> Vec<usize> {
        let held = self.mixed.as_ref().map_or(&[][..], |mixed| &mixed.held);
        (0..held.len()).filter(|dof| held[*dof]).collect()
    }

    /// For each interface dof whether a boundary holds it.
    pub fn held_under(&self, boundary: Boundary) -> Vec<bool> {
        match (boundary, &self.mixed) {
            (Boundary::MixedInterface, Some(mixed)) => mixed.held.clone(),
            (Boundary::FixedInterface, _) => vec![true; self.n_interface()],
            (Boundary::FreeInterface | Boundary::MixedInterface, _) => vec![false; self.n_interface()],
        }
    }

    /// The pencil of a truly mixed boundary.
    fn mixed_pencil(&self, boundary: Boundary) -> Option<&MixedPencil> {
        let is_mixed = boundary == Boundary::MixedInterface;
        self.mixed.as_ref().filter(|_| is_mixed).and_then(|mixed| mixed.pencil.as_ref())
    }

    /// Numbers of the interface dofs that mixed boundaries leave free; nothing under the other boundaries, which leave all or none.
    pub(crate) fn free_under(&self, boundary: Boundary) -> Option<&[usize]> {
        self.mixed_pencil(boundary).map(|pencil| pencil.free.as_slice())
    }

    /// K and M of the dofs that a boundary leaves free.
    pub fn pencil_under(&self, boundary: Boundary) -> Pencil<'_> {
        match (boundary, self.mixed_pencil(boundary)) {
            (_, Some(mixed)) => Pencil::new(&mixed.stiffness, &mixed.mass),
            (Boundary::FixedInterface, None) => self.internal(),
            (Boundary::FreeInterface | Boundary::MixedInterface, None) => self.pencil(),
        }
    }

    /// The dof of the partition that a row of [`Self::pencil_under`] is.
    pub fn dof_under(&self, boundary: Boundary, row: usize) -> usize {
        self.mixed_pencil(boundary).map_or(row, |pencil| pencil.kept[row])
    }

    /// Motions of mixed boundaries with the dofs that are held at rest, n' × k; those of other boundaries as they are.
    pub fn whole_under(&self, boundary: Boundary, x: Mat<f64>) -> Mat<f64> {
        match self.mixed_pencil(boundary) {
            Some(pencil) => pencil.whole(x.as_ref(), self.n_dofs()),
            None => x,
        }
    }

    /// Rows of motions that [`Self::pencil_under`] has of mixed boundaries, (n_I + n_F) × k; nothing under the other boundaries, whose
    /// modes have the rows of their pencil.
    pub fn rows_under(&self, boundary: Boundary, x: MatRef<'_, f64>) -> Option<Mat<f64>> {
        let kept = &self.mixed_pencil(boundary)?.kept;
        Some(Mat::from_fn(kept.len(), x.ncols(), |i, j| x[(kept[i], j)]))
    }

    /// Motions of n' rows for the roundings of K and M: those with the rows of a mixed boundary, whose number no other has.
    pub(super) fn with_all_dofs(&self, x: MatRef<'_, f64>) -> Option<Mat<f64>> {
        let pencil = self.mixed.as_ref()?.pencil.as_ref()?;
        (x.nrows() == pencil.kept.len()).then(|| pencil.whole(x, self.n_dofs()))
    }
}
