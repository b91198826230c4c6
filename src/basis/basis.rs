//! The modal reduction matrix.

use faer::prelude::ReborrowMut;
use faer::{Mat, MatRef};

use super::dynamic::{self, DroppedColumn, DynamicColumns, DynamicCoordinate};
use crate::constraint::{ConstraintModes, StaticModes};
use crate::dense;
use crate::eigen::Modes;
use crate::error::{Error, Result};
use crate::sparse::Leading;

/// The modal reduction matrix in its blocks.
#[derive(Clone, Debug)]
pub struct Basis<'a> {
    /// Ψ_S, n_I × n_B; Rubin's static modes Ψ_R where K_II is singular.
    pub constraint_modes: StaticModes<'a>,
    /// Ψ_D, n_I × n_η, M_II-orthonormal.
    pub dynamic_modes: Mat<f64>,
    /// What each column of Ψ_D is.
    pub coordinates: Vec<DynamicCoordinate>,
    /// R, n_η × (n_η + dropped): named column j = Σ_i Ψ_D[:, i] R_ij; upper triangular in the columns that were kept.
    pub mixing: Mat<f64>,
    /// Number, among the named columns, of each column that was kept.
    pub kept: Vec<usize>,
    /// Columns that depend on others and were left out.
    pub dropped: Vec<DroppedColumn>,
}

impl<'a> Basis<'a> {
    /// Puts constraint modes and dynamic columns together; dependent columns are left out by name.
    pub fn new(constraint: &ConstraintModes<'a>, columns: &DynamicColumns, internal_mass: Leading<'_>) -> Self {
        Self::keeping(constraint, columns, (internal_mass, &[]))
    }

    /// The basis with these of the named columns, whatever is left of their length.
    pub(super) fn keeping(
        constraint: &ConstraintModes<'a>,
        columns: &DynamicColumns,
        (internal_mass, asked): (Leading<'_>, &[usize]),
    ) -> Self {
        let independent = dynamic::independent(columns, internal_mass, asked);
        Self {
            constraint_modes: constraint.modes.clone(),
            dynamic_modes: independent.modes,
            coordinates: independent.coordinates,
            mixing: independent.mixing,
            kept: independent.kept,
            dropped: independent.dropped,
        }
    }

    /// The basis where it has any columns.
    ///
    /// # Errors
    /// [`Error::NothingLeft`].
    pub fn with_coordinates(self) -> Result<Self> {
        if self.n_reduced() == 0 { Err(Error::NothingLeft) } else { Ok(self) }
    }

    /// The rigid-body modes in modal coordinates where they are columns of their own, n_η × n_r; none where the interface carries them.
    pub(crate) fn rigid_amplitudes(&self) -> Option<MatRef<'_, f64>> {
        let left_out = self.dropped.iter().map(|column| &column.coordinate);
        let named = self.coordinates.iter().chain(left_out);
        let count = named.filter(|coordinate| matches!(coordinate, DynamicCoordinate::RigidBody(_))).count();
        // They come first.
        (count > 0).then(|| self.mixing.as_ref().subcols(0, count))
    }

    /// n_η.
    pub fn n_dynamic(&self) -> usize {
        self.dynamic_modes.ncols()
    }

    /// Residual vectors among the named columns, kept or not; they come last.
    fn n_residual_vectors(&self) -> usize {
        let left_out = self.dropped.iter().map(|column| &column.coordinate);
        let named = self.coordinates.iter().chain(left_out);
        named.filter(|coordinate| matches!(coordinate, DynamicCoordinate::ResidualVector(_))).count()
    }

    /// n_B + n_η.
    pub fn n_reduced(&self) -> usize {
        self.constraint_modes.n_interface() + self.n_dynamic()
    }

    /// Ψ q: motions of the component from reduced coordinates, n' × k.
    pub(crate) fn expanded(&self, coordinates: MatRef<'_, f64>) -> Mat<f64> {
        let (n_i, n_b) = (self.constraint_modes.n_internal(), self.constraint_modes.n_interface());
        let (q_b, eta) = coordinates.split_at_row(n_b);
        let mut motions = Mat::zeros(n_i + n_b, coordinates.ncols());
        motions.as_mut().subrows_mut(n_i, n_b).copy_from(q_b);
        let mut internal = motions.as_mut().subrows_mut(0, n_i);
        self.constraint_modes.add_followed(internal.rb_mut(), 1.0, q_b);
        dense::add_product(internal, 1.0, self.dynamic_modes.as_ref(), eta);
        motions
    }

    /// C with Ψ_D = (kept named columns) · C, n_η × n_η: the inverse of the triangle that made Ψ_D orthonormal.
    pub fn mixing_of_kept(&self) -> Mat<f64> {
        let n = self.n_dynamic();
        let triangle = Mat::from_fn(n, n, |i, j| self.mixing[(i, self.kept[j])]);
        let mut inverse = Mat::identity(n, n);
        faer::linalg::triangular_solve::solve_upper_triangular_in_place(
            triangle.as_ref(),
            inverse.as_mut(),
            faer::Par::Seq,
        );
        inverse
    }

    /// The retained modes in reduced coordinates, (n_B + n_η) × k: the V̄ of equations (34) and (35).
    pub fn reduced_modes(&self, modes: &Modes, n_internal: usize) -> Mat<f64> {
        let n_b = self.constraint_modes.n_interface();
        let has_interface = modes.shapes.nrows() > n_internal;
        let first = self.mixing.ncols() - self.n_residual_vectors() - modes.count();
        Mat::from_fn(self.n_reduced(), modes.count(), |i, j| {
            if i >= n_b {
                self.mixing[(i - n_b, first + j)]
            } else if has_interface {
                modes.shapes[(n_internal + i, j)]
            } else {
                0.0
            }
        })
    }
}
