//! Eigenpairs of a small dense pencil.

use faer::{Mat, MatRef, Side};

use crate::dense;
use crate::error::Result;

/// Eigenpairs of a dense pencil: as many values as M has rank.
pub(crate) struct DensePairs {
    /// λ ascending; empty where K + αM is not definite.
    pub(crate) values: Vec<f64>,
    /// M-orthonormal, r × number of values.
    pub(crate) vectors: Mat<f64>,
}

/// Eigenpairs of K x = λ M x by the definite matrix K + αM: of M x = θ (K + αM) x, λ = 1/θ − α. With α near the first
/// elastic eigenvalue rounding is relative to the low eigenvalues.
pub(crate) fn eigenpairs(k: MatRef<'_, f64>, m: MatRef<'_, f64>, alpha: f64) -> Result<DensePairs> {
    let n = k.nrows();
    let shifted = Mat::from_fn(n, n, |i, j| k[(i, j)] + alpha * m[(i, j)]);
    let d: Vec<f64> = (0..n).map(|i| dense::power_of_two_root(shifted[(i, i)])).collect();
    let scaled = |a: MatRef<'_, f64>| Mat::from_fn(n, n, |i, j| a[(i, j)] * d[i] * d[j]);
    let Ok(factor) = scaled(shifted.as_ref()).llt(Side::Lower) else {
        return Ok(DensePairs { values: Vec::new(), vectors: Mat::zeros(n, 0) });
    };
    let l = factor.L();
    let mut c = dense::standard_form(l, scaled(m));
    dense::symmetrise(&mut c);
    let (theta, w) = dense::symmetric_eigen(c.as_ref())?;
    let largest = theta.last().copied().unwrap_or(0.0);
    let kept: Vec<usize> = (0..n).rev().filter(|j| theta[*j] > f64::EPSILON * largest).collect();
    let mut vectors = Mat::from_fn(n, kept.len(), |i, j| w[(i, kept[j])] / theta[kept[j]].sqrt());
    faer::linalg::triangular_solve::solve_upper_triangular_in_place(l.transpose(), vectors.as_mut(), faer::Par::Seq);
    for j in 0..vectors.ncols() {
        dense::column_mut(vectors.as_mut(), j).iter_mut().zip(&d).for_each(|(value, d)| *value *= d);
    }
    Ok(DensePairs { values: kept.iter().map(|j| 1.0 / theta[*j] - alpha).collect(), vectors })
}

/// The eigenvalues of [`eigenpairs`].
pub(crate) fn eigenvalues(k: MatRef<'_, f64>, m: MatRef<'_, f64>, alpha: f64) -> Result<Vec<f64>> {
    eigenpairs(k, m, alpha).map(|pairs| pairs.values)
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
