//! Eigenpairs of a small dense pencil.

use faer::{Mat, MatRef};

use super::spectral::Spectral;
use crate::error::Result;

/// Eigenvalues of K x = λ M x, ascending, and the first `n_shapes` M-orthonormal eigenvectors, by [`Spectral`]: with α near the first
/// elastic eigenvalue rounding is relative to the low eigenvalues and not to the high ones. A pencil that is too far from definite has none.
pub(crate) fn lowest_eigenpairs(
    k: MatRef<'_, f64>,
    m: MatRef<'_, f64>,
    alpha: f64,
    n_shapes: usize,
) -> Result<(Vec<f64>, Mat<f64>)> {
    let spectral = Spectral::if_definite(k, m, alpha)?;
    Ok(spectral.map_or((Vec::new(), Mat::zeros(k.nrows(), 0)), |spectral| spectral.lowest(n_shapes)))
}

/// The eigenvalues of [`lowest_eigenpairs`].
pub(crate) fn eigenvalues(k: MatRef<'_, f64>, m: MatRef<'_, f64>, alpha: f64) -> Result<Vec<f64>> {
    lowest_eigenpairs(k, m, alpha, 0).map(|(values, _)| values)
}

/// The eigenvalue after the first `n`, where it is positive, else `near`, which lies near it.
pub(crate) fn eigenvalue_beyond(n: usize, (k, m): (MatRef<'_, f64>, MatRef<'_, f64>), near: f64) -> Result<f64> {
    Ok(eigenvalues(k, m, near)?.get(n).copied().filter(|value| *value > 0.0).unwrap_or(near))
}

/// Share of the largest K̂_ii / M̂_ii up to which another is the rounding of what condensation took away: a body that one interface
/// node holds has no stiffness there.
const CONDENSED_AWAY: f64 = 1e-10;

/// The lowest K̂_ii / M̂_ii that is no rounding: what stands for the first elastic eigenvalue where there is none.
pub(crate) fn lowest_ratio(k: MatRef<'_, f64>, m: MatRef<'_, f64>) -> Option<f64> {
    lowest_ratio_of((0..k.nrows()).map(|i| (k[(i, i)], m[(i, i)])))
}

/// The lowest ratio of these stiffnesses and masses that is no rounding, as [`lowest_ratio`] finds it.
pub(crate) fn lowest_ratio_of(diagonals: impl Iterator<Item = (f64, f64)> + Clone) -> Option<f64> {
    let ratios = diagonals.filter(|(stiffness, mass)| *stiffness > 0.0 && *mass > 0.0).map(|(k, m)| k / m);
    let largest = ratios.clone().reduce(f64::max)?;
    ratios.filter(|ratio| *ratio > CONDENSED_AWAY * largest).reduce(f64::min)
}
