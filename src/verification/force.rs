//! Force of rigid-body motion in a reduced stiffness: the one measure of M-12 that a reduction and the verification of its file share.
//!
//! ```text
//! D = diag(1/√(K̂ + λ₁M̂)_ii)
//! max ‖D K̂û‖ / ‖D⁻¹û‖                   force of a motion, relative to that of an elastic one of the same size
//! ```

use faer::MatRef;

use super::check::Check;
use super::limits::Judged;
use crate::dense;

/// M-12: the largest force of the motions Û; `name` says what a motion is called and where its force is largest.
pub(crate) fn of_rigid_motion(
    (k, m, u): (MatRef<'_, f64>, MatRef<'_, f64>, MatRef<'_, f64>),
    first: f64,
    Judged { limits, fail_above }: Judged,
    name: &dyn Fn(usize, usize) -> String,
) -> Check {
    // Exact roots and no powers of two: those depend on the units, and the value would by a factor of two.
    let size = |i: usize| k[(i, i)] + first * m[(i, i)];
    let scales: Vec<f64> = (0..k.nrows()).map(|i| if size(i) > 0.0 { 1.0 / size(i).sqrt() } else { 1.0 }).collect();
    let forces = dense::product(k, u);
    let mut worst = (0.0, None);
    for j in 0..u.ncols() {
        let scaled = |v: &[f64], by: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
            v.iter().zip(&scales).map(|(value, scale)| by(*value, *scale)).collect()
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
