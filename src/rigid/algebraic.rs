//! Rigid-body modes from the matrices alone, by inverse iteration on K − σM.

use faer::Mat;

use super::{RigidBodyModes, RigidEnergy, RigidSource, energies_of_terms, residuals};
use crate::dense;
use crate::error::Result;
use crate::factor::{Analysis, SolveOperator};
use crate::modes::{ModalProblem, Shifted, mass_qr, shifted};
use crate::partition::Partition;
use crate::sparse::{product, product_and_terms};

/// The zero modes of a pencil without coordinates, with the factorisations they took.
///
/// They span every motion without energy: rigid-body motions and mechanisms alike.
///
/// # Errors
/// K − σM is not definite for a negative σ; the eigensolver fails.
pub fn from_matrices(partition: &Partition) -> Result<(RigidBodyModes, usize)> {
    zero_modes(partition).map(|(rigid, _, n_factorisations)| (rigid, n_factorisations))
}

/// The zero modes with the first eigenvalue above zero and the factorisations they took.
///
/// # Errors
/// As [`from_matrices`].
pub(crate) fn zero_modes(partition: &Partition) -> Result<(RigidBodyModes, Option<f64>, usize)> {
    let analysis = Analysis::new(partition.pencil())?;
    let problem = ModalProblem::of(partition.pencil(), None, partition.precision);
    let found = shifted(&analysis, problem, &|step| partition.name_of(step))?;
    let orthonormal = without_elastic_rounding(partition, &found);
    let (forces, terms) = product_and_terms(&partition.stiffness, orthonormal.as_ref());
    let magnitudes = energies_of_terms(orthonormal.as_ref(), terms.as_ref());
    let largest_residual = residuals(forces.as_ref(), terms.as_ref()).into_iter().fold(0.0, f64::max);
    let mut energy = RigidEnergy { largest_residual, ..RigidEnergy::default() };
    for (j, magnitude) in magnitudes.iter().enumerate() {
        let (q, force) = (dense::column(orthonormal.as_ref(), j), dense::column(forces.as_ref(), j));
        energy.largest_quotient = energy.largest_quotient.max(dense::dot(q, force).abs());
        energy.noise = energy.noise.max((partition.precision.stiffness + f64::EPSILON) * magnitude);
    }
    let rigid = RigidBodyModes {
        modes: orthonormal.clone(),
        mass_orthonormal: product(&partition.mass, orthonormal.as_ref()),
        orthonormal,
        n_massless: 0,
        n_mechanisms: 0,
        n_grey: 0,
        source: RigidSource::Algebraic,
        is_classical: false,
        energy,
    };
    let first_elastic = found.lowest.lambda.get(found.n_zero).copied().or(found.lowest.next);
    Ok((rigid, first_elastic, found.n_factorisations))
}

/// The zero modes after a step of inverse iteration, which takes what rounding of the eigensolver left of an elastic motion
/// λ down to σ/(λ + σ) of itself: forces are λ times the motion, and the stiffest ones would be all that is left of KQ.
fn without_elastic_rounding(partition: &Partition, found: &Shifted<'_>) -> Mat<f64> {
    let mut zero = found.lowest.shapes.as_ref().subcols(0, found.n_zero).to_owned();
    let mut momenta = product(&partition.mass, zero.as_ref());
    zero.copy_from(&momenta);
    found.factor.solve_in_place(zero.as_mut());
    // Twice is enough for orthogonality to rounding; modes this near to orthonormal depend on none of the others.
    for _ in 0..2 {
        momenta = product(&partition.mass, zero.as_ref());
        mass_qr(&mut zero, &mut momenta, 0.0, &mut vec![false; found.n_zero]);
    }
    zero
}
