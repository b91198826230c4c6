//! Velocities and forces of a body at a point of its own, and at the material point at the inertial origin.
//!
//! The motion formalism takes a velocity V = (v; ω) and a force (f; m) at the material point that was at the inertial origin.
//! With S = [I, x̃; 0, I] for a point at x in the reference configuration, V = S (Rᵀẋ; ω), and forces go back by Sᵀ.

use super::algebra::{Vector3, Vector6, cross, join, split};

/// S (v; ω) = (v + x × ω; ω): the velocity at the origin from that at the point `position`, (Rᵀẋ; ω) in the body's own axes;
/// accelerations and increments alike, as S is constant.
#[inline]
pub fn velocity_to_origin(position: &Vector3, at_point: &Vector6) -> Vector6 {
    let (v, turn) = split(at_point);
    let by_turn = cross(position, &turn);
    join(&core::array::from_fn(|i| v[i] + by_turn[i]), &turn)
}

/// S⁻¹ (v; ω) = (v − x × ω; ω): the velocity at the point `position` from that at the origin.
#[inline]
pub fn velocity_to_point(position: &Vector3, at_origin: &Vector6) -> Vector6 {
    velocity_to_origin(&position.map(|x| -x), at_origin)
}

/// Sᵀ (f; m) = (f; m − x × f): force and moment at the point `position` from those at the origin.
#[inline]
pub fn force_to_point(position: &Vector3, at_origin: &Vector6) -> Vector6 {
    let (f, m) = split(at_origin);
    let lever = cross(position, &f);
    join(&f, &core::array::from_fn(|i| m[i] - lever[i]))
}

/// S⁻ᵀ (f; m) = (f; m + x × f): force and moment at the origin from those at the point `position`.
#[inline]
pub fn force_to_origin(position: &Vector3, at_point: &Vector6) -> Vector6 {
    force_to_point(&position.map(|x| -x), at_point)
}
