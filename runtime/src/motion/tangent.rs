//! Tangent operators of the Euler-Rodrigues parametrisation: dU = T(P) dP.
//!
//! Valid for |p_θ| < 2; at 2, half a turn, the results are infinite, beyond it NaN. [`Motion::parameters`] gives no such
//! parameters.
//!
//! Source: paper, Appendix A. The tildes that its printed (98) to (108) have lost are restored; (108) is completed.
//!
//! [`Motion::parameters`]: super::Motion::parameters

use crate::elementary::sqrt;

use super::algebra::{Matrix3, Matrix6, Vector3, Vector6, ZERO_3, blocks, dot, multiply_3, skew, split};

/// p₀ = cos(φ/2) = √(1 − pᵀp/4) of p = 2 sin(φ/2) n; eq. (99).
#[inline]
pub fn parameter_cosine(p: &Vector3) -> f64 {
    sqrt(1.0 - 0.25 * dot(p, p))
}

/// Tangent operator of rotation T(p) = I/p₀ − p̃/2 + p̃p̃/(4p₀); eq. (100).
#[inline]
pub fn tangent_3(p: &Vector3) -> Matrix3 {
    let p0 = parameter_cosine(p);
    let turn = skew(p);
    // p̃p̃ = p pᵀ − (pᵀp) I and pᵀp/4 = 1 − p₀² leave p₀ on the diagonal.
    entries(|i, j| if i == j { p0 } else { 0.0 } - 0.5 * turn[i][j] + p[i] * p[j] / (4.0 * p0))
}

/// Its inverse T⁻¹(p) = p₀ I + p̃/2; eq. (101).
#[inline]
pub fn tangent_inverse_3(p: &Vector3) -> Matrix3 {
    scaled_identity_plus_half_skew(parameter_cosine(p), p)
}

/// Rate of the inverse, (T⁻¹)˙ = ṗ̃/2 − pᵀṗ/(4p₀) I; eq. (102).
#[inline]
pub fn tangent_inverse_rate_3(p: &Vector3, rate: &Vector3) -> Matrix3 {
    scaled_identity_plus_half_skew(-dot(p, rate) / (4.0 * parameter_cosine(p)), rate)
}

/// Tangent operator of motion [T, T₊; 0, T]; eqs. (103), (105).
///
/// T₊ = ϱ/(4p₀³) (I + p̃p̃/4) − p̃_u/2 + (p̃p̃_u + p̃_up̃)/(4p₀) with ϱ = p_θᵀp_u.
#[inline]
pub fn tangent(parameters: &Vector6) -> Matrix6 {
    let (p_u, p) = split(parameters);
    let p0 = parameter_cosine(&p);
    let (turn, turn_u) = (skew(&p), skew(&p_u));
    let (twice, mixed, mixed_back) = (multiply_3(&turn, &turn), multiply_3(&turn, &turn_u), multiply_3(&turn_u, &turn));
    let factor = dot(&p, &p_u) / (4.0 * p0 * p0 * p0);
    let coupling = entries(|i, j| {
        factor * (if i == j { 1.0 } else { 0.0 } + 0.25 * twice[i][j]) - 0.5 * turn_u[i][j]
            + (mixed[i][j] + mixed_back[i][j]) / (4.0 * p0)
    });
    let rotation = tangent_3(&p);
    blocks(&rotation, &coupling, &ZERO_3, &rotation)
}

/// Its inverse [T⁻¹, T₋; 0, T⁻¹] with T₋ = p̃_u/2 − ϱ/(4p₀) I; eqs. (104), (106).
#[inline]
pub fn tangent_inverse(parameters: &Vector6) -> Matrix6 {
    let (p_u, p) = split(parameters);
    let p0 = parameter_cosine(&p);
    let rotation = scaled_identity_plus_half_skew(p0, &p);
    let coupling = scaled_identity_plus_half_skew(-dot(&p, &p_u) / (4.0 * p0), &p_u);
    blocks(&rotation, &coupling, &ZERO_3, &rotation)
}

/// Rate of the inverse where the parameters change at `rate`; eqs. (102), (108). It is linear in `rate`.
///
/// (T₋)˙ = ṗ̃_u/2 − [ϱ p_θᵀṗ_θ/(4p₀²) + ṗ_θᵀp_u + p_θᵀṗ_u]/(4p₀) I.
#[inline]
pub fn tangent_inverse_rate(parameters: &Vector6, rate: &Vector6) -> Matrix6 {
    let (p_u, p) = split(parameters);
    let (rate_u, rate_p) = split(rate);
    let p0 = parameter_cosine(&p);
    let along = dot(&p, &rate_p);
    let rotation = scaled_identity_plus_half_skew(-along / (4.0 * p0), &rate_p);
    let rho_rate = dot(&rate_p, &p_u) + dot(&p, &rate_u);
    let diagonal = -(dot(&p, &p_u) * along / (4.0 * p0 * p0) + rho_rate) / (4.0 * p0);
    let coupling = scaled_identity_plus_half_skew(diagonal, &rate_u);
    blocks(&rotation, &coupling, &ZERO_3, &rotation)
}

/// d I + ṽ/2.
#[inline]
fn scaled_identity_plus_half_skew(d: f64, v: &Vector3) -> Matrix3 {
    let turn = skew(v);
    entries(|i, j| if i == j { d } else { 0.5 * turn[i][j] })
}

#[inline]
fn entries(entry: impl Fn(usize, usize) -> f64) -> Matrix3 {
    core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)))
}
