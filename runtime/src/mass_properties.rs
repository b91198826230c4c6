//! Mass, centre of mass and inertia from the rigid-body mass.
//!
//! | symbol | meaning | shape |
//! |---|---|---|
//! | M_F = UᵀMU | rigid-body mass | 6 × 6 |
//! | m, c | mass, centre of mass | 1, 3 |
//! | J_O, J | inertia about the origin, about c | 3 × 3 |

use crate::matrix::Matrix;
use crate::metadata::MassProperties;

/// How far the translational block may be from m·I and still be that of unit translations.
///
/// Consistent and lumped mass matrices give it to rounding; a model exported with six digits gives it to 1e-6.
const TRANSLATION_TOLERANCE: f64 = 1e-5;

/// Mass, centre of mass c and inertia about c from M_F = [m I, −m c̃; m c̃, J_O], with J = J_O − m (|c|² I − c cᵀ).
///
/// `rigid_body_mass` is 6 × 6 and its columns must be the geometric ones: unit translations along x, y, z, then unit
/// rotations about the axes through the model's origin ([`RigidBodyModes::Geometric`] and one component). `None` where
/// the matrix cannot be that: another shape, a value that is not finite, mass not positive, or a translational block
/// that is not m·I.
///
/// [`RigidBodyModes::Geometric`]: crate::RigidBodyModes::Geometric
pub fn mass_properties(rigid_body_mass: &Matrix) -> Option<MassProperties> {
    let m_f = rigid_body_mass;
    if (m_f.rows(), m_f.cols()) != (6, 6) || m_f.as_slice().iter().any(|value| !value.is_finite()) {
        return None;
    }
    let mass = (m_f[(0, 0)] + m_f[(1, 1)] + m_f[(2, 2)]) / 3.0;
    let deviation = |i: usize, j: usize| (m_f[(i, j)] - if i == j { mass } else { 0.0 }).abs();
    let largest = (0..9).map(|k| deviation(k / 3, k % 3)).fold(0.0, f64::max);
    if mass <= 0.0 || largest > TRANSLATION_TOLERANCE * mass {
        return None;
    }
    // The upper right block is −m c̃: each component of m c stands there twice, with opposite signs. Half the difference
    // treats the axes alike.
    let moment = [m_f[(2, 4)], m_f[(0, 5)], m_f[(1, 3)]];
    let opposite = [m_f[(1, 5)], m_f[(2, 3)], m_f[(0, 4)]];
    let c: [f64; 3] = core::array::from_fn(|a| (opposite[a] - moment[a]) / (2.0 * mass));
    let c_squared = c.iter().map(|x| x * x).sum::<f64>();
    let steiner = |i: usize, j: usize| mass * (if i == j { c_squared } else { 0.0 } - c[i] * c[j]);
    let about_origin = |i: usize, j: usize| 0.5 * (m_f[(3 + i, 3 + j)] + m_f[(3 + j, 3 + i)]);
    let inertia = core::array::from_fn(|i| core::array::from_fn(|j| about_origin(i, j) - steiner(i, j)));
    Some(MassProperties { mass, center_of_mass: c, inertia })
}
