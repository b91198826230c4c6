//! The damping matrix of a component from its parts.

use faer::Mat;
use supel_runtime::MatrixKind;

use super::law::{Law, Reduced};
use crate::dense;
use crate::error::{Error, Result};
use crate::job::{Job, RigidMotionDamping};
use crate::partition::Partition;
use crate::reduction::{Reduction, UserUnits};

/// Largest error of modal damping that is put down to rounding.
const LARGEST_ROUNDING: f64 = 1e-3;

/// Ĉ of a component, with what is known of it.
#[derive(Clone, Debug)]
pub struct Damping {
    /// Ĉ, r × r, in the user's units.
    pub matrix: Mat<f64>,
    /// What each entry is made from: Σ|ΨᵀCΨ|_ij + √(L_ii L_jj) with L the part that is made of K̂ and M̂, rigid-body motion in it, r × r.
    pub sizes: Mat<f64>,
    /// β, the share of K̂ in it.
    pub stiffness_share: f64,
    /// What rounding may make of an entry, relative to its size.
    pub rounding: f64,
    /// What rounding may leave of an entry whose terms cancel, r × r.
    pub left: Mat<f64>,
    /// Whether it may resist rigid-body motion.
    pub rigid_motion: RigidMotionDamping,
}

impl Damping {
    /// The damping that a job asks for, of a reduction.
    ///
    /// # Errors
    /// The errors of [`Damping::of`].
    pub fn of_reduction(job: &Job, partition: &Partition, reduction: &Reduction) -> Result<Option<Self>> {
        if !job.has_damping() {
            return Ok(None);
        }
        let UserUnits { stiffness, mass, rigid_body_modes, matrices } = reduction.in_user_units(partition);
        let reduced = Reduced {
            stiffness: stiffness.as_ref(),
            mass: mass.as_ref(),
            motions: rigid_body_modes.as_ref(),
            mass_rank: reduction.mass_rank(),
        };
        let all = partition.matrices.iter().zip(&matrices);
        let damping = all.filter(|(carried, _)| carried.facts.kind == MatrixKind::Damping).map(|(_, matrix)| matrix);
        match Self::of(job, reduced, damping) {
            Err(Error::DenseEigen { .. }) if partition.has_few_digits() => {
                Err(partition.precision.stiffness.too_uncertain(
                    "the elastic modes of the reduced model, which damping acts on, from motions of energy below zero"
                        .to_owned(),
                ))
            }
            damping => damping,
        }
    }

    /// The damping that a job asks for, from its damping matrices ΨᵀCΨ in the user's units; none where it asks for none.
    ///
    /// # Errors
    /// [`Error::DampingModes`](crate::error::Error::DampingModes); a dense eigenproblem that does not converge.
    pub fn of<'a>(
        job: &Job,
        reduced: Reduced<'_>,
        matrices: impl IntoIterator<Item = &'a Mat<f64>>,
    ) -> Result<Option<Self>> {
        let r = reduced.stiffness.nrows();
        let (mut matrix, mut sizes, mut is_there) = (Mat::zeros(r, r), Mat::zeros(r, r), false);
        let mut left = Mat::zeros(r, r);
        for part in matrices {
            matrix += part;
            sizes += dense::absolute(part.as_ref());
            is_there = true;
        }
        let law = job.damping.as_ref().map(|damping| Law::of(damping, reduced)).transpose()?.flatten();
        let spread = law.as_ref().map_or(1.0, |law| law.spread);
        if let Some(law) = law {
            let ends: Vec<f64> = law.sizes.iter().map(|size| size.max(0.0).sqrt()).collect();
            sizes += Mat::from_fn(r, r, |i, j| ends[i] * ends[j]);
            let share = dense::NOISE_FACTOR * r as f64 * f64::EPSILON;
            left = Mat::from_fn(r, r, |i, j| share * (law.terms[i] * law.terms[j]).sqrt());
            matrix += law.matrix;
            is_there = true;
        }
        // An eigenvalue is known to ε of the largest one, and its share in Ĉ with it.
        let rounding = dense::NOISE_FACTOR * r as f64 * f64::EPSILON * spread;
        let rounding = rounding.min(LARGEST_ROUNDING);
        let rayleigh = job.damping.as_ref().and_then(|damping| damping.rayleigh);
        let (stiffness_share, rigid_motion) = (rayleigh.map_or(0.0, |rayleigh| rayleigh.stiffness), job.rigid_motion());
        Ok(is_there.then(|| Self { matrix, sizes, stiffness_share, rounding, left, rigid_motion }))
    }
}
