//! Proof of what the reduction preserves.
//!
//! Verification never changes a result. It measures, names the equation and compares with a limit of the form
//! max(engineering, arithmetic, data); each line says which of the three was active. The identifiers are stable.

pub mod check;
mod completeness;
mod eigenpairs;
mod mass;
mod reduced;
mod rigid_motion;

use crate::basis::{Basis, ConstraintModes};
use crate::error::Result;
use crate::job::Expectation;
use crate::modes::{Certificate, Equilibrated, Retained};
use crate::partition::Partition;
use crate::reduction::Reduction;
use crate::rigid::{InterfaceRank, RigidBodyModes};
use crate::sparse::SparseMatrix;

use check::Check;

/// Everything the checks look at: the results of the stages, none of their workings.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// The partitioned matrices.
    pub partition: &'a Partition,
    /// K_II and M_II.
    pub internal: (&'a SparseMatrix, &'a SparseMatrix),
    /// The rigid-body modes.
    pub rigid: &'a RigidBodyModes,
    /// How well the interface reacts them.
    pub rank: InterfaceRank,
    /// The constraint modes.
    pub constraint: &'a ConstraintModes,
    /// The retained modes.
    pub retained: &'a Retained,
    /// The basis.
    pub basis: &'a Basis,
    /// The reduced matrices.
    pub reduction: &'a Reduction,
    /// The Sturm count, where one was asked for.
    pub certificate: Option<&'a Certificate>,
    /// What the user expects of the mass properties.
    pub expect: Option<&'a Expectation>,
}

/// All checks, in the order of their identifiers.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub fn verify(evidence: &Evidence<'_>) -> Result<Vec<Check>> {
    let spectrum = reduced::Spectrum::of(evidence)?;
    let mut checks = vec![
        eigenpairs::backward_error(evidence),
        eigenpairs::orthogonality(evidence),
        rigid_motion::energy(evidence, &spectrum),
        rigid_motion::residual(evidence),
    ];
    checks.extend(completeness::count(evidence));
    checks.push(eigenpairs::data_precision(evidence));
    checks.push(rigid_motion::carried_by_interface(evidence));
    checks.push(rigid_motion::null_space(evidence));
    checks.push(rigid_motion::zero_modes(evidence, &spectrum));
    checks.push(reduced::block_coupling(evidence));
    checks.push(reduced::pair_residual(evidence));
    checks.push(reduced::frequency_difference(evidence, &spectrum));
    checks.push(mass::preserved(evidence));
    checks.extend(mass::expected(evidence));
    checks.push(reduced::symmetry(evidence));
    checks.push(reduced::definiteness(evidence, &spectrum));
    Ok(checks)
}

/// The norms of the reduced pencil that backward errors are relative to.
fn reduced_norms(reduction: &Reduction) -> Equilibrated {
    Equilibrated::of_dense(reduction.stiffness.as_ref(), reduction.mass.as_ref())
}
