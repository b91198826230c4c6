//! What damping does to a component: the measures of M-28 that a reduction and the verification of its file share.
//!
//! ```text
//! D = diag(1/√(K̂ + λ₁M̂)_ii)                 S = D Ĉ D
//! s = β + max DTD                           T_ij what Ĉ_ij is a sum of, β K̂ counted as β (K̂ + λ₁M̂)
//! max ‖D Ĉû‖ / (s ‖D⁻¹û‖)                   force of rigid-body motion, as M-12 measures that of the stiffness
//! −min λ(S + Sᵀ) / max(|λ(S + Sᵀ)|, 2s)     what damping puts into a motion, relative to what it takes from another
//! ```
//! Where nothing deforms, Ĉ is the rounding of terms that cancel, and its own entries are no unit for its forces.

use faer::{Mat, MatRef};
use supel_runtime::MatrixKind;

use super::check::{Check, Limits};
use super::evidence::{Evidence, coordinate_name, rigid_name};
use super::limits::{self, Judged};
use super::rigid_motion::Disturbance;
use crate::dense;
use crate::error::Result;
use crate::job::RigidMotionDamping;
use crate::reduction::panel_of;
use crate::sparse::panels;

/// A damped component in units of its own.
#[derive(Clone, Copy)]
pub(crate) struct Damped<'a> {
    /// Ĉ, r × r.
    pub(crate) damping: MatRef<'a, f64>,
    /// T, what each entry is a sum of, r × r.
    pub(crate) sizes: MatRef<'a, f64>,
    /// β.
    pub(crate) stiffness_share: f64,
    /// K̂, r × r.
    pub(crate) stiffness: MatRef<'a, f64>,
    /// M̂, r × r.
    pub(crate) mass: MatRef<'a, f64>,
    /// Û, r × n_r.
    pub(crate) motions: MatRef<'a, f64>,
    /// The first elastic eigenvalue.
    pub(crate) first: f64,
}

/// Motions of a body as a whole: further ones of Û are those of mechanisms, which may be damped.
const WHOLE: usize = 6;

impl Damped<'_> {
    /// The diagonal of D.
    fn scales(&self) -> Vec<f64> {
        let size = |i: usize| self.stiffness[(i, i)] + self.first * self.mass[(i, i)];
        (0..self.stiffness.nrows()).map(|i| if size(i) > 0.0 { 1.0 / size(i).sqrt() } else { 1.0 }).collect()
    }

    /// DAD. One product of both scales, so that a skew matrix stays skew to the bit.
    fn scaled(&self, a: MatRef<'_, f64>) -> Mat<f64> {
        let (r, scales) = (self.stiffness.nrows(), self.scales());
        Mat::from_fn(r, r, |i, j| a[(i, j)] * (scales[i] * scales[j]))
    }

    /// s.
    fn size(&self) -> f64 {
        self.stiffness_share + self.scaled(self.sizes).norm_max()
    }

    /// The largest force on a motion of the body as a whole, relative to s and to the size of the motion, with the motion and the
    /// coordinate.
    fn relative_force(&self, forces: MatRef<'_, f64>) -> (f64, Option<[usize; 2]>) {
        let (scales, largest) = (self.scales(), self.size());
        let mut worst = (0.0, None);
        for motion in 0..self.motions.ncols().min(WHOLE) {
            let scaled = |v: &[f64], by: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
                v.iter().zip(&scales).map(|(value, scale)| by(*value, *scale)).collect()
            };
            let force = scaled(dense::column(forces, motion), &|f, d| f * d);
            let own = largest * dense::norm(&scaled(dense::column(self.motions, motion), &|x, d| x / d));
            let error = if own > 0.0 { dense::norm(&force) / own } else { 0.0 };
            if dense::worse(error, worst.0) {
                let at = (0..force.len()).max_by(|a, b| force[*a].abs().total_cmp(&force[*b].abs()));
                worst = (error, at.map(|at| [motion, at]));
            }
        }
        worst
    }
}

/// M-28 of a damped component; `judged` is how a force of rigid-body motion is judged, and `name` says what a motion is called and where
/// its force is.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(crate) fn checks(
    damped: Damped<'_>,
    (judged, rigid_motion): (Judged, RigidMotionDamping),
    name: &dyn Fn(usize, usize) -> String,
) -> Result<Vec<Check>> {
    let judged = match rigid_motion {
        RigidMotionDamping::Refuse => judged,
        RigidMotionDamping::Resist => Judged { limits: Limits::NONE, fail_above: f64::INFINITY },
    };
    let resistance = (damped.motions.ncols() > 0).then(|| resistance(damped, judged, name));
    Ok(resistance.into_iter().chain([energy(damped)?]).collect())
}

fn resistance(
    damped: Damped<'_>,
    Judged { limits, fail_above }: Judged,
    name: &dyn Fn(usize, usize) -> String,
) -> Check {
    // Forces on a rigid-body motion, and those that deformation makes on the body as a whole.
    let own = damped.relative_force(dense::product(damped.damping, damped.motions).as_ref());
    let made = damped.relative_force(dense::product(damped.damping.transpose(), damped.motions).as_ref());
    let worst = if dense::worse(made.0, own.0) { made } else { own };
    Check {
        id: "M-28",
        name: "damping leaves rigid-body motion alone",
        equation: "max ‖ĈÛ‖, ‖ĈᵀÛ‖ / (s ‖Û‖), s = max of the terms of Ĉ, in scales of K̂ + λ₁M̂",
        value: worst.0,
        limits,
        fail_above,
        worst: worst.1.map(|[motion, at]| name(motion, at)),
    }
}

/// Damping that drives a motion is possible, as that of a fluid, and rarely meant: it warns.
fn energy(damped: Damped<'_>) -> Result<Check> {
    /// What digits of single precision leave of a damping that takes nothing.
    const DIGITS: f64 = 1e-6;
    let scaled = damped.scaled(damped.damping);
    let r = scaled.nrows();
    let sum = Mat::from_fn(r, r, |i, j| scaled[(i, j)] + scaled[(j, i)]);
    let (values, _) = dense::symmetric_eigen(sum.as_ref())?;
    // Of a skew matrix nothing is left but rounding.
    let largest = values.iter().fold(2.0 * damped.size(), |max, value| max.max(value.abs()));
    let least = values.first().copied().unwrap_or(0.0).min(0.0);
    Ok(Check {
        id: "M-28",
        name: "damping takes energy from every motion",
        equation: "−min λ / max(|λ|, 2s), λ of Ĉ + Ĉᵀ in scales of K̂ + λ₁M̂, s = max of the terms of Ĉ",
        value: if largest > 0.0 { -least / largest } else { 0.0 },
        limits: Limits { engineering: DIGITS, ..Limits::default() },
        fail_above: Check::NEVER,
        worst: None,
    })
}

/// M-28 of a reduction.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn of_reduction(evidence: &Evidence<'_>, disturbance: &Disturbance) -> Result<Vec<Check>> {
    let Some(damping) = evidence.damping else { return Ok(Vec::new()) };
    let model = evidence.reduction.in_user_units(evidence.partition);
    let damped = Damped {
        damping: damping.matrix.as_ref(),
        sizes: damping.sizes.as_ref(),
        stiffness_share: damping.stiffness_share,
        stiffness: model.stiffness.as_ref(),
        mass: model.mass.as_ref(),
        motions: model.rigid_body_modes.as_ref(),
        first: disturbance.first * evidence.partition.scaling.eigenvalue_unit(),
    };
    // The digits of the damping matrices have a rounding of their own.
    let of_digits = damped.relative_force(rounding_of_forces(evidence).as_ref()).0;
    let share = if of_digits > disturbance.noise { 1.0 } else { disturbance.share_of_data };
    let judged = limits::of_force(of_digits.max(disturbance.noise), share);
    let name = |mode: usize, at: usize| format!("{}, {}", rigid_name(evidence, mode), coordinate_name(evidence, at));
    checks(damped, (judged, damping.rigid_motion), &name)
}

/// Σ ρ|Ψ|ᵀ|T|ᵀ(|C| + |Cᵀ|)|T||U| over the damping matrices, r × n_r, in the user's units: what their digits, to a share ρ, may make of forces.
fn rounding_of_forces(evidence: &Evidence<'_>) -> Mat<f64> {
    let (partition, u) = (evidence.partition, evidence.rigid.modes.as_ref());
    let (n_b, shape) = (partition.n_interface(), partition.scaling.shape_unit());
    let mut terms = Mat::zeros(u.nrows(), u.ncols());
    for carried in partition.matrices.iter().filter(|carried| carried.facts.kind == MatrixKind::Damping) {
        let [forces, made] = carried.sizes_of_forces(u);
        let both = forces + made;
        terms += both * faer::Scale(carried.facts.unit * carried.facts.rounding);
    }
    let r = evidence.basis.n_reduced();
    let mut forces = Mat::zeros(r, u.ncols());
    for columns in panels(r) {
        let sizes = dense::absolute(panel_of(evidence.basis, columns.clone()).as_ref());
        forces
            .as_mut()
            .subrows_mut(columns.start, columns.len())
            .copy_from(dense::gram(sizes.as_ref(), terms.as_ref()));
    }
    Mat::from_fn(r, u.ncols(), |i, j| forces[(i, j)] * if i < n_b { 1.0 } else { shape })
}
