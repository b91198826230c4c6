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

use super::check::{Check, Limits, MAX_EXCUSE};
use super::evidence::{Evidence, coordinate_name, rigid_name};
use super::force;
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
    /// The diagonal of D.
    pub(crate) scales: &'a [f64],
    /// Û, r × n_r.
    pub(crate) motions: MatRef<'a, f64>,
}

/// Motions of a body as a whole: further ones of Û are those of mechanisms, which may be damped.
const WHOLE: usize = 6;

impl Damped<'_> {
    /// DAD. One product of both scales, so that a skew matrix stays skew to the bit.
    fn scaled(&self, a: MatRef<'_, f64>) -> Mat<f64> {
        let r = self.scales.len();
        Mat::from_fn(r, r, |i, j| a[(i, j)] * (self.scales[i] * self.scales[j]))
    }

    /// s.
    fn size(&self) -> f64 {
        self.stiffness_share + self.scaled(self.sizes).norm_max()
    }

    /// S + Sᵀ.
    fn twice_symmetric_part(&self) -> Mat<f64> {
        let scaled = self.scaled(self.damping);
        let r = scaled.nrows();
        Mat::from_fn(r, r, |i, j| scaled[(i, j)] + scaled[(j, i)])
    }

    /// ‖(S + Sᵀ)V‖_F / 2s, V orthonormal and spanning the rigid-body motions D⁻¹Û.
    fn force_on_rigid_motion(&self) -> f64 {
        let (scales, largest) = (self.scales, 2.0 * self.size());
        if self.motions.ncols() == 0 || largest == 0.0 {
            return 0.0;
        }
        let motions = Mat::from_fn(scales.len(), self.motions.ncols(), |i, j| self.motions[(i, j)] / scales[i]);
        let basis = motions.qr().compute_thin_Q();
        dense::product(self.twice_symmetric_part().as_ref(), basis.as_ref()).norm_l2() / largest
    }

    /// What a share of the terms of each entry of Ĉ may make of an eigenvalue of S + Sᵀ, relative to 2s: ‖DTD‖_F / s times as much.
    pub(crate) fn share_of_terms(&self, share: f64) -> f64 {
        let largest = self.size();
        if largest > 0.0 { share * self.scaled(self.sizes).norm_l2() / largest } else { 0.0 }
    }

    /// The largest force on a motion of the body as a whole, relative to s and to the size of the motion, with the motion and the
    /// coordinate.
    fn relative_force(&self, forces: MatRef<'_, f64>) -> (f64, Option<[usize; 2]>) {
        let largest = self.size();
        let mut worst = (0.0, None);
        for motion in 0..self.motions.ncols().min(WHOLE) {
            let scaled = |v: &[f64], by: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
                v.iter().zip(self.scales).map(|(value, scale)| by(*value, *scale)).collect()
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

/// By what the damping of a component is judged.
#[derive(Clone, Copy)]
pub(crate) struct Judging {
    /// How a force of rigid-body motion is.
    pub(crate) of_force: Judged,
    /// What digits of the damping matrices may make of an eigenvalue of S + Sᵀ, relative to 2s.
    pub(crate) of_digits: f64,
    /// What the job says of such forces.
    pub(crate) rigid_motion: RigidMotionDamping,
}

/// M-28 of a damped component; `name` says what a motion is called and where its force is.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(crate) fn checks(
    damped: Damped<'_>,
    judging: Judging,
    name: &dyn Fn(usize, usize) -> String,
) -> Result<Vec<Check>> {
    let judged = match judging.rigid_motion {
        RigidMotionDamping::Refuse => judging.of_force,
        RigidMotionDamping::Resist => Judged { limits: Limits::NONE, fail_above: f64::INFINITY },
    };
    let resistance = (damped.motions.ncols() > 0).then(|| resistance(damped, judged, name));
    Ok(resistance.into_iter().chain([energy(damped, judging)?]).collect())
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
fn energy(damped: Damped<'_>, judging: Judging) -> Result<Check> {
    let sum = damped.twice_symmetric_part();
    let (values, _) = dense::symmetric_eigen(sum.as_ref())?;
    // Of a skew matrix nothing is left but rounding.
    let largest = values.iter().fold(2.0 * damped.size(), |max, value| max.max(value.abs()));
    let least = values.first().copied().unwrap_or(0.0).min(0.0);
    Ok(Check {
        id: "M-28",
        name: "damping takes energy from every motion",
        equation: "−min λ / max(|λ|, 2s), λ of Ĉ + Ĉᵀ in scales of K̂ + λ₁M̂, s = max of the terms of Ĉ",
        value: if largest > 0.0 { -least / largest } else { 0.0 },
        limits: energy_limits(damped, judging),
        fail_above: Check::NEVER,
        worst: None,
    })
}

/// Limits of the energy that damping puts into a motion, relative to 2s.
///
/// ```text
/// V            orthonormal, spans D⁻¹Û
/// g s          ‖(S + Sᵀ)V‖_F / 2
/// [a bᵀ; b c]  S + Sᵀ along V and across it, c ⪰ 0 where damping takes energy from what deforms
/// min λ ≥ −(|a| + √(a² + 4b²)) / 2 ≥ −(1 + √5)/2 · 2 g s
/// ```
/// The digits of K and of the damping matrices leave a force on rigid-body motion where there should be none, and no more energy than twice
/// that force. It is excused as far as it is one that they explain: damping that drives what deforms has no excuse in it.
fn energy_limits(damped: Damped<'_>, Judging { of_force, of_digits, .. }: Judging) -> Limits {
    /// What digits of single precision leave of a damping that takes nothing.
    const DIGITS: f64 = 1e-6;
    /// Above (1 + √5) / 2.
    const TWICE: f64 = 2.0;
    let left = TWICE * damped.force_on_rigid_motion();
    let Limits { arithmetic, data, .. } = of_force.limits;
    let limits = Limits { engineering: DIGITS, arithmetic: arithmetic.min(left), data: data.min(left).max(of_digits) };
    limits.capped(MAX_EXCUSE, MAX_EXCUSE)
}

/// M-28 of a reduction.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn of_reduction(evidence: &Evidence<'_>, disturbance: &Disturbance) -> Result<Vec<Check>> {
    let Some(damping) = evidence.damping else { return Ok(Vec::new()) };
    let model = evidence.reduction.in_user_units(evidence.partition);
    let first = disturbance.first * evidence.partition.scaling.eigenvalue_unit();
    let parts = (model.stiffness.as_ref(), model.mass.as_ref(), model.rigid_body_modes.as_ref());
    let scales = force::scales(parts, first, &evidence.directions());
    let damped = Damped {
        damping: damping.matrix.as_ref(),
        sizes: damping.sizes.as_ref(),
        stiffness_share: damping.stiffness_share,
        scales: &scales,
        motions: model.rigid_body_modes.as_ref(),
    };
    // The digits of the damping matrices have a rounding of their own.
    let of_digits = damped.relative_force(rounding_of_forces(evidence).as_ref()).0;
    let share = if of_digits > disturbance.noise { 1.0 } else { disturbance.share_of_data };
    let of_force = limits::of_force(of_digits.max(disturbance.noise), share);
    let judging = Judging {
        of_force,
        of_digits: damped.share_of_terms(rounding_of_matrices(evidence)),
        rigid_motion: damping.rigid_motion,
    };
    let name = |mode: usize, at: usize| format!("{}, {}", rigid_name(evidence, mode), coordinate_name(evidence, at));
    checks(damped, judging, &name)
}

/// The largest ρ of the damping matrices.
fn rounding_of_matrices(evidence: &Evidence<'_>) -> f64 {
    let of_damping = evidence.partition.matrices.iter().filter(|carried| carried.facts.kind == MatrixKind::Damping);
    of_damping.map(|carried| carried.facts.rounding).fold(0.0, f64::max)
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
