//! The inertia of a whole matrix.

use super::Indefinite;
use crate::error::Result;
use crate::factor::Analysis;
use crate::factor::multifrontal::Keep;
use crate::factor::rounding::forming_error;
use crate::sparse::Pencil;

/// The number of eigenvalues of a pencil below a shift, by one factorisation of all its dofs.
#[derive(Clone, Debug, PartialEq)]
pub struct WholeCount {
    /// The shift.
    pub sigma: f64,
    /// Eigenvalues below it, as many as there are negative pivots.
    pub below: usize,
    /// Bound of the largest entry of |L||B||Lᵀ| over the largest entry.
    pub growth: f64,
    /// Upper bound of ‖D (K − σM − LBLᵀ) D‖₂.
    pub backward_error: f64,
    /// D, powers of two near 1/√(|K_ii| + |σ| M_ii).
    pub scale: Vec<f64>,
}

/// Counts the eigenvalues of a whole pencil below σ.
///
/// # Errors
/// The errors of [`crate::factor::count_below`].
///
/// # Panics
/// The analysis has a border.
pub fn whole_count(analysis: &Analysis, pencil: Pencil<'_>, sigma: f64) -> Result<WholeCount> {
    let factor = Indefinite::new(analysis, pencil, sigma, Keep::Factor)?;
    let signs = factor.signs()?;
    let backward_error = factor.backward_error() + forming_error(pencil, sigma, &factor.scale);
    Ok(WholeCount { sigma, below: signs.negative, growth: signs.growth, backward_error, scale: factor.scale })
}
