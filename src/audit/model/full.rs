//! The full model by a factor of K − σM on all its dofs: which motions are free, and the first elastic eigenvalue.

use crate::error::Result;
use crate::factor::{Analysis, Cholesky};
use crate::modes::{ModalProblem, shifted};
use crate::partition::Partition;
use crate::rigid::RigidBodyModes;
use crate::sparse::product;

/// The full model with a factor of K − σM on all dofs.
pub(super) struct Full<'a> {
    pub(super) partition: &'a Partition,
    /// L Lᵀ = K − σM.
    pub(super) factor: Cholesky<'a>,
    /// σ < 0.
    pub(super) sigma: f64,
    /// Zero modes found by inverse iteration.
    pub(super) zero: RigidBodyModes,
    /// The first elastic eigenvalue.
    pub(super) first: f64,
    /// What roundings of K leave of an energy, relative to that: how far they turn motions towards each other.
    pub(super) noise: f64,
}

impl<'a> Full<'a> {
    /// Factors K − σM and finds the zero modes.
    ///
    /// # Errors
    /// K − σM is not definite; the eigensolver fails.
    pub(super) fn new(partition: &'a Partition, analysis: &'a Analysis) -> Result<Self> {
        let problem = ModalProblem::free(partition, None);
        let found = shifted(analysis, problem, &|dof| partition.name_of(dof))?;
        let shapes = found.lowest.shapes.as_ref().subcols(0, found.n_zero).to_owned();
        let first = found.lowest.lambda.get(found.n_zero).copied().or(found.lowest.next).unwrap_or(1.0);
        let looked_at = &found.lowest.errors[..found.lowest.count().min(found.n_zero + 1)];
        let noise = looked_at.iter().map(|error| error.zero_level / first).fold(0.0, f64::max);
        let zero = RigidBodyModes {
            modes: shapes.clone(),
            mass_orthonormal: product(&partition.mass, shapes.as_ref()),
            orthonormal: shapes,
            ..RigidBodyModes::none(partition.n_dofs())
        };
        Ok(Self { partition, factor: found.factor, sigma: found.sigma, zero, first, noise })
    }
}
