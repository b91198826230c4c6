//! Proof of what the reduction preserves.
//!
//! Verification never changes a result. It measures, names the equation and compares with a limit of the form
//! max(engineering, arithmetic, data); each line says which of the three was active. The identifiers are stable.

pub mod check;
mod completeness;
mod eigenpairs;
mod mass;
pub mod preservation;
mod reduced;
mod rigid_motion;

use crate::basis::{Basis, ConstraintModes};
use crate::dense;
use crate::error::Result;
use crate::job::Expectation;
use crate::modes::{Certificate, Equilibrated, Retained};
use crate::partition::Partition;
use crate::reduction::Reduction;
use crate::rigid::{InterfaceRank, RigidBodyModes};
use crate::sparse::SparseMatrix;

use check::Check;

pub use preservation::{Compared, preservation};

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

/// Scales of the reduced coordinates, powers of two: near 1/√K_BB,ii for an interface dof and near 1/√K̂_ηη,ii for a mode.
///
/// The stiffness of an interface dof before condensation is what rounding of K̂_BB is relative to. What condensation
/// leaves of it may be nothing: an interface that just holds the component has K̂_BB = 0.
fn coordinate_scales(evidence: &Evidence<'_>) -> Vec<f64> {
    let (partition, k) = (evidence.partition, &evidence.reduction.stiffness);
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let uncondensed = |i: usize| partition.stiffness.get(n_i + i, n_i + i).copied().unwrap_or(0.0);
    (0..k.nrows()).map(|i| dense::power_of_two_root(if i < n_b { uncondensed(i) } else { k[(i, i)] })).collect()
}

/// The norms of the reduced pencil that backward errors are relative to; that of K̂ is at least that of its terms before
/// they cancel, which is one in these scales.
fn reduced_norms(evidence: &Evidence<'_>) -> Equilibrated {
    let reduction = evidence.reduction;
    let mut norms =
        Equilibrated::of_dense(reduction.stiffness.as_ref(), reduction.mass.as_ref(), coordinate_scales(evidence));
    norms.stiffness_norm = norms.stiffness_norm.max(1.0);
    norms
}
