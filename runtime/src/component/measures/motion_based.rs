//! Motion parameters E = P(H_E) = (p_u; p): J = T⁻¹(E), F = T⁻¹(−E), eqs. (101) to (108) and their derivatives.
//!
//! T⁻¹(E) = [p₀ I + p̃/2, c I + p̃_u/2; 0, p₀ I + p̃/2] is linear but for p₀ = √(1 − pᵀp/4) and c = ∇p₀ᵀp_u: all derivatives
//! are those of the cosine p₀, as forms ∇p₀, ∇²p₀ a and ∇³p₀ (a, b) on the increment of p.

use super::node::{NodeMeasure, NodeRates, RateMatrices, difference_6, sum_6};
use crate::motion::{
    Matrix3, Matrix6, Motion, Vector3, Vector6, ZERO_3, blocks, check, dot, hat, parameter_cosine, split,
    tangent_inverse, tangent_inverse_rate, times_6,
};

pub(super) fn measure(motion: &Motion, parameters: &Vector6) -> NodeMeasure {
    NodeMeasure {
        motion: *motion,
        e: *parameters,
        j: tangent_inverse(parameters),
        f: tangent_inverse(&parameters.map(|x| -x)),
        excess: [[0.0; 6]; 6],
    }
}

/// p₀ of p and its derivatives.
struct Cosine {
    p: Vector3,
    p0: f64,
}

impl Cosine {
    fn of(p: &Vector3) -> Self {
        Self { p: *p, p0: parameter_cosine(p) }
    }

    /// ∇p₀ = −p/(4p₀).
    fn first(&self) -> Vector3 {
        self.p.map(|x| -x / (4.0 * self.p0))
    }

    /// ∇²p₀ a = −a/(4p₀) − (pᵀa) p/(16p₀³).
    fn second(&self, a: &Vector3) -> Vector3 {
        let along = dot(&self.p, a) / (4.0 * self.p0 * self.p0);
        core::array::from_fn(|i| -(a[i] + along * self.p[i]) / (4.0 * self.p0))
    }

    /// ∇³p₀ (a, b) = −[(aᵀb) p + (pᵀb) a + (pᵀa) b]/(16p₀³) − 3 (pᵀa)(pᵀb) p/(64p₀⁵).
    fn third(&self, a: &Vector3, b: &Vector3) -> Vector3 {
        let (p, square) = (&self.p, self.p0 * self.p0);
        let (with_a, with_b) = (dot(p, a), dot(p, b));
        let along = dot(a, b) + 0.75 * with_a * with_b / square;
        core::array::from_fn(|i| -(along * p[i] + with_b * a[i] + with_a * b[i]) / (16.0 * self.p0 * square))
    }
}

/// Derivative by E of [s I, c I; 0, s I] w, where s has the gradient `s_p` by p and c the gradients `s_p` by p_u and `c_p` by p.
fn scaled(w: &Vector6, s_p: &Vector3, c_p: &Vector3) -> Matrix6 {
    let (w_u, w_p) = split(w);
    let along = dyad(&w_p, s_p);
    blocks(&along, &sum_3(&dyad(&w_u, s_p), &dyad(&w_p, c_p)), &ZERO_3, &along)
}

/// (T⁻¹)˙ (V − V_F) + Ė̂ V_F, as Ḟ = J̇ − Ė̂.
#[inline]
pub(super) fn rates_times(node: &NodeMeasure, rates: &NodeRates) -> Vector6 {
    let turned = times_6(&tangent_inverse_rate(&node.e, &rates.measure), &difference(&rates.node, &rates.frame));
    let dragged = times_6(&hat(&rates.measure), &rates.frame);
    core::array::from_fn(|i| turned[i] + dragged[i])
}

/// Derivative of J x − F x_F = T⁻¹(E) (x − x_F) + Ê x_F by E, which is that of y by Ė too: with w = x − x_F and
/// Ê w/2 = −ŵ E/2 it is [scaled] w less ½ hat(x + x_F).
pub(super) fn carried(node: &NodeMeasure, [x, x_f]: [&Vector6; 2]) -> Matrix6 {
    let (p_u, p) = split(&node.e);
    let cosine = Cosine::of(&p);
    let turning = hat(&core::array::from_fn(|i| 0.5 * (x[i] + x_f[i])));
    difference_6(&scaled(&difference(x, x_f), &cosine.first(), &cosine.second(&p_u)), &turning)
}

/// The matrix of [`carried`] for the rates, J̇, and J̇ − Ė̂.
pub(super) fn rate_matrices(node: &NodeMeasure, rates: &NodeRates) -> RateMatrices {
    let j = tangent_inverse_rate(&node.e, &rates.measure);
    let frame = difference_6(&j, &hat(&rates.measure));
    RateMatrices { measure: carried(node, [&rates.node, &rates.frame]), node: j, frame }
}

/// Derivative of y by E: the second derivative of T⁻¹ in the directions Ė and ΔE, times V − V_F.
pub(super) fn rates_by_measure(node: &NodeMeasure, rates: &NodeRates) -> Matrix6 {
    let ((p_u, p), (rate_u, rate)) = (split(&node.e), split(&rates.measure));
    let cosine = Cosine::of(&p);
    let (third, second) = (cosine.third(&p_u, &rate), cosine.second(&rate_u));
    let c_p = core::array::from_fn(|i| third[i] + second[i]);
    scaled(&difference(&rates.node, &rates.frame), &cosine.second(&rate), &c_p)
}

/// Derivatives of Jᵀh and Fᵀh by E: ½ ȟ + [0, h_u ∇p₀ᵀ; h_u ∇p₀ᵀ, h_u (∇²p₀ p_u)ᵀ + h_p ∇p₀ᵀ], and that less ȟ, as F = J − Ê
/// and (ΔÊ)ᵀh = ȟ ΔE.
pub(super) fn forces_by_measure(node: &NodeMeasure, h: &Vector6) -> [Matrix6; 2] {
    let ((p_u, p), (h_u, h_p)) = (split(&node.e), split(h));
    let cosine = Cosine::of(&p);
    let first = cosine.first();
    let across = dyad(&h_u, &first);
    let dyads = blocks(&ZERO_3, &across, &across, &sum_3(&dyad(&h_u, &cosine.second(&p_u)), &dyad(&h_p, &first)));
    let half = check(&h.map(|x| 0.5 * x));
    [sum_6(&dyads, &half), difference_6(&dyads, &half)]
}

fn difference(a: &Vector6, b: &Vector6) -> Vector6 {
    core::array::from_fn(|i| a[i] - b[i])
}

fn dyad(a: &Vector3, b: &Vector3) -> Matrix3 {
    a.map(|x| b.map(|y| x * y))
}

fn sum_3(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    core::array::from_fn(|i| core::array::from_fn(|j| a[i][j] + b[i][j]))
}
