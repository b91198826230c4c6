//! Damping in the file against the rest of it: M-28.

use faer::Mat;
use supel_runtime::MatrixKind;

use super::content::Content;
use crate::damping::{Damping, Reduced};
use crate::dense::{self, unpacked};
use crate::error::{Error, Result};
use crate::job::{Job, RigidMotionDamping};
use crate::verification::check::{Check, Limits};
use crate::verification::damping::{Damped, Judging, checks};

/// M-28: what damping does, and that it is what the job kept in the file makes of the other matrices.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn of_file(content: &Content<'_>) -> Result<Vec<Check>> {
    let Some(stored) = content.superelement.tensors().damping.as_ref().map(unpacked) else { return Ok(Vec::new()) };
    let job = content.job().filter(|job| job.has_damping());
    let made = job.map(|job| made(content, job)).transpose()?;
    let known = made.iter().flatten().next();
    let sizes = known.map_or_else(|| dense::absolute(stored.as_ref()), |made| made.sizes.clone());
    let scales = content.force_scales();
    let damped = Damped {
        damping: stored.as_ref(),
        sizes: sizes.as_ref(),
        stiffness_share: known.map_or(0.0, |made| made.stiffness_share),
        scales: &scales,
        motions: content.u.as_ref(),
    };
    let rigid_motion = content.job().map_or(RigidMotionDamping::Refuse, Job::rigid_motion);
    let name = |mode: usize, at: usize| format!("rigid-body mode {}, {}", mode + 1, content.name_of(at));
    let judging = Judging {
        of_force: content.damping_force_limits(),
        of_digits: content.recorded_damping_energy(),
        rigid_motion,
    };
    let mut all = checks(damped, judging, &name)?;
    all.extend(made.map(|made| sum(content, made.as_ref(), &stored)));
    Ok(all)
}

/// What the job makes of the matrices of the file; none where the file has other modes or matrices than the job names, or none of which
/// damping can be made.
fn made(content: &Content<'_>, job: &Job) -> Result<Option<Damping>> {
    let matrices = content.superelement.further_matrices();
    let damping = matrices.filter(|(named, _)| named.kind == MatrixKind::Damping).map(|(_, matrix)| unpacked(matrix));
    let damping: Vec<Mat<f64>> = damping.collect();
    let reduced = Reduced {
        stiffness: content.k.as_ref(),
        mass: content.m.as_ref(),
        motions: content.u.as_ref(),
        mass_rank: content.mass_rank,
    };
    match Damping::of(job, reduced, &damping) {
        Err(Error::DampingModes { .. } | Error::DenseEigen { .. }) => Ok(None),
        other => other,
    }
}

/// M-28: Ĉ is the sum of the damping matrices and of what the job makes of K̂ and M̂.
fn sum(content: &Content<'_>, made: Option<&Damping>, stored: &Mat<f64>) -> Check {
    /// The sum is taken again in the same order.
    const AGAIN: f64 = 1e-12;
    let mut worst = (if made.is_some() { 0.0 } else { f64::INFINITY }, None);
    if let Some(made) = made {
        for (i, j) in (0..stored.ncols()).flat_map(|j| (0..stored.nrows()).map(move |i| (i, j))) {
            let (difference, size) = ((stored[(i, j)] - made.matrix[(i, j)]).abs(), made.sizes[(i, j)]);
            let error = if difference <= made.left[(i, j)] { 0.0 } else { difference / size };
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("{} and {}", content.name_of(i), content.name_of(j))));
            }
        }
    }
    let rounding = made.map_or(0.0, |made| made.rounding);
    let limits = Limits { engineering: AGAIN, arithmetic: rounding, data: 0.0 };
    Check {
        id: "M-28",
        name: "damping is what its job makes of the matrices",
        equation: "max |Ĉ − Σ ΨᵀCΨ − L|_ij / (Σ |ΨᵀCΨ|_ij + √(L_ii L_jj)), L made of K̂ and M̂",
        value: worst.0,
        limits,
        fail_above: limits.value(),
        worst: worst.1,
    }
}
