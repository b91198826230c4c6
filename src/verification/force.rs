//! Force of rigid-body motion in a reduced stiffness: the one measure of M-12 that a reduction and the verification of its file share.
//!
//! ```text
//! D = diag(1/√(K̂ + λ₁M̂)_ii)
//! max ‖D K̂û‖ / ‖D⁻¹û‖                   force of a motion, relative to that of an elastic one of the same size
//! ```
//! A coordinate that rigid-body motion moves alone has no stiffness, and one that turns about the line on which all mass lies has no inertia
//! either. What rounding leaves of the two is no unit: the rounding of K̂ would be a force as large as any. Such a coordinate takes the unit
//! of the largest inertia of its kind, which is what an elastic motion of the same size has there.

use faer::{Mat, MatRef};

use super::check::Check;
use super::limits::Judged;
use crate::dense::{self, NOISE_FACTOR};
use crate::dofs::Direction;

/// The diagonal of D for K̂, M̂ and Û; interface coordinates of nodes have a direction.
pub(crate) fn scales(
    parts: (MatRef<'_, f64>, MatRef<'_, f64>, MatRef<'_, f64>),
    first: f64,
    directions: &[Option<Direction>],
) -> Vec<f64> {
    // Exact roots and no powers of two: those depend on the units, and the value would by a factor of two.
    let scale = |size: f64| if size > 0.0 { 1.0 / size.sqrt() } else { 1.0 };
    sizes(parts, first, directions).into_iter().map(scale).collect()
}

/// (K̂ + λ₁M̂)_ii of each coordinate, or what stands for it.
pub(crate) fn sizes(
    (k, m, u): (MatRef<'_, f64>, MatRef<'_, f64>, MatRef<'_, f64>),
    first: f64,
    directions: &[Option<Direction>],
) -> Vec<f64> {
    // M̂_ii is a sum over the masses whose terms add up to no more than the largest inertia of its kind: rounding leaves ε of that one.
    const NOTHING: f64 = NOISE_FACTOR * f64::EPSILON;
    let carried = carried(u);
    let of_kind = |is_rotation: bool| {
        let is_one = |i: &usize| carried[*i] && directions[*i].is_some_and(|of| of.is_rotation() == is_rotation);
        (0..m.nrows()).filter(is_one).map(|i| m[(i, i)]).fold(0.0, f64::max)
    };
    let largest = [of_kind(false), of_kind(true)];
    let size = |i: usize| match directions[i].map(|of| largest[usize::from(of.is_rotation())]) {
        Some(largest) if carried[i] && largest > 0.0 && m[(i, i)] <= NOTHING * largest => first * largest,
        _ => k[(i, i)] + first * m[(i, i)],
    };
    (0..k.nrows()).map(size).collect()
}

/// Whether each coordinate moves alone in some rigid-body motion of Û, r × n_r: without stiffness, whatever rounding leaves of K̂_ii.
pub(crate) fn carried(u: MatRef<'_, f64>) -> Vec<bool> {
    /// Of a coordinate, beyond what rigid-body motion moves of it: digits of Û.
    const ALONE: f64 = 1e-6;
    let r = u.nrows();
    if !(1..=r).contains(&u.ncols()) {
        return vec![false; r];
    }
    let mut left = Mat::<f64>::identity(r, r);
    let shares = dense::least_squares(u, left.as_ref());
    dense::add_product(left.as_mut(), -1.0, u, shares.as_ref());
    (0..r).map(|i| dense::norm(dense::column(left.as_ref(), i)) < ALONE).collect()
}

/// M-12: the largest force of the motions Û in these scales; `name` says what a motion is called and where its force is largest.
pub(crate) fn of_rigid_motion(
    (k, u): (MatRef<'_, f64>, MatRef<'_, f64>),
    scales: &[f64],
    Judged { limits, fail_above }: Judged,
    name: &dyn Fn(usize, usize) -> String,
) -> Check {
    let forces = dense::product(k, u);
    let mut worst = (0.0, None);
    for j in 0..u.ncols() {
        let scaled = |v: &[f64], by: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
            v.iter().zip(scales).map(|(value, scale)| by(*value, *scale)).collect()
        };
        let force = scaled(dense::column(forces.as_ref(), j), &|f, d| f * d);
        let error = dense::norm(&force) / dense::norm(&scaled(dense::column(u, j), &|x, d| x / d));
        if dense::worse(error, worst.0) {
            let at = (0..force.len()).max_by(|a, b| force[*a].abs().total_cmp(&force[*b].abs()));
            worst = (error, at.map(|at| name(j, at)));
        }
    }
    Check {
        id: "M-12",
        name: "rigid-body motion makes no force",
        equation: "max ‖K̂Û‖ / ‖Û‖, in scales of K̂ + λ₁M̂",
        value: worst.0,
        limits,
        fail_above,
        worst: worst.1,
    }
}
