//! Proof of what the reduction preserves.
//!
//! Verification never changes a result. It measures, names the equation and compares with a limit of the form
//! max(engineering, arithmetic, data); each line says which of the three was active. The identifiers are stable.

pub mod check;
mod completeness;
mod conditioning;
mod directions;
mod eigenpairs;
mod enclosure;
mod grounding;
pub(crate) mod limits;
mod loads;
mod mass;
mod penalty;
mod pencil;
pub mod preservation;
mod reduced;
mod residual;
mod rigid_body;
mod rigid_motion;
mod solves;
mod spectrum;

use crate::basis::{Basis, ConstraintModes, DynamicCoordinate};
use crate::dense;
use crate::error::Result;
use crate::factor::Cholesky;
use crate::job::Expectation;
use crate::modes::{Certificate, Equilibrated, Retained};
use crate::partition::Partition;
use crate::reduction::Reduction;
use crate::rigid::{InterfaceRank, RigidBodyModes};

use check::Check;

pub use enclosure::{CountProof, Enclosures, enclosures, enclosures_where_asked};
pub use grounding::{Grounding, Restraint};
pub use loads::EffectiveMasses;
pub(crate) use penalty::LARGEST_OF_MESHES;
pub use penalty::Penalties;
pub use preservation::{Compared, preservation};
pub use rigid_body::MassRoutes;

/// Everything the checks look at: the results of the stages, none of their workings.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// The partitioned matrices.
    pub partition: &'a Partition,
    /// The factor of K_II.
    pub factor: &'a Cholesky<'a>,
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
    /// The intervals that are proved to hold the modes, where they were asked for.
    pub enclosures: Option<&'a Enclosures>,
    /// What the user expects of the mass properties.
    pub expect: Option<&'a Expectation>,
}

/// What verification found.
#[derive(Clone, Debug)]
pub struct Findings {
    /// All checks, in the order of their identifiers.
    pub checks: Vec<Check>,
    /// The component as a rigid body, in scaled units.
    pub rigid_body: RigidBody,
    /// Rows whose stiffness takes the digits that checks ask for.
    pub penalties: Option<Penalties>,
}

/// The component as a rigid body.
#[derive(Clone, Debug)]
pub struct RigidBody {
    /// M_F by three routes, for one free body with coordinates.
    pub routes: Option<MassRoutes>,
    /// Eigenvalues of the zero modes of the reduced pencil.
    pub eigenvalues: Vec<f64>,
    /// How far motion in each direction is from straining the component.
    pub grounding: Vec<Grounding>,
    /// What the modes carry of the inertia in each direction.
    pub effective_mass: Option<EffectiveMasses>,
}

/// All checks and what they rest on.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub fn verify(evidence: &Evidence<'_>) -> Result<Findings> {
    let spectrum = spectrum::Spectrum::of(evidence)?;
    // Solves of one right-hand side and conjugate gradients leave a thread idle, which the products with the modes use.
    let ((condition, effective_mass), (pairs, terms)) = rayon::join(
        || (conditioning::internal_condition(evidence), loads::effective_masses(evidence)),
        || (eigenpairs::Pairs::of(evidence), reduced::Terms::of(evidence)),
    );
    let rigid_body = RigidBody {
        routes: rigid_body::mass_routes(evidence, &spectrum)?,
        eigenvalues: spectrum.rigid().to_vec(),
        grounding: grounding::groundings(evidence, &spectrum)?,
        effective_mass: effective_mass?,
    };
    let mut checks = vec![
        eigenpairs::backward_error(evidence, &pairs),
        eigenpairs::componentwise_error(evidence, &pairs),
        eigenpairs::orthogonality(evidence),
        eigenpairs::stiffness_orthogonality(evidence, &pairs),
        rigid_motion::energy(evidence, &spectrum, &rigid_body.grounding),
        rigid_motion::residual(evidence, &rigid_body.grounding),
    ];
    checks.extend(completeness::count(evidence));
    checks.extend(enclosure::checks(evidence));
    checks.push(eigenpairs::data_precision(evidence));
    checks.push(solves::static_solves(evidence)?);
    if evidence.partition.n_interface() > 0 {
        checks.push(rigid_motion::carried_by_interface(evidence));
    }
    checks.push(rigid_motion::null_space(evidence));
    checks.push(rigid_motion::zero_modes(evidence, &spectrum));
    checks.push(reduced::block_coupling(evidence, &terms));
    checks.push(reduced::pair_residual(evidence));
    checks.push(reduced::frequency_difference(evidence, &spectrum));
    checks.push(mass::preserved(evidence));
    checks.extend(rigid_body.routes.as_ref().map(|routes| rigid_body::routes_agree(evidence, &spectrum, routes)));
    checks.extend(mass::expected(evidence));
    checks.extend(loads::accelerations(evidence, condition));
    checks.extend(rigid_body.effective_mass.as_ref().and_then(loads::effective_mass));
    checks.extend(conditioning::conditioning(evidence, condition)?);
    checks.push(reduced::symmetry(evidence, &terms));
    checks.push(reduced::definiteness(evidence, &spectrum));
    let penalties = penalty::penalties(evidence, spectrum.first_elastic());
    Ok(Findings { checks, rigid_body, penalties })
}

/// What a rigid-body mode is called: `rotation z` of one free body, else by its number.
fn rigid_name(evidence: &Evidence<'_>, mode: usize) -> String {
    match directions::NAMES.get(mode).filter(|_| evidence.rigid.is_classical) {
        Some(name) => (*name).to_owned(),
        None => format!("rigid-body mode {}", mode + 1),
    }
}

/// What a reduced coordinate is called: `node 12 uz`, `mode 3`, `inertia relief 2`.
fn coordinate_name(evidence: &Evidence<'_>, coordinate: usize) -> String {
    let n_b = evidence.partition.n_interface();
    match coordinate.checked_sub(n_b).map(|slot| evidence.basis.coordinates.get(slot).copied()) {
        Some(None) => format!("coordinate {}", coordinate + 1),
        None => evidence.partition.name_of(evidence.partition.n_internal + coordinate),
        Some(Some(DynamicCoordinate::RigidBody(index))) => format!("rigid-body mode {}", index + 1),
        Some(Some(DynamicCoordinate::InertiaRelief(index))) => format!("inertia relief {}", index + 1),
        Some(Some(DynamicCoordinate::FreeFree(mode) | DynamicCoordinate::FixedInterface(mode))) => {
            format!("mode {}", mode + 1)
        }
    }
}

/// The precision of the data of K where it is coarser than that of the arithmetic, else nothing.
fn data_noise(partition: &Partition) -> f64 {
    let precision = partition.precision.stiffness;
    if precision > f64::EPSILON { precision * partition.cancellation } else { 0.0 }
}

/// The share that the digits of K have in an error bar, the rest being that of the arithmetic.
fn share_of_data(partition: &Partition) -> f64 {
    let precision = partition.precision.stiffness;
    precision / (f64::EPSILON + precision)
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
