//! All checks of a reduction, in the order of their identifiers.

use super::check::Check;
use super::evidence::Evidence;
use super::grounding::{self, Grounding};
use super::loads::{self, EffectiveMasses};
use super::place::ALL_AXES;
use super::rigid_body::{self, MassRoutes};
use super::{
    attached, attachment, completeness, conditioning, damping, eigenpairs, enclosed, mass, named_loads, probes,
    reduced, rigid_motion, solves, spectrum, unseen,
};
use crate::error::Result;

/// What verification found.
#[derive(Clone, Debug)]
pub struct Findings {
    /// All checks, in the order of their identifiers.
    pub checks: Vec<Check>,
    /// The component as a rigid body, in scaled units.
    pub rigid_body: RigidBody,
    /// The first elastic eigenvalue, where one is known.
    pub first_elastic: Option<f64>,
    /// λ of the reduced model with its interface free, ascending, without its zero modes.
    pub elastic: Vec<f64>,
    /// What the basis lacks of the static answer to each load of the job, where that is known.
    pub load_lacking: Option<Vec<f64>>,
}

/// The component as a rigid body.
#[derive(Clone, Debug)]
pub struct RigidBody {
    /// M_F by three routes, for one free body with coordinates.
    pub routes: Option<MassRoutes>,
    /// Eigenvalues of the zero modes of the reduced pencil.
    pub eigenvalues: Vec<f64>,
    /// How much energy and force motion in each direction costs.
    pub grounding: Vec<Grounding>,
    /// The share of the inertia in each direction that the modes carry.
    pub effective_mass: Option<EffectiveMasses>,
}

/// Makes all checks, and returns them with the values they rest on.
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
    let coupling = eigenpairs::stiffness_orthogonality(evidence, &pairs);
    let of_digits = eigenpairs::left_by_digits(evidence, &coupling);
    let mut checks = vec![
        eigenpairs::backward_error(evidence, &pairs),
        eigenpairs::componentwise_error(evidence, &pairs),
        eigenpairs::orthogonality(evidence),
        coupling,
        rigid_motion::energy(evidence, &spectrum, &rigid_body.grounding),
        rigid_motion::residual(evidence, &rigid_body.grounding),
    ];
    checks.extend(completeness::count(evidence));
    checks.extend(enclosed::checks(evidence));
    checks.push(eigenpairs::data_precision(evidence));
    checks.extend(of_statics(evidence, &spectrum, &terms)?);
    checks.push(reduced::pair_residual(evidence, of_digits));
    checks.push(reduced::frequency_difference(evidence, &spectrum));
    checks.push(mass::preserved(evidence));
    if evidence.rigid.is_classical {
        let m_f = evidence.reduction.rigid_body_mass.as_ref();
        let precision = mass::precision(evidence);
        checks.push(mass::of_a_body(m_f, &ALL_AXES, precision));
        checks.extend(mass::of_inertia(m_f, precision, mass::extent(evidence.partition)));
    }
    if !evidence.rigid.is_classical || evidence.partition.held.count() > 0 {
        checks.extend(mass::of_weighed_body(evidence.partition));
    }
    checks.extend(mass::of_parts(evidence.partition));
    checks.extend(rigid_body.routes.as_ref().map(|routes| rigid_body::routes_agree(evidence, &spectrum, routes)));
    checks.extend(mass::expected(evidence));
    checks.extend(attached::flexibility(evidence, &spectrum));
    checks.extend(loads::accelerations(evidence, condition));
    checks.extend(rigid_body.effective_mass.as_ref().and_then(loads::effective_mass));
    checks.extend(attachment::checks(evidence)?);
    checks.extend(attached::checks(evidence));
    checks.extend(conditioning::conditioning(evidence, condition)?);
    checks.push(reduced::symmetry(evidence, &terms));
    checks.push(reduced::definiteness(evidence, &spectrum));
    let load_lacking = named_loads::lacking(evidence);
    checks.extend(named_loads::checks(evidence, load_lacking.as_deref(), condition));
    checks.extend(damping::of_reduction(evidence, &rigid_motion::Disturbance::of(evidence, &spectrum)?)?);
    checks.extend(probes::stiffness(evidence).into_iter().chain(probes::mass(evidence)).chain(probes::parts(evidence)));
    checks.extend(unseen::uncoupled(evidence));
    Ok(Findings {
        checks,
        rigid_body,
        first_elastic: spectrum.first_elastic(),
        elastic: spectrum.elastic().to_vec(),
        load_lacking,
    })
}

/// M-10 to M-13: static solutions, and rigid-body motion in them; those of constraint modes where there are any.
fn of_statics(evidence: &Evidence<'_>, spectrum: &spectrum::Spectrum, terms: &reduced::Terms) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    if evidence.is_held() {
        checks.push(solves::static_solves(evidence)?);
    }
    if evidence.partition.n_interface() > 0 && evidence.is_held() {
        checks.push(rigid_motion::carried_by_interface(evidence));
    }
    checks.push(rigid_motion::null_space(evidence));
    checks.push(rigid_motion::force(evidence, spectrum)?);
    checks.push(rigid_motion::zero_modes(evidence, spectrum));
    if evidence.is_held() {
        checks.push(reduced::block_coupling(evidence, terms));
    }
    Ok(checks)
}

/// Makes the checks that statics alone has: what they measure does not depend on a mass.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub fn verify_statics(evidence: &Evidence<'_>) -> Result<Findings> {
    let condition = conditioning::internal_condition(evidence);
    let terms = reduced::Terms::of_stiffness(evidence);
    let mut checks = vec![rigid_motion::residual(evidence, &[]), solves::static_solves(evidence)?];
    if evidence.partition.n_interface() > 0 {
        checks.push(rigid_motion::carried_by_interface(evidence));
    }
    checks.push(rigid_motion::null_space(evidence));
    let lifted = spectrum::lifted_eigenvalues(evidence)?;
    checks.push(rigid_motion::other_zero_modes(evidence, &lifted));
    checks.push(reduced::block_coupling(evidence, &terms));
    checks.extend(conditioning::of_stiffness(evidence, condition)?);
    checks.push(reduced::symmetry(evidence, &terms));
    checks.push(reduced::definite_stiffness(evidence, &lifted));
    let load_lacking = named_loads::lacking(evidence);
    checks.extend(named_loads::checks(evidence, load_lacking.as_deref(), condition));
    checks.extend(probes::stiffness(evidence));
    checks.extend(probes::parts(evidence));
    let rigid_body = RigidBody { routes: None, eigenvalues: Vec::new(), grounding: Vec::new(), effective_mass: None };
    Ok(Findings { checks, rigid_body, first_elastic: None, elastic: Vec::new(), load_lacking })
}
