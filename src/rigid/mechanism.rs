//! Mechanisms: motions without energy that are no rigid-body motions, and motions so soft that nobody can tell.
//!
//! ```text
//! S = K_BB + K_BI Ψ_S     n_B × n_B    null space U_B and what else moves without energy
//! V = [Ψ_S Z; Z]          n' × k       its softest motions beside those, with their internal dofs
//! ```
//! With K_II definite, every motion without energy is some V: a ball joint or a hinge between interfaces shows as a small
//! eigenvalue of S, at the price of one dense eigenproblem. Motions without energy are handed on like rigid-body modes.

use faer::{Mat, MatRef};

use super::{RigidBodyModes, absolute_energy, largest_residual};
use crate::basis::ConstraintModes;
use crate::dense;
use crate::error::{Error, Result};
use crate::partition::Partition;
use crate::sparse::product;

/// Eigenvalues of S, in the scales of the interface dofs, below which a motion is looked at: far above any noise.
const SOFT: f64 = 1e-6;
/// Rayleigh quotients up to this many error bars are zero. The bar adds all roundings of xᵀKx with one sign, which measured
/// zeros stay below; at ten bars an eigenvalue is known to a tenth. (A thousand bars would call zero what is known to a
/// thousandth.)
const ZERO_WITHIN_BARS: f64 = 10.0;
/// Rayleigh quotients up to this many bars are known to four digits at best.
const KNOWN_BEYOND_BARS: f64 = 1e4;
/// Rayleigh quotients up to this many ε times their terms may be zeros of whoever made K in double precision: a projection leaves
/// thousands of roundings that its own terms do not show. Rounding to fewer digits afterwards adds its bar to that and no more.
const ROUNDINGS_OF_THE_PRODUCER: f64 = 1e4;
/// Modal mass of a motion of unit length, in the scales of the dofs, relative to the largest mass of a dof in them, below
/// which the motion has no mass: the square of its rounding, with a factor of a hundred million.
const NO_MASS: f64 = 1e-24;

/// A soft motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Loose {
    /// Its Rayleigh quotient, in scaled units.
    pub lambda: f64,
    /// What rounding of the data can make of it.
    pub bar: f64,
    /// The nodes it moves most, or the rows where there are no nodes.
    pub nodes: Vec<String>,
}

/// The motions beside the rigid-body modes that are without energy, or nearly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LooseMotions {
    /// Without energy as far as the data tell.
    pub mechanisms: Vec<Loose>,
    /// With little more energy than arithmetic can tell from none; they are kept as elastic.
    pub grey: Vec<Loose>,
    /// No mechanisms, but known to four digits at best: the data have too few.
    pub uncertain: Vec<Loose>,
}

/// Adds the motions of mechanisms to the rigid-body modes.
///
/// # Errors
/// A motion with neither energy nor mass; a dense eigenproblem that does not converge.
pub fn with_mechanisms(
    partition: &Partition,
    constraint: &ConstraintModes,
    rigid: RigidBodyModes,
) -> Result<(RigidBodyModes, LooseMotions)> {
    let soft = soft_motions(partition, constraint, &rigid)?;
    if soft.ncols() == 0 {
        return Ok((rigid, LooseMotions::default()));
    }
    let motions = orthonormal(partition, &rigid, soft)?;
    let mut energy = dense::gram(motions.as_ref(), product(&partition.stiffness, motions.as_ref()).as_ref());
    dense::symmetrise(&mut energy);
    let (lambda, directions) = dense::symmetric_eigen(energy.as_ref())?;
    let motions = dense::product(motions.as_ref(), directions.as_ref());
    let precision = partition.precision.stiffness + f64::EPSILON;
    let bars = absolute_energy(&partition.stiffness, motions.as_ref());
    let mut found = LooseMotions::default();
    let mut zero = Vec::new();
    for (j, (lambda, terms)) in lambda.into_iter().zip(bars).enumerate() {
        let bar = precision * terms;
        let loose = || Loose { lambda, bar, nodes: most_moved(partition, dense::column(motions.as_ref(), j)) };
        if lambda.abs() <= ZERO_WITHIN_BARS * bar {
            zero.push(j);
            found.mechanisms.push(loose());
        } else if lambda < 0.0 {
            return Err(Error::NegativeRigidEnergy { energy: lambda, noise: bar });
        } else if lambda <= ROUNDINGS_OF_THE_PRODUCER * f64::EPSILON * terms {
            found.grey.push(loose());
        } else if lambda <= KNOWN_BEYOND_BARS * bar {
            found.uncertain.push(loose());
        }
    }
    let zero = Mat::from_fn(motions.nrows(), zero.len(), |i, j| motions[(i, zero[j])]);
    let n_grey = found.grey.len() + found.uncertain.len();
    let rigid = RigidBodyModes { n_grey, ..joined(partition, rigid, zero.as_ref()) };
    Ok((rigid, found))
}

/// V for every eigenvector of S that is soft and no rigid-body motion; columns of unit length in the scales of the dofs.
fn soft_motions(partition: &Partition, constraint: &ConstraintModes, rigid: &RigidBodyModes) -> Result<Mat<f64>> {
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let scale: Vec<f64> = (0..n_b).map(|i| dense::power_of_two_root(stiffness_of(partition, n_i + i))).collect();
    let mut lifted = Mat::from_fn(n_b, n_b, |i, j| constraint.stiffness[(i, j)] * scale[i] * scale[j]);
    if rigid.count() > 0 && n_b > 0 {
        let u_b = Mat::from_fn(n_b, rigid.count(), |i, j| rigid.orthonormal[(n_i + i, j)] / scale[i]);
        let z = u_b.qr().compute_thin_Q();
        dense::add_product(lifted.as_mut(), 1.0, z.as_ref(), z.transpose());
        dense::symmetrise(&mut lifted);
    }
    let (values, vectors) = dense::symmetric_eigen(lifted.as_ref())?;
    let n_soft = values.iter().take_while(|value| **value <= SOFT).count();
    let z = Mat::from_fn(n_b, n_soft, |i, j| scale[i] * vectors[(i, j)]);
    let mut motions = Mat::zeros(n_i + n_b, n_soft);
    motions.as_mut().subrows_mut(0, n_i).copy_from(dense::product(constraint.modes.as_ref(), z.as_ref()));
    motions.as_mut().subrows_mut(n_i, n_b).copy_from(z);
    Ok(motions)
}

fn stiffness_of(partition: &Partition, dof: usize) -> f64 {
    partition.stiffness.get(dof, dof).copied().unwrap_or(0.0)
}

/// The same motions M-orthogonal to the rigid-body modes and M-orthonormal; those without mass are left out if they have
/// energy, and are an error if they have none.
fn orthonormal(partition: &Partition, rigid: &RigidBodyModes, motions: Mat<f64>) -> Result<Mat<f64>> {
    let mut q = motions;
    let heaviest = (0..partition.n_dofs()).fold(0.0f64, |max, dof| {
        let stiffness = stiffness_of(partition, dof);
        let mass = partition.mass.get(dof, dof).copied().unwrap_or(0.0);
        max.max(if stiffness > 0.0 { mass / stiffness } else { mass })
    });
    for pass in 0..3 {
        let along = dense::gram(rigid.mass_orthonormal.as_ref(), q.as_ref());
        dense::add_product(q.as_mut(), -1.0, rigid.orthonormal.as_ref(), along.as_ref());
        let mut modal_mass = dense::gram(q.as_ref(), product(&partition.mass, q.as_ref()).as_ref());
        dense::symmetrise(&mut modal_mass);
        let (masses, directions) = dense::symmetric_eigen(modal_mass.as_ref())?;
        let least = if pass == 0 { NO_MASS * heaviest } else { 0.0 };
        let n_massless = masses.iter().take_while(|mass| **mass <= least).count();
        let turned = dense::product(q.as_ref(), directions.as_ref());
        refuse_without_energy(partition, turned.as_ref().subcols(0, n_massless))?;
        let massive = turned.as_ref().subcols(n_massless, turned.ncols() - n_massless);
        q = Mat::from_fn(massive.nrows(), massive.ncols(), |i, j| massive[(i, j)] / masses[n_massless + j].sqrt());
    }
    Ok(q)
}

fn refuse_without_energy(partition: &Partition, massless: MatRef<'_, f64>) -> Result<()> {
    let forces = product(&partition.stiffness, massless);
    let terms = absolute_energy(&partition.stiffness, massless);
    for (j, terms) in terms.iter().enumerate() {
        let motion = dense::column(massless, j);
        let energy = dense::dot(motion, dense::column(forces.as_ref(), j));
        let bar = (partition.precision.stiffness + f64::EPSILON) * terms;
        if energy.abs() <= ZERO_WITHIN_BARS * bar {
            let largest = (0..motion.len()).max_by(|a, b| motion[*a].abs().total_cmp(&motion[*b].abs()));
            return Err(Error::MasslessMechanism { dof: partition.name_of(largest.unwrap_or(0)) });
        }
    }
    Ok(())
}

/// U and Q with the motions of mechanisms; those without mass stay the last of Q.
fn joined(partition: &Partition, rigid: RigidBodyModes, mechanisms: MatRef<'_, f64>) -> RigidBodyModes {
    let orthonormal = dense::concatenated(mechanisms.nrows(), [rigid.massive(), mechanisms, rigid.massless()]);
    let mut energy = rigid.energy;
    energy.largest_residual = energy.largest_residual.max(largest_residual(&partition.stiffness, mechanisms));
    RigidBodyModes {
        modes: dense::beside(rigid.modes.as_ref(), mechanisms),
        mass_orthonormal: product(&partition.mass, orthonormal.as_ref()),
        orthonormal,
        n_mechanisms: rigid.n_mechanisms + mechanisms.ncols(),
        energy,
        ..rigid
    }
}

/// The nodes of the largest displacements, in the scales of the dofs; a handful, in their order.
fn most_moved(partition: &Partition, motion: &[f64]) -> Vec<String> {
    const SHOWN: usize = 4;
    let size = |dof: usize| {
        let stiffness = stiffness_of(partition, dof);
        motion[dof].abs() * if stiffness > 0.0 { stiffness.sqrt() } else { 1.0 }
    };
    let mut order: Vec<usize> = (0..motion.len()).collect();
    order.sort_by(|a, b| size(*b).total_cmp(&size(*a)).then(a.cmp(b)));
    let mut nodes: Vec<String> = Vec::new();
    for dof in order {
        let name = partition.name_of(dof);
        let node = match partition.dofs[dof].site {
            Some(_) => name.rsplit_once(' ').map_or(name.clone(), |(node, _)| node.to_owned()),
            None => name,
        };
        if !nodes.contains(&node) {
            nodes.push(node);
        }
        if nodes.len() == SHOWN {
            break;
        }
    }
    nodes
}
