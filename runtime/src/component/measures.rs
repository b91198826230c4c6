//! Measures of the deformation of one interface node and their derivatives, eqs. (63), (64) and (90), (91).
//!
//! | symbol | meaning | shape |
//! |---|---|---|
//! | H_E = H_F⁻¹H_j = (R, u) | motion of the node seen from the floating frame | |
//! | E | measure of it: P(H_E), or (d; κ) with d = R x + u − x and κ̃ = (R − Rᵀ)/2 for a node at x | 6 |
//! | J, F | ΔE = J ΔU_j − F ΔU_F; with J = T⁻¹(E), F = T⁻¹(−E) = J − Ê for motion parameters | 6 × 6 |
//! | y = J̇ V − Ḟ V_F | part of Ë that does not come from accelerations | 6 |

use super::Measures;
use crate::motion::{
    Matrix3, Matrix6, Motion, Vector3, Vector6, blocks, cross, dot, hat, join, multiply_3, parameter_cosine, skew,
    split, tangent_inverse, tangent_inverse_rate, times_3, times_6, transposed_times_3,
};

const ZERO: Matrix3 = [[0.0; 3]; 3];

/// Deformation of one interface node.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeMeasure {
    /// H_E.
    pub(super) motion: Motion,
    pub(super) e: Vector6,
    pub(super) j: Matrix6,
    pub(super) f: Matrix6,
    /// F − U.
    pub(super) excess: Matrix6,
}

/// Velocities at one interface node.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeRates {
    /// Ė.
    pub(super) measure: Vector6,
    /// V_j.
    pub(super) node: Vector6,
    /// V_F.
    pub(super) frame: Vector6,
}

/// Derivative of y by the velocities, Δy = `measure` ΔĖ + `node` ΔV_j − `frame` ΔV_F.
pub(super) struct RateMatrices {
    pub(super) measure: Matrix6,
    pub(super) node: Matrix6,
    pub(super) frame: Matrix6,
}

impl NodeMeasure {
    /// No deformation: J = F = U.
    pub(super) fn undeformed(rigid: &Matrix6) -> Self {
        Self { motion: Motion::IDENTITY, e: [0.0; 6], j: *rigid, f: *rigid, excess: [[0.0; 6]; 6] }
    }
}

impl Measures {
    /// Measure of a motion relative to the floating frame of a node at `position`, without `excess`; `None` at half a turn.
    #[inline]
    pub(super) fn of(self, motion: &Motion, position: &Vector3) -> Option<NodeMeasure> {
        let parameters = motion.parameters()?;
        Some(match self {
            Self::MotionBased => NodeMeasure {
                motion: *motion,
                e: parameters,
                j: tangent_inverse(&parameters),
                f: tangent_inverse(&parameters.map(|x| -x)),
                excess: [[0.0; 6]; 6],
            },
            Self::Classical => classical(motion, position),
        })
    }

    /// y = J̇ V − Ḟ V_F.
    #[inline]
    pub(super) fn rates_times(self, node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> Vector6 {
        match self {
            // Ḟ = J̇ − Ė̂.
            Self::MotionBased => {
                let difference = core::array::from_fn(|i| rates.node[i] - rates.frame[i]);
                let turned = times_6(&tangent_inverse_rate(&node.e, &rates.measure), &difference);
                let dragged = times_6(&hat(&rates.measure), &rates.frame);
                core::array::from_fn(|i| turned[i] + dragged[i])
            }
            Self::Classical => classical_rates_times(node, position, rates),
        }
    }

    /// Derivative of y by the velocities.
    pub(super) fn rate_matrices(self, node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> RateMatrices {
        match self {
            Self::MotionBased => motion_based_rate_matrices(node, rates),
            Self::Classical => classical_rate_matrices(node, position, rates),
        }
    }
}

/// J̇, J̇ − Ė̂, and the derivative of (T⁻¹)˙(E, Ė) (V − V_F) + Ė̂ V_F by Ė, which enters linearly.
///
/// With W = V − V_F and ϱ = p_θᵀp_u the first part is −½ Ŵ Ė − 1/(4p₀) [w_θ p_θᵀ, w_u p_θᵀ + w_θ (ϱ p_θ/(4p₀²) + p_u)ᵀ; 0,
/// w_θ p_θᵀ] Ė by (102), (108); the second is −V̂_F Ė by (54).
fn motion_based_rate_matrices(node: &NodeMeasure, rates: &NodeRates) -> RateMatrices {
    let (p_u, p) = split(&node.e);
    let p0 = parameter_cosine(&p);
    let w: Vector6 = core::array::from_fn(|i| rates.node[i] - rates.frame[i]);
    let (w_u, w_p) = split(&w);
    let rho = dot(&p, &p_u) / (4.0 * p0 * p0);
    let dyad = |a: &Vector3, b: &Vector3| -> Matrix3 { a.map(|x| b.map(|y| -x * y / (4.0 * p0))) };
    let along = dyad(&w_p, &p);
    let across = sum_3(&dyad(&w_u, &p), &dyad(&w_p, &core::array::from_fn(|i| rho * p[i] + p_u[i])));
    let dyads = blocks(&along, &across, &ZERO, &along);
    // ½ Ŵ + V̂_F = ½ hat(V + V_F).
    let turning = hat(&core::array::from_fn(|i| 0.5 * (rates.node[i] + rates.frame[i])));
    let j = tangent_inverse_rate(&node.e, &rates.measure);
    let dragging = hat(&rates.measure);
    let difference = |a: &Matrix6, b: &Matrix6| core::array::from_fn(|i| core::array::from_fn(|c| a[i][c] - b[i][c]));
    RateMatrices { measure: difference(&dyads, &turning), node: j, frame: difference(&j, &dragging) }
}

/// (91) for the displacement of the node instead of that of the origin, J and F being in the coordinates of the node:
/// J = [R, −R x̃; 0, ½(tr R I − Rᵀ)], F = [I, −(x + d)~; 0, ½(tr R I − R)].
fn classical(motion: &Motion, position: &Vector3) -> NodeMeasure {
    let r = &motion.rotation;
    let moved = motion.apply(position);
    let d = core::array::from_fn(|i| moved[i] - position[i]);
    let (node_turn, frame_turn) = skew_part_derivatives(r);
    let negative = |a: Matrix3| a.map(|row| row.map(|x| -x));
    NodeMeasure {
        motion: *motion,
        e: join(&d, &axial(r)),
        j: blocks(r, &negative(multiply_3(r, &skew(position))), &ZERO, &node_turn),
        f: blocks(&crate::motion::IDENTITY_3, &negative(skew(&moved)), &ZERO, &frame_turn),
        excess: [[0.0; 6]; 6],
    }
}

/// κ of κ̃ = (R − Rᵀ)/2.
fn axial(r: &Matrix3) -> Vector3 {
    [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]].map(|x| 0.5 * x)
}

/// ½(tr R I − Rᵀ) and ½(tr R I − R); linear in R, so that they give rates as well.
fn skew_part_derivatives(r: &Matrix3) -> (Matrix3, Matrix3) {
    let trace = r[0][0] + r[1][1] + r[2][2];
    let of = |entry: &dyn Fn(usize, usize) -> f64| -> Matrix3 {
        core::array::from_fn(|i| core::array::from_fn(|j| 0.5 * (if i == j { trace } else { 0.0 } - entry(i, j))))
    };
    (of(&|i, j| r[j][i]), of(&|i, j| r[i][j]))
}

/// Angular velocity of the node against the floating frame, in the node: ω − Rᵀω_F.
fn relative_spin(node: &NodeMeasure, rates: &NodeRates) -> Vector3 {
    let frame_spin = transposed_times_3(&node.motion.rotation, &split(&rates.frame).1);
    core::array::from_fn(|i| rates.node[3 + i] - frame_spin[i])
}

fn classical_rates_times(node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> Vector6 {
    let matrices = classical_velocity_matrices(node, position, rates);
    let (of_node, of_frame) = (times_6(&matrices[0], &rates.node), times_6(&matrices[1], &rates.frame));
    core::array::from_fn(|i| of_node[i] - of_frame[i])
}

/// J̇ = [Ṙ, −Ṙ x̃; 0, ½(tr Ṙ I − Ṙᵀ)] and Ḟ = [0, −d̃˙; 0, ½(tr Ṙ I − Ṙ)] with Ṙ = R ω̃_E.
fn classical_velocity_matrices(node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> [Matrix6; 2] {
    let r_rate = multiply_3(&node.motion.rotation, &skew(&relative_spin(node, rates)));
    let (node_turn, frame_turn) = skew_part_derivatives(&r_rate);
    let negative = |a: Matrix3| a.map(|row| row.map(|x| -x));
    [
        blocks(&r_rate, &negative(multiply_3(&r_rate, &skew(position))), &ZERO, &node_turn),
        blocks(&ZERO, &negative(skew(&split(&rates.measure).0)), &ZERO, &frame_turn),
    ]
}

/// y = (R (ω_E × a) + ḋ × ω_F; −(κᵀω_E)(ω − ω_F) − ½ Rᵀω × ω_E − ½ R (ω_F × ω_E)) with a the velocity of the node in its own
/// axes; ω_E = ω − Rᵀω_F passes its derivative on to V and V_F.
fn classical_rate_matrices(node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> RateMatrices {
    let r = &node.motion.rotation;
    let (v, spin) = split(&rates.node);
    let frame_spin = split(&rates.frame).1;
    let lever = cross(position, &spin);
    let velocity: Vector3 = core::array::from_fn(|i| v[i] - lever[i]);
    let kappa = axial(r);
    let translation = multiply_3(r, &skew(&velocity)).map(|row| row.map(|x| -x));
    let (turned, carried) = (skew(&transposed_times_3(r, &spin)), multiply_3(r, &skew(&frame_spin)));
    let rotation: Matrix3 = core::array::from_fn(|i| {
        core::array::from_fn(|j| -(spin[i] - frame_spin[i]) * kappa[j] - 0.5 * (turned[i][j] + carried[i][j]))
    });
    // Derivative of y by ω_E, as columns of a rotation, and ω_E by that of the floating frame.
    let by_spin = blocks(&ZERO, &translation, &ZERO, &rotation);
    let back = |a: &Matrix3| a.map(|row| times_3(r, &row));
    let by_frame_spin = blocks(&ZERO, &back(&translation), &ZERO, &back(&rotation));
    let [j, f] = classical_velocity_matrices(node, position, rates);
    let sum = |a: &Matrix6, b: &Matrix6| core::array::from_fn(|i| core::array::from_fn(|c| a[i][c] + b[i][c]));
    let dragging = skew(&frame_spin).map(|row| row.map(|x| -x));
    RateMatrices {
        measure: blocks(&dragging, &ZERO, &ZERO, &ZERO),
        node: sum(&j, &by_spin),
        frame: sum(&f, &by_frame_spin),
    }
}

fn sum_3(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    core::array::from_fn(|i| core::array::from_fn(|j| a[i][j] + b[i][j]))
}
