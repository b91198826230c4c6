//! Classical measures E = (d; κ), eqs. (90), (91), for the displacement of the node instead of that of the origin.
//!
//! A change of the place is one of d and of R, R ψ̃ with the relative turn ψ = Δθ_j − RᵀΔθ_F.

use super::node::{NodeMeasure, NodeRates, PlaceMatrices, RateMatrices, sum_6};
use crate::motion::{
    IDENTITY_3, Matrix3, Matrix6, Motion, Vector3, Vector6, ZERO_3, blocks, cross, join, multiply_3, skew, split,
    times_3, times_6, transposed_times_3,
};

/// J = [R, −R x̃; 0, ½(tr R I − Rᵀ)], F = [I, −(x + d)~; 0, ½(tr R I − R)], in the coordinates of the node.
pub(super) fn measure(motion: &Motion, position: &Vector3) -> NodeMeasure {
    let r = &motion.rotation;
    let moved = motion.apply(position);
    let d = core::array::from_fn(|i| moved[i] - position[i]);
    let (node_turn, frame_turn) = skew_part_derivatives(r);
    NodeMeasure {
        motion: *motion,
        e: join(&d, &axial(r)),
        j: blocks(r, &negative(&multiply_3(r, &skew(position))), &ZERO_3, &node_turn),
        f: blocks(&IDENTITY_3, &negative(&skew(&moved)), &ZERO_3, &frame_turn),
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

/// Angular velocity of the node against the floating frame, in the node: ω_E = ω − Rᵀω_F.
fn relative_spin(node: &NodeMeasure, rates: &NodeRates) -> Vector3 {
    let frame_spin = transposed_times_3(&node.motion.rotation, &split(&rates.frame).1);
    core::array::from_fn(|i| rates.node[3 + i] - frame_spin[i])
}

pub(super) fn rates_times(node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> Vector6 {
    let matrices = velocity_matrices(node, position, rates);
    let (of_node, of_frame) = (times_6(&matrices[0], &rates.node), times_6(&matrices[1], &rates.frame));
    core::array::from_fn(|i| of_node[i] - of_frame[i])
}

/// J̇ = [Ṙ, −Ṙ x̃; 0, ½(tr Ṙ I − Ṙᵀ)] and Ḟ = [0, −d̃˙; 0, ½(tr Ṙ I − Ṙ)] with Ṙ = R ω̃_E.
fn velocity_matrices(node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> [Matrix6; 2] {
    let r_rate = multiply_3(&node.motion.rotation, &skew(&relative_spin(node, rates)));
    let (node_turn, frame_turn) = skew_part_derivatives(&r_rate);
    [
        blocks(&r_rate, &negative(&multiply_3(&r_rate, &skew(position))), &ZERO_3, &node_turn),
        blocks(&ZERO_3, &negative(&skew(&split(&rates.measure).0)), &ZERO_3, &frame_turn),
    ]
}

/// J̇ and Ḟ, and those of [`carried`]: ω_E = ω − Rᵀω_F passes its derivative on to V and V_F as ψ does to ΔU_j and ΔU_F.
pub(super) fn rate_matrices(node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> RateMatrices {
    let by_turn = by_turn(&turned(node, position, [&rates.node, &rates.frame]), node);
    let [j, f] = velocity_matrices(node, position, rates);
    RateMatrices {
        measure: blocks(&dragged(&rates.frame), &ZERO_3, &ZERO_3, &ZERO_3),
        node: sum_6(&j, &by_turn.node),
        frame: sum_6(&f, &by_turn.frame),
    }
}

/// Derivative of J x − F x_F by the place: that of [`turned`] by ψ, and d̃ω_F = −ω̃_F d by d.
pub(super) fn carried(node: &NodeMeasure, position: &Vector3, [x, x_f]: [&Vector6; 2]) -> PlaceMatrices {
    let by_turn = by_turn(&turned(node, position, [x, x_f]), node);
    by_turn.plus(&by_displacement([dragged(x_f), ZERO_3], node))
}

/// Derivative of J x − F x_F by ψ: (−R ã; −(ω − ω_F) κᵀ − ½ (Rᵀω)~ − ½ R ω̃_F), with a the part of x at the node in its own axes.
fn turned(node: &NodeMeasure, position: &Vector3, [x, x_f]: [&Vector6; 2]) -> [Matrix3; 2] {
    let r = &node.motion.rotation;
    let (spin, frame_spin) = (split(x).1, split(x_f).1);
    let kappa = axial(r);
    let translation = negative(&multiply_3(r, &skew(&at_node(x, position))));
    let (back, carried) = (skew(&transposed_times_3(r, &spin)), multiply_3(r, &skew(&frame_spin)));
    let rotation = from(|i, j| -(spin[i] - frame_spin[i]) * kappa[j] - 0.5 * (back[i][j] + carried[i][j]));
    [translation, rotation]
}

/// Derivative of y = (R (ω_E × a) + ḋ × ω_F; −(κᵀω_E)(ω − ω_F) − ½ Rᵀω × ω_E − ½ R (ω_F × ω_E)) by ψ, at fixed ḋ, V and V_F,
/// where Δω_E = −s̃ ψ with s = Rᵀω_F.
pub(super) fn rates_by_place(node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> PlaceMatrices {
    let r = &node.motion.rotation;
    let (spin, frame_spin) = (split(&rates.node).1, split(&rates.frame).1);
    let (spin_e, frame_in_node, back) =
        (relative_spin(node, rates), transposed_times_3(r, &frame_spin), transposed_times_3(r, &spin));
    let velocity = at_node(&rates.node, position);
    let kappa = axial(r);
    let product = |a: &Vector3, b: &Vector3| multiply_3(&skew(a), &skew(b));
    // R (ψ × (ω_E × a)) + R (Δω_E × a).
    let (turned, spun) = (skew(&cross(&spin_e, &velocity)), product(&velocity, &frame_in_node));
    let translation = multiply_3(r, &from(|i, j| spun[i][j] - turned[i][j]));
    // ψᵀ(∂κ)ᵀω_E + κᵀΔω_E, as a row.
    let (node_turn, _) = skew_part_derivatives(r);
    let (of_kappa, of_spin) = (transposed_times_3(&node_turn, &spin_e), cross(&frame_in_node, &kappa));
    let along: Vector3 = core::array::from_fn(|i| of_kappa[i] + of_spin[i]);
    // Δ(Rᵀω) × ω_E + Rᵀω × Δω_E, and R (ψ × (ω_F × ω_E)) + R (ω_F × Δω_E).
    let (first, second) = (product(&spin_e, &back), product(&back, &frame_in_node));
    let (third, fourth) = (skew(&cross(&frame_spin, &spin_e)), product(&frame_spin, &frame_in_node));
    let carried = multiply_3(r, &from(|i, j| third[i][j] + fourth[i][j]));
    let rotation =
        from(|i, j| -(spin[i] - frame_spin[i]) * along[j] + 0.5 * (first[i][j] + second[i][j]) + 0.5 * carried[i][j]);
    by_turn(&[translation, rotation], node)
}

/// Derivatives of Jᵀh and Fᵀh: with q = Rᵀh_u they are (q̃; x̃ q̃ − h_p κᵀ + ½ R h̃_p) and (0; −h_p κᵀ − ½ (Rᵀh_p)~) by ψ, of
/// which the second has (0; −h̃_u) by d.
pub(super) fn forces_by_place(node: &NodeMeasure, position: &Vector3, h: &Vector6) -> [PlaceMatrices; 2] {
    let r = &node.motion.rotation;
    let (h_u, h_p) = split(h);
    let kappa = axial(r);
    let pulled = skew(&transposed_times_3(r, &h_u));
    let (lever, turned, back) =
        (multiply_3(&skew(position), &pulled), multiply_3(r, &skew(&h_p)), skew(&transposed_times_3(r, &h_p)));
    let of_node = from(|i, j| lever[i][j] - h_p[i] * kappa[j] + 0.5 * turned[i][j]);
    let of_frame = from(|i, j| -h_p[i] * kappa[j] - 0.5 * back[i][j]);
    let on_frame = by_turn(&[ZERO_3, of_frame], node);
    [by_turn(&[pulled, of_node], node), on_frame.plus(&by_displacement([ZERO_3, negative(&skew(&h_u))], node))]
}

/// A derivative by ψ, its translation and its rotation rows, as one by the place.
fn by_turn([translation, rotation]: &[Matrix3; 2], node: &NodeMeasure) -> PlaceMatrices {
    // Rows of A Rᵀ.
    let back = |a: &Matrix3| a.map(|row| times_3(&node.motion.rotation, &row));
    PlaceMatrices {
        node: blocks(&ZERO_3, translation, &ZERO_3, rotation),
        frame: blocks(&ZERO_3, &back(translation), &ZERO_3, &back(rotation)),
    }
}

/// A derivative by d as one by the place.
fn by_displacement([translation, rotation]: [Matrix3; 2], node: &NodeMeasure) -> PlaceMatrices {
    PlaceMatrices::of_measure(&blocks(&translation, &ZERO_3, &rotation, &ZERO_3), node)
}

/// −ω̃_F.
fn dragged(x_f: &Vector6) -> Matrix3 {
    negative(&skew(&split(x_f).1))
}

/// The part of x at the node, in its own axes: v − x̃ ω.
fn at_node(x: &Vector6, position: &Vector3) -> Vector3 {
    let (v, spin) = split(x);
    let lever = cross(position, &spin);
    core::array::from_fn(|i| v[i] - lever[i])
}

fn negative(a: &Matrix3) -> Matrix3 {
    a.map(|row| row.map(|x| -x))
}

fn from(entry: impl Fn(usize, usize) -> f64) -> Matrix3 {
    core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)))
}
