//! Rigid-body modes: every motion of the component that stores no energy.
//!
//! ```text
//! U    n' × n_r    K U = 0; for one free body the six unit motions, translations first, rotations about the origin
//! Q    n' × n_r    the same space, QᵀMQ = I, used to deflate
//! ```
//!
//! They come from the coordinates where those are known, and are verified against K; without coordinates from the
//! matrices, by inverse iteration. The count is never assumed: it is the number of motions that K lets pass.

mod algebraic;
mod geometric;
mod rank;

use faer::{Mat, MatRef};

use crate::dense;
use crate::error::Result;
use crate::partition::Partition;
use crate::sparse::SparseMatrix;


pub use rank::{InterfaceRank, interface_rank};

/// Where rigid-body modes come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigidSource {
    /// Coordinates, verified against K.
    Geometric,
    /// Inverse iteration on K − σM.
    Algebraic,
}

/// The rigid-body modes of a partition.
#[derive(Clone, Debug)]
pub struct RigidBodyModes {
    /// U, n' × n_r.
    pub modes: Mat<f64>,
    /// Q, n' × n_r, spanning the same space, M-orthonormal.
    pub orthonormal: Mat<f64>,
    /// M Q, n' × n_r.
    pub mass_orthonormal: Mat<f64>,
    /// Where they come from.
    pub source: RigidSource,
    /// True where U is the six unit motions of one free body, so that UᵀMU holds its mass properties.
    pub is_classical: bool,
    /// Energies of the modes against the noise of the data.
    pub energy: RigidEnergy,
}

/// How well K lets the rigid-body modes pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidEnergy {
    /// Largest Rayleigh quotient qᵀKq of an orthonormal mode, in scaled units.
    pub largest_quotient: f64,
    /// Largest relative residual ‖Kq‖ / ‖ |K||q| ‖.
    pub largest_residual: f64,
    /// Largest Rayleigh quotient that rounding of the data can make: ε_K · |q|ᵀ|K||q|.
    pub noise: f64,
}

impl RigidBodyModes {
    /// n_r.
    pub fn count(&self) -> usize {
        self.modes.ncols()
    }

    /// The modes of a component that is held: none.
    pub fn none(n_dofs: usize) -> Self {
        Self {
            modes: Mat::zeros(n_dofs, 0),
            orthonormal: Mat::zeros(n_dofs, 0),
            mass_orthonormal: Mat::zeros(n_dofs, 0),
            source: RigidSource::Geometric,
            is_classical: false,
            energy: RigidEnergy::default(),
        }
    }

    /// M_F = UᵀMU, n_r × n_r.
    pub fn rigid_body_mass(&self, mass: &SparseMatrix) -> Mat<f64> {
        let mut m_f = dense::gram(self.modes.as_ref(), multiply(mass, self.modes.as_ref()).as_ref());
        dense::symmetrise(&mut m_f);
        m_f
    }
}

/// The rigid-body modes from the coordinates, or `None` where the model has none.
///
/// # Errors
/// Coordinates that do not belong to K; a rigid motion without mass.
pub fn from_coordinates(partition: &Partition) -> Result<Option<RigidBodyModes>> {
    partition.sites().map(|sites| geometric::rigid_body_modes(partition, &sites)).transpose()
}

/// A X as a new matrix.
pub(crate) fn multiply(matrix: &SparseMatrix, x: MatRef<'_, f64>) -> Mat<f64> {
    let mut y = Mat::zeros(matrix.rows(), x.ncols());
    crate::sparse::multiply(matrix, x, y.as_mut());
    y
}

/// Σ_ij |x_i||a_ij||x_j| for each column: what rounding of A is measured by.
pub(crate) fn absolute_energy(matrix: &SparseMatrix, x: MatRef<'_, f64>) -> Vec<f64> {
    use rayon::prelude::*;
    const ROWS_PER_TASK: usize = 4096;
    let (n, k) = (matrix.rows(), x.ncols());
    let partial: Vec<Vec<f64>> = (0..n.div_ceil(ROWS_PER_TASK))
        .into_par_iter()
        .map(|task| {
            let mut sums = vec![0.0; k];
            for row in task * ROWS_PER_TASK..((task + 1) * ROWS_PER_TASK).min(n) {
                let Some(view) = matrix.outer_view(row) else { continue };
                for (j, sum) in sums.iter_mut().enumerate() {
                    let column = dense::column(x, j);
                    let terms = view.iter().map(|(col, value)| value.abs() * column[col].abs());
                    *sum += column[row].abs() * terms.sum::<f64>();
                }
            }
            sums
        })
        .collect();
    let mut total = vec![0.0; k];
    for sums in partial {
        for (total, sum) in total.iter_mut().zip(sums) {
            *total += sum;
        }
    }
    total
}
