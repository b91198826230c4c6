//! The mass of MacNeal's method: that of the retained modes and of rigid-body motion, without what the static answers would add.
//!
//! ```text
//! V = [Û V̄]    r × (n_r + k)   rigid-body modes and retained modes (35) in reduced coordinates
//! M̂ = ΨᵀMΨ V (VᵀΨᵀMΨ V)⁻¹ VᵀΨᵀMΨ
//! ```
//! MacNeal joins the retained modes by a residual flexibility that has no mass. In coordinates of his own, the displacements of the
//! interface and the amplitudes of V, the mass is that of the amplitudes alone; this is the same form in the coordinates of the file.
//! M̂ V is that of ΨᵀMΨ, so that retained modes and their frequencies, rigid-body inertia and the loads of gravity stay exact.
//! K̂ is untouched, and with it every static answer. M̂ has the rank n_r + k: what is orthogonal to V has no mass.
//!
//! R. H. MacNeal, A hybrid method of component mode synthesis, Computers & Structures 1 (1971).

use faer::{Mat, MatRef};

use crate::dense;
use crate::error::{Error, Result};

/// A reduced mass that sees the retained modes and rigid-body motion alone.
#[derive(Clone, Debug)]
pub struct ModalMass {
    /// ΨᵀMΨ, r × r.
    pub projected: Mat<f64>,
    /// Û, r × n_r.
    motions: Mat<f64>,
    /// V̄, r × k.
    modes: Mat<f64>,
    /// n_r + k, rigid-body motions without mass left out.
    pub rank: usize,
}

impl ModalMass {
    /// The form of the projected mass ΨᵀMΨ that sees `motions`, Û, and `modes`, V̄, alone, r × r and symmetric to the bit; with it what it was
    /// made from, or none where the two span all coordinates: nothing is left out then.
    ///
    /// # Errors
    /// [`Error::NoModalMass`] where there is neither a mode nor a rigid-body motion with mass; a dense eigenproblem that does not converge.
    pub fn new(projected: Mat<f64>, motions: &Mat<f64>, modes: Mat<f64>) -> Result<(Mat<f64>, Option<Self>)> {
        let motions = motions.clone();
        let (mass, rank) = seen(projected.as_ref(), dense::side_by_side(motions.as_ref(), modes.as_ref()).as_ref())?;
        match rank {
            0 => Err(Error::NoModalMass),
            rank if rank >= projected.nrows() => Ok((projected, None)),
            rank => Ok((mass, Some(Self { projected, motions, modes, rank }))),
        }
    }

    /// The mass of the basis that ends after `n` coordinates: that of rigid-body motion and of the modes whose columns it has. A mode is put
    /// together from its own column and those before it.
    ///
    /// # Errors
    /// A dense eigenproblem that does not converge.
    pub(crate) fn of_leading(&self, n: usize) -> Result<Mat<f64>> {
        let rows_below = |j: usize| (n..self.modes.nrows()).any(|i| self.modes[(i, j)] != 0.0);
        let whole: Vec<usize> = (0..self.modes.ncols()).filter(|j| !rows_below(*j)).collect();
        let modes = dense::columns(self.modes.as_ref(), &whole);
        let motions = dense::side_by_side(self.motions.as_ref(), modes.as_ref());
        Ok(seen(self.projected.as_ref().submatrix(0, 0, n, n), motions.as_ref().subrows(0, n))?.0)
    }
}

/// M V (VᵀMV)⁻¹ VᵀM, and its rank: the sum of squares (MW)(MW)ᵀ with W an M-orthonormal basis of V, which rounding leaves semidefinite.
fn seen(mass: MatRef<'_, f64>, motions: MatRef<'_, f64>) -> Result<(Mat<f64>, usize)> {
    let w = dense::orthonormal(motions, mass);
    let momenta = dense::product(mass, w.as_ref());
    let mut seen = dense::product(momenta.as_ref(), momenta.transpose());
    dense::symmetrise(&mut seen);
    Ok((seen, w.ncols()))
}
