//! Rigid-body motions and their derivatives: SE(3), the Euler-Rodrigues parametrisation, tangent operators.
//!
//! | symbol | meaning | type |
//! |---|---|---|
//! | H = (R, u) | motion x ↦ R x + u; of a node, its change of configuration, H = I at the start | [`Motion`] |
//! | dU, V | material increment and velocity, dH = H d̃U; translation part Rᵀdu, then rotation part | [`Vector6`] |
//! | P | motion parameters (p_u; p_θ), p_θ = 2 sin(φ/2) n | [`Vector6`] |
//! | T, T⁻¹ | tangent operators, dU = T(P) dP | [`Matrix3`], [`Matrix6`] |
//!
//! Vectors of six hold the translation first. A motion maps the *reference* configuration, so that u is the displacement
//! of the material point at the inertial origin, not that of the node. Everything here is allocated on the stack.
//!
//! Source: paper, section 3 and Appendix A.

mod algebra;
mod point;
mod tangent;

use crate::elementary::{sin, sqrt};

pub use algebra::{
    IDENTITY_3, IDENTITY_6, Matrix3, Matrix6, Vector3, Vector6, check, cross, dot, hat, join, multiply_3, multiply_6,
    multiply_transposed_3, skew, split, times_3, times_6, transposed_times_3, transposed_times_6,
};
pub(crate) use algebra::{ZERO_3, blocks};
pub use point::{force_to_origin, force_to_point, velocity_to_origin, velocity_to_point};
pub use tangent::{
    parameter_cosine, tangent, tangent_3, tangent_inverse, tangent_inverse_3, tangent_inverse_rate,
    tangent_inverse_rate_3,
};

/// A rigid-body motion, x ↦ R x + u.
///
/// Its memory is twelve doubles in this order, for programs in other languages.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Rotation matrix R, row by row.
    pub rotation: Matrix3,
    /// Displacement u of the point at the origin.
    pub translation: Vector3,
}

/// Smallest cos(φ/2) of a rotation that has parameters.
///
/// tr R + 1 = 4 cos²(φ/2) is the difference of numbers near one: below this the parameters keep fewer than nine digits,
/// and at half a turn they jump. It leaves out rotations above 179.88 degrees.
const SMALLEST_COSINE: f64 = 1e-3;

/// Below this angle (rad) the coefficients of the exponential are taken from their series, whose next term is φ⁶/5040.
const SERIES_ANGLE: f64 = 1e-2;

impl Motion {
    /// No motion.
    pub const IDENTITY: Self = Self { rotation: IDENTITY_3, translation: [0.0; 3] };

    /// `self` after `first`: (R₂R₁, u₂ + R₂u₁), eq. (52).
    #[inline]
    pub fn compose(&self, first: &Self) -> Self {
        let rotation = multiply_3(&self.rotation, &first.rotation);
        let moved = times_3(&self.rotation, &first.translation);
        Self { rotation, translation: core::array::from_fn(|i| self.translation[i] + moved[i]) }
    }

    /// The motion back, (Rᵀ, −Rᵀu).
    #[inline]
    pub fn inverse(&self) -> Self {
        let rotation = core::array::from_fn(|i| core::array::from_fn(|j| self.rotation[j][i]));
        Self { rotation, translation: transposed_times_3(&self.rotation, &self.translation).map(|x| -x) }
    }

    /// `self`⁻¹ ∘ `other`: the motion `other` seen from the frame `self`.
    #[inline]
    pub fn relative(&self, other: &Self) -> Self {
        let difference = core::array::from_fn(|i| other.translation[i] - self.translation[i]);
        Self {
            rotation: multiply_transposed_3(&self.rotation, &other.rotation),
            translation: transposed_times_3(&self.rotation, &difference),
        }
    }

    /// The motion with its rotation matrix brought back to the rotations, R (3 I − RᵀR)/2: a drift ε becomes ε².
    ///
    /// Every product of rotation matrices rounds, and millions of steps add up.
    #[inline]
    pub fn orthonormalised(&self) -> Self {
        let gram = multiply_transposed_3(&self.rotation, &self.rotation);
        let back = core::array::from_fn(|i| {
            core::array::from_fn(|j| if i == j { 1.5 - 0.5 * gram[i][j] } else { -0.5 * gram[i][j] })
        });
        Self { rotation: multiply_3(&self.rotation, &back), translation: self.translation }
    }

    /// Where a point of the reference configuration goes, R x + u.
    #[inline]
    pub fn apply(&self, point: &Vector3) -> Vector3 {
        let turned = times_3(&self.rotation, point);
        core::array::from_fn(|i| turned[i] + self.translation[i])
    }

    /// Exponential map of (u; θ): the motion after unit time with the constant material velocity (u; θ).
    ///
    /// R = I + a θ̃ + b θ̃², translation (I + b θ̃ + c θ̃²) u, with a = sin φ/φ, b = (1 − cos φ)/φ², c = (φ − sin φ)/φ³.
    pub fn exp(increment: &Vector6) -> Self {
        let (u, theta) = split(increment);
        let square = dot(&theta, &theta);
        let (a, b, c) = if square < SERIES_ANGLE * SERIES_ANGLE {
            let series = |first: f64, second: f64, third: f64| first - square * (second - square * third);
            let (a, b) = (series(1.0, 1.0 / 6.0, 1.0 / 120.0), series(0.5, 1.0 / 24.0, 1.0 / 720.0));
            (a, b, series(1.0 / 6.0, 1.0 / 120.0, 1.0 / 5040.0))
        } else {
            let phi = sqrt(square);
            let half = sin(0.5 * phi);
            (sin(phi) / phi, 2.0 * half * half / square, (phi - sin(phi)) / (square * phi))
        };
        let (once, twice) = (cross(&theta, &u), cross(&theta, &cross(&theta, &u)));
        Self {
            rotation: rotation_matrix(&theta, a, b),
            translation: core::array::from_fn(|i| u[i] + b * once[i] + c * twice[i]),
        }
    }

    /// Motion parameters P = (T⁻ᵀ(p_θ) u; p_θ) with p̃_θ = (R − Rᵀ)/√(tr R + 1), the inverse of
    /// [`from_parameters`](Self::from_parameters); eqs. (56b), (97), (98).
    ///
    /// `None` for a rotation by half a turn, where they jump, for one within 0.12 degrees of it, and for values that are
    /// not finite.
    #[inline]
    pub fn parameters(&self) -> Option<Vector6> {
        let r = &self.rotation;
        let double_cosine = sqrt(r[0][0] + r[1][1] + r[2][2] + 1.0);
        let p = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]].map(|x| x / double_cosine);
        let p0 = 0.5 * double_cosine;
        let turned = cross(&p, &self.translation);
        let parameters = join(&core::array::from_fn(|i| p0 * self.translation[i] - 0.5 * turned[i]), &p);
        // A square root of a negative number and infinities end here, too: no comparison with NaN is true.
        (p0 >= SMALLEST_COSINE && parameters.iter().all(|x| x.is_finite())).then_some(parameters)
    }

    /// The motion of parameters (p_u; p_θ): R = I + p₀ p̃ + ½ p̃², u = Tᵀ(p_θ) p_u; eqs. (56a), (97), (99).
    ///
    /// `None` unless |p_θ| = 2 sin(φ/2) < 2 and all values are finite.
    #[inline]
    pub fn from_parameters(parameters: &Vector6) -> Option<Self> {
        let (p_u, p) = split(parameters);
        let square = dot(&p, &p);
        let p0 = parameter_cosine(&p);
        let translation = transposed_times_3(&tangent_3(&p), &p_u);
        let valid = square < 4.0 && translation.iter().all(|x| x.is_finite());
        valid.then(|| Self { rotation: rotation_matrix(&p, p0, 0.5), translation })
    }

    /// Motion tensor C = [R, ũR; 0, R], which turns material into spatial increments; eq. (52).
    pub fn tensor(&self) -> Matrix6 {
        let coupling = multiply_3(&skew(&self.translation), &self.rotation);
        blocks(&self.rotation, &coupling, &ZERO_3, &self.rotation)
    }
}

/// I + a ṽ + b ṽ².
#[inline]
fn rotation_matrix(v: &Vector3, a: f64, b: f64) -> Matrix3 {
    let (square, turn) = (dot(v, v), skew(v));
    core::array::from_fn(|i| {
        core::array::from_fn(|j| {
            let diagonal = if i == j { 1.0 - b * square } else { 0.0 };
            diagonal + a * turn[i][j] + b * v[i] * v[j]
        })
    })
}
