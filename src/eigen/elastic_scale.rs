//! The first elastic eigenvalue of a reduced pencil by itself, where no mode tells it: the unit of energies for a reduction and for the
//! verification of its file alike.
//!
//! ```text
//! D = diag(1/√(M̂_ii + K̂_ii/ρ))   powers of two, ρ a ratio of the two
//! Z   r × (r − n_r)          orthonormal, Zᵀ D M̂ Û = 0
//! Zᵀ M̂ Z y = θ Zᵀ K̂ Z y     λ₁ = 1 / max θ, each matrix scaled by D from both sides
//! ```
//! Coordinates do not tell it: where one interface node holds the component, K̂_ii of its dofs is what rounding left of a stiffness that
//! cancels, and the ratio K̂_ii / M̂_ii is no eigenvalue of anything.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};

use super::dense_pencil::lowest_ratio;
use super::massless::ByInertia;
use super::spectral::{Spectral, scaled_by};
use crate::dense;
use crate::error::Result;

/// λ₁ of (K̂, M̂) beyond the rigid-body motions Û, r × n_r; none where K̂ lets other motions pass, or all.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(crate) fn first_elastic((k, m, u): (MatRef<'_, f64>, MatRef<'_, f64>, MatRef<'_, f64>)) -> Result<Option<f64>> {
    let r = k.nrows();
    let ByInertia { massive, massless } = ByInertia::of(m, u)?;
    let scale = coordinate_scales(k, m, massive.as_ref());
    let (k, m) = (scaled_by(k, &scale), scaled_by(m, &scale));
    let scaled = |motions: &Mat<f64>| Mat::from_fn(r, motions.ncols(), |i, j| motions[(i, j)] / scale[i]);
    // What elastic motion is orthogonal to: the momenta of rigid-body motions, or of those without mass the motions themselves.
    let momenta = dense::product(m.as_ref(), scaled(&massive).as_ref());
    let taken = dense::side_by_side(momenta.as_ref(), scaled(&massless).as_ref());
    let taken = dense::orthonormal(taken.as_ref(), Mat::<f64>::identity(r, r).as_ref());
    let all = taken.qr().compute_Q();
    let z = all.as_ref().subcols(taken.ncols(), r - taken.ncols());
    let projected = |a: &Mat<f64>| {
        let mut projected = dense::gram(z, dense::product(a.as_ref(), z).as_ref());
        dense::symmetrise(&mut projected);
        projected
    };
    let spectral = Spectral::if_definite(projected(&k).as_ref(), projected(&m).as_ref(), 0.0)?;
    Ok(spectral.and_then(|spectral| spectral.eigenvalues().first().copied()))
}

/// Powers of two near 1/√(M̂_ii + K̂_ii/ρ), ρ = max Σ K̂_ii w_i² / Σ M̂_ii w_i² over rigid-body motions with inertia. Of a rotation without
/// inertia M̂_ii is what rounding squares leave, and of a node that alone holds the component K̂_ii is rounding: neither is a unit by itself.
fn coordinate_scales(k: MatRef<'_, f64>, m: MatRef<'_, f64>, massive: MatRef<'_, f64>) -> Vec<f64> {
    let r = k.nrows();
    let sum = |a: MatRef<'_, f64>, j: usize| {
        (0..r).map(|i| a[(i, i)].max(0.0) * massive[(i, j)] * massive[(i, j)]).sum::<f64>()
    };
    let ratios = (0..massive.ncols()).map(|j| sum(k, j) / sum(m, j));
    let ratio = ratios.filter(|ratio| *ratio > 0.0 && ratio.is_finite()).reduce(f64::max);
    let size = |i: usize| m[(i, i)].max(0.0) + ratio.map_or(0.0, |ratio| k[(i, i)].max(0.0) / ratio);
    (0..r).map(|i| dense::power_of_two_root(size(i))).collect()
}

/// λ₁ where no mode tells it: by the pencil, or where that has no elastic motion by the ratios of its coordinates.
///
/// # Errors
/// As [`first_elastic`].
pub(crate) fn elastic_scale(parts: (MatRef<'_, f64>, MatRef<'_, f64>, MatRef<'_, f64>)) -> Result<Option<f64>> {
    Ok(first_elastic(parts)?.or_else(|| lowest_ratio(parts.0, parts.1)))
}

/// λ₁ of a component whose mass is that of rigid-body motion alone: what the inertia of each motion is to the energy that its relief
/// stores, the first `n_b` coordinates held, min (ûᵀM̂û) / (hᵀK̂_ηη⁻¹h) with h the modal rows of M̂û. None where nothing gives way.
pub(crate) fn relief_scale((k, m, u): (MatRef<'_, f64>, MatRef<'_, f64>, MatRef<'_, f64>), n_b: usize) -> Option<f64> {
    let (n_eta, momenta) = (k.nrows() - n_b, dense::product(m, u));
    let (scaled, d) = dense::unit_diagonal(k.submatrix(n_b, n_b, n_eta, n_eta));
    let factor = scaled.llt(Side::Lower).ok()?;
    let loads = Mat::from_fn(n_eta, u.ncols(), |i, j| momenta[(n_b + i, j)] * d[i]);
    let answers = factor.solve(&loads);
    let energies = dense::dots(loads.as_ref(), answers.as_ref());
    let ratios = dense::dots(u, momenta.as_ref()).into_iter().zip(energies).filter(|(_, energy)| *energy > 0.0);
    ratios.map(|(inertia, energy)| inertia / energy).filter(|ratio| *ratio > 0.0).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Masses 2 and 1 on a unit spring, in the coordinates of the first of them and of the stretch, with 1e-9 of stiffness that rounding
    /// left at the first.
    #[test]
    fn rounding_of_a_stiffness_that_cancels_is_no_eigenvalue() {
        let mass = Mat::from_fn(2, 2, |i, j| [[3.0, 1.0], [1.0, 1.0]][i][j]);
        let stiffness = Mat::from_fn(2, 2, |i, j| [[1e-9, 0.0], [0.0, 1.0]][i][j]);
        let rigid = Mat::from_fn(2, 1, |i, _| if i == 0 { 1.0 } else { 0.0 });
        let found = first_elastic((stiffness.as_ref(), mass.as_ref(), rigid.as_ref())).expect("numbers");
        // Masses 2 and 1 on a unit spring: λ = 1/2 + 1. The shape is -1/3 and 1 over a mass of 2/3, so that rounding adds 1e-9/6.
        let found = found.expect("an elastic motion");
        assert!((found - 1.5).abs() < 1e-9, "{found}");
        assert_eq!(lowest_ratio(stiffness.as_ref(), mass.as_ref()), Some(1e-9 / 3.0));
    }

    #[test]
    fn a_pencil_of_rigid_motion_alone_has_none() {
        let one = Mat::<f64>::identity(1, 1);
        let nothing = Mat::<f64>::zeros(1, 1);
        assert_eq!(first_elastic((nothing.as_ref(), one.as_ref(), one.as_ref())).expect("numbers"), None);
        // A motion without mass is no elastic one either.
        let (k, m) = (Mat::from_fn(2, 2, |i, j| f64::from(u8::from(i + j == 2))), Mat::<f64>::identity(2, 2));
        let m = Mat::from_fn(2, 2, |i, j| if i == 0 { 0.0 } else { m[(i, j)] });
        let u = Mat::from_fn(2, 1, |i, _| f64::from(u8::from(i == 0)));
        assert_eq!(first_elastic((k.as_ref(), m.as_ref(), u.as_ref())).expect("numbers"), Some(1.0));
    }
}
