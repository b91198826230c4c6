//! Mechanisms: motions without energy that are not rigid-body motions, and motions too soft to be told from them.
//!
//! ```text
//! S = K_BB + K_BI Ψ_S     n_B × n_B    null space U_B and what else moves without energy
//! V = [Ψ_S Z; Z]          n' × k       its softest motions besides those, with their internal dofs
//! ```
//! With K_II definite, every motion without energy is some V: a ball joint or a hinge between interfaces shows as a small
//! eigenvalue of S, and costs one dense eigenproblem. Later stages treat motions without energy like rigid-body modes.

use faer::{Mat, MatRef};

use super::{ConstraintModes, n_negative};
use crate::dense;
use crate::eigen::{rayleigh_quotients, zero};
use crate::error::{Error, Result};
use crate::factor::{Analysis, few_digits, whole_count};
use crate::job::Mechanisms;
use crate::partition::Partition;
use crate::rigid::{RigidBodyModes, lost_interface, refuse_uncounted, residual_of, settled, zero_energy, zero_modes};
use crate::sparse::absolute_energy;
use crate::sparse::{product, product_and_terms};

/// Eigenvalues of S, in the scales of the interface dofs, below which a motion is looked at: far above any noise of binary data.
const SOFT: f64 = 1e-6;
/// Eigenvalues of S below which a motion is looked at, in units of what the digits of K leave of S, which adds all roundings with one sign.
const SOFT_BY_DIGITS: f64 = 10.0;
/// Rayleigh quotients up to this many bars are known to four digits at best.
const KNOWN_BEYOND_BARS: f64 = 1e4;
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

/// The motions other than the rigid-body modes that are without energy, or nearly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LooseMotions {
    /// Without energy as far as the data tell.
    pub mechanisms: Vec<Loose>,
    /// With little more energy than arithmetic can tell from none; they are kept as elastic.
    pub grey: Vec<Loose>,
    /// No mechanisms, but known to four digits at best: the data have too few.
    pub uncertain: Vec<Loose>,
    /// What few digits leave open of the eigenvalues of mechanisms, relative to the next one; zero without mechanisms.
    pub share_of_next: f64,
    /// Factorisations that telling them took.
    pub n_factorisations: usize,
}

/// How far up, relative to the first motion with energy, few digits may leave open what motions inside the component cost, without the job
/// saying that they are meant: in practice a frequency of 10⁻⁴ of the first elastic one counts as none.
const FREE_IN_PRACTICE: f64 = 1e-8;

impl LooseMotions {
    /// Eigenvalue up to which what few digits leave of motions without energy may be elastic.
    pub fn level_of_digits(&self, rigid: &RigidBodyModes) -> f64 {
        self.mechanisms.iter().map(|motion| motion.bar).fold(rigid.level_of_digits(), f64::max)
    }

    /// An error where few digits of K leave open whether motions inside the component are elastic, and the job does not say that they are
    /// meant: what is soft would be lost.
    ///
    /// # Errors
    /// [`Error::MechanismDigits`].
    pub fn refuse_unmeant(&self, mechanisms: Mechanisms, partition: &Partition, rigid: &RigidBodyModes) -> Result<()> {
        let n_inside = rigid.n_inside(partition.model.n_bodies);
        if mechanisms == Mechanisms::Accept || n_inside == 0 || !partition.has_few_digits() {
            return Ok(());
        }
        if self.share_of_next.max(rigid.energy.angle) <= FREE_IN_PRACTICE {
            return Ok(());
        }
        Err(Error::MechanismDigits {
            n_inside,
            up_to_hz: partition.scaling.hertz(self.level_of_digits(rigid)),
            known: partition.precision.stiffness.in_words(),
            nodes: self.mechanisms.first().map_or_else(String::new, |motion| motion.nodes.join(", ")),
        })
    }
}

/// Adds the motions of mechanisms to the rigid-body modes.
///
/// # Errors
/// A motion with neither energy nor mass; a dense eigenproblem that does not converge.
pub fn with_mechanisms(
    partition: &Partition,
    constraint: &ConstraintModes<'_>,
    rigid: RigidBodyModes,
) -> Result<(RigidBodyModes, LooseMotions)> {
    let soft = soft_motions(partition, constraint, &rigid)?;
    if soft.ncols() == 0 {
        return Ok((rigid, LooseMotions::default()));
    }
    let motions = orthonormal(partition, &rigid, soft)?;
    let mut energy = dense::gram(motions.as_ref(), product(&partition.stiffness, motions.as_ref()).as_ref());
    dense::symmetrise(&mut energy);
    let (_, directions) = dense::symmetric_eigen(energy.as_ref())?;
    let motions = dense::product(motions.as_ref(), directions.as_ref());
    let (lambda, errors, _) = rayleigh_quotients(partition.free_problem(), motions.as_ref());
    let terms = absolute_energy(&partition.stiffness, motions.as_ref());
    let mut found = LooseMotions::default();
    let mut free = Vec::new();
    for (j, (lambda, (error, terms))) in lambda.into_iter().zip(errors.iter().zip(terms)).enumerate() {
        let bar = error.data_bar * lambda.abs();
        let loose = |bar| Loose { lambda, bar, nodes: most_moved(partition, dense::column(motions.as_ref(), j)) };
        let is_left = zero::is_zero(lambda, error.zero_level) || zero::is_left_by_the_producer(lambda, terms);
        let accepted = error.zero_level.max(zero::LEFT_BY_THE_PRODUCER * f64::EPSILON * terms);
        if is_left || is_rounding(partition, (constraint, &rigid), (lambda, accepted))? {
            free.push(j);
            found.mechanisms.push(loose(error.zero_level));
        } else if lambda <= zero::LEFT_BY_THE_PRODUCER * f64::EPSILON * terms {
            found.grey.push(loose(bar));
        } else if lambda <= KNOWN_BEYOND_BARS * bar {
            found.uncertain.push(loose(bar));
        }
    }
    (found.share_of_next, found.n_factorisations) = counted_share(partition, constraint, (&rigid, &found))?;
    // Where the rows that move have hardly any stiffness, a rounding of those at rest would be all the force there is.
    let free = settled(partition, dense::columns(motions.as_ref(), &free));
    let n_grey = found.grey.len() + found.uncertain.len();
    let rigid = RigidBodyModes { n_grey, ..joined(partition, rigid, free.as_ref()) };
    Ok((rigid, found))
}

/// Whether a quotient below zero is rounding of the program that wrote K: where a count finds no eigenvalue below half of it.
fn is_rounding(
    partition: &Partition,
    (constraint, rigid): (&ConstraintModes<'_>, &RigidBodyModes),
    (lambda, noise): (f64, f64),
) -> Result<bool> {
    if lambda > 0.0 {
        return Ok(false);
    }
    let analysis = Analysis::new(partition.pencil())?;
    match whole_count(&analysis, partition.pencil(), 0.5 * lambda)?.below {
        0 => Ok(true),
        count => {
            // Beyond rounding it is no motion that should be free: the component buckles.
            let error = match n_negative(partition, constraint, rigid)? {
                0 => Error::NegativeRigidEnergy { energy: lambda, noise, count, at: None },
                count => Error::IndefiniteStiffness { count, boundary: "free" },
            };
            Err(few_digits(error, &analysis, (&partition.stiffness).into(), partition.precision.stiffness))
        }
    }
}

/// Mechanisms by few digits are believed where what rounding makes is nothing compared with the softest motion that is none. Where the
/// interface has no other motion the matrices tell that one, if they have as many motions without energy: else nothing is left of the
/// stiffness of the interface. With the share the factorisations that it took.
fn counted_share(
    partition: &Partition,
    constraint: &ConstraintModes<'_>,
    (rigid, found): (&RigidBodyModes, &LooseMotions),
) -> Result<(f64, usize)> {
    if found.mechanisms.is_empty() || !partition.has_few_digits() {
        return Ok((0.0, 0));
    }
    let others: Vec<f64> = found.grey.iter().chain(&found.uncertain).map(|motion| motion.bar / motion.lambda).collect();
    let n_free = rigid.count() + found.mechanisms.len();
    let stiffer = stiffer_motion(partition, constraint, rigid)?;
    if stiffer.ncols() == 0 && others.is_empty() {
        let every = zero_modes(partition)?;
        if every.rigid.count() != n_free {
            return Err(lost_interface(partition.precision.stiffness, n_free));
        }
        refuse_uncounted(partition.precision.stiffness, n_free, every.bar_of_digits)?;
        return Ok((every.bar_of_digits, every.n_factorisations));
    }
    let next = orthonormal(partition, rigid, stiffer)?;
    let (lambda, errors, _) = rayleigh_quotients(partition.free_problem(), next.as_ref());
    let of_next = lambda.iter().zip(&errors).map(|(lambda, error)| error.zero_level / lambda);
    let bar = others.into_iter().chain(of_next).fold(0.0, f64::max);
    refuse_uncounted(partition.precision.stiffness, n_free, bar)?;
    Ok((bar, 0))
}

/// V for every eigenvector of S that is soft and no rigid-body motion; columns of unit length in the scales of the dofs.
fn soft_motions(partition: &Partition, constraint: &ConstraintModes<'_>, rigid: &RigidBodyModes) -> Result<Mat<f64>> {
    let (values, z) = interface_motions(partition, constraint, rigid)?;
    let n_soft = n_soft(partition, constraint, &values);
    Ok(followed(constraint, z.as_ref().subcols(0, n_soft)))
}

/// V for the first eigenvector of S that is not soft; no column where all are.
fn stiffer_motion(partition: &Partition, constraint: &ConstraintModes<'_>, rigid: &RigidBodyModes) -> Result<Mat<f64>> {
    let (values, z) = interface_motions(partition, constraint, rigid)?;
    let n_soft = n_soft(partition, constraint, &values);
    Ok(followed(constraint, z.as_ref().subcols(n_soft, (values.len() - n_soft).min(1))))
}

/// Eigenvalues of S in the scales of the interface dofs, ascending, and its eigenvectors, without those of rigid-body motion.
fn interface_motions(
    partition: &Partition,
    constraint: &ConstraintModes<'_>,
    rigid: &RigidBodyModes,
) -> Result<(Vec<f64>, Mat<f64>)> {
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let scale: Vec<f64> = (0..n_b).map(|i| dense::power_of_two_root(stiffness_of(partition, n_i + i))).collect();
    let mut lifted = Mat::from_fn(n_b, n_b, |i, j| constraint.stiffness[(i, j)] * scale[i] * scale[j]);
    if rigid.count() > 0 && n_b > 0 {
        let u_b = Mat::from_fn(n_b, rigid.count(), |i, j| rigid.orthonormal[(n_i + i, j)] / scale[i]);
        let z = u_b.qr().compute_thin_Q();
        // Above all others, which are no more than the trace: entries of the diagonal are less than those of DKD, and these than two.
        dense::add_product(lifted.as_mut(), 2.0 * n_b as f64, z.as_ref(), z.transpose());
        dense::symmetrise(&mut lifted);
    }
    let (values, vectors) = dense::symmetric_eigen(lifted.as_ref())?;
    let n = n_b.saturating_sub(rigid.count());
    Ok((values[..n].to_vec(), Mat::from_fn(n_b, n, |i, j| scale[i] * vectors[(i, j)])))
}

fn n_soft(partition: &Partition, constraint: &ConstraintModes<'_>, values: &[f64]) -> usize {
    let by_digits =
        SOFT_BY_DIGITS * partition.precision.stiffness.share * constraint.cancellation * partition.cancellation;
    values.iter().take_while(|value| **value <= SOFT.max(by_digits)).count()
}

/// [Ψ_S Z; Z].
fn followed(constraint: &ConstraintModes<'_>, z: MatRef<'_, f64>) -> Mat<f64> {
    let (n_i, n_b) = (constraint.modes.n_internal(), z.nrows());
    let mut motions = Mat::zeros(n_i + n_b, z.ncols());
    motions.as_mut().subrows_mut(0, n_i).copy_from(constraint.modes.follow(z));
    motions.as_mut().subrows_mut(n_i, n_b).copy_from(z);
    motions
}

fn stiffness_of(partition: &Partition, dof: usize) -> f64 {
    partition.stiffness.get(dof, dof).copied().unwrap_or(0.0)
}

/// `motions` made M-orthogonal to the rigid-body modes and M-orthonormal; those without mass are left out if they have
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
    let (forces, terms) = product_and_terms(&partition.stiffness, massless);
    for (j, energy) in dense::dots(massless, forces.as_ref()).into_iter().enumerate() {
        if zero::is_zero(energy, zero_energy(partition, massless.subcols(j, 1), terms.as_ref().subcols(j, 1))) {
            let motion = dense::column(massless, j);
            let largest = (0..motion.len()).max_by(|a, b| motion[*a].abs().total_cmp(&motion[*b].abs()));
            return Err(Error::MasslessMechanism { dof: partition.name_of(largest.unwrap_or(0)) });
        }
    }
    Ok(())
}

/// U and Q with the motions of mechanisms; those without mass stay the last of Q.
fn joined(partition: &Partition, rigid: RigidBodyModes, mechanisms: MatRef<'_, f64>) -> RigidBodyModes {
    let orthonormal = dense::concatenated(mechanisms.nrows(), [rigid.massive(), mechanisms, rigid.massless()]);
    let energy = rigid.energy.with_residual(residual_of(partition, mechanisms));
    RigidBodyModes {
        modes: dense::side_by_side(rigid.modes.as_ref(), mechanisms),
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
