//! Rigid-body modes from coordinates, body by body, verified against K; M-orthonormal over the bodies that M couples.

use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, MatRef};

use super::algebraic;
use super::energy::zero_energies;
use super::preload::{self, WithoutForce};
use super::rank::scales;
use super::rigid_body_modes::{RigidBodyModes, RigidEnergy, RigidSource};
use super::rounding::{Turned, residual};
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::{NO_MASS, zero};
use crate::error::{Error, Result};
use crate::factor::{Analysis, whole_count};
use crate::model::{Bodies, Frame, Site};
use crate::partition::Partition;
use crate::sparse::{SparseMatrix, absolute_energy, energies_of_terms, product, product_and_terms};

/// Singular values of a body's six unit motions, relative to the largest, below which the motion moves no dof (rotation
/// of a straight row of translations about its own axis): a thousand times rounding, far below any real thickness.
const NO_DISPLACEMENT: f64 = 1e-11;
/// Modal masses relative to their terms that are rounding of the sums, where masses between bodies cancel those of the bodies.
const MASS_OF_ROUNDING: f64 = NOISE_FACTOR * f64::EPSILON;

/// The zero-energy rigid motions of every body.
pub(super) fn rigid_body_modes(partition: &Partition, sites: &[Option<Site>]) -> Result<RigidBodyModes> {
    let node_of_dof: Vec<u32> = partition.dofs.iter().map(|dof| dof.node).collect();
    let bodies = Bodies::of(&partition.stiffness, &dense_numbers(&node_of_dof));
    let mut found = Vec::new();
    for body in 0..bodies.n_bodies as u32 {
        let dofs: Vec<usize> = (0..sites.len()).filter(|dof| bodies.of_row[*dof] == body).collect();
        // A scalar dof by itself is no body.
        if dofs.iter().any(|dof| sites[*dof].is_some()) {
            found.push(of_body(partition, sites, &dofs)?);
        }
    }
    refuse_floating_bodies(partition, &found)?;
    let is_classical = matches!(found.as_slice(), [body] if body.is_classical);
    let energy = found.iter().fold(RigidEnergy::default(), |worst, body| RigidEnergy {
        largest_quotient: worst.largest_quotient.max(body.energy.largest_quotient),
        noise: worst.noise.max(body.energy.noise),
        ..worst.with_residual(body.energy.residual())
    });
    let n = sites.len();
    let spaces = coupled_by_mass(partition, &bodies, &found)?;
    let massive = spaces.iter().map(|(massive, _)| massive.as_ref());
    let massless = || spaces.iter().map(|(_, massless)| massless.as_ref());
    let orthonormal = dense::concatenated(n, massive.chain(massless()));
    let modes = match found.as_slice() {
        [body] if body.is_classical => partition.rigid_motions(&body.dofs, [0.0; 3]),
        _ => orthonormal.clone(),
    };
    Ok(RigidBodyModes {
        modes,
        mass_orthonormal: product(&partition.mass, orthonormal.as_ref()),
        orthonormal,
        n_massless: massless().map(|motions| motions.ncols()).sum(),
        n_mechanisms: 0,
        n_grey: 0,
        source: if partition.fit.rounded().is_some() { RigidSource::Algebraic } else { RigidSource::Geometric },
        is_classical,
        energy,
        passing: None,
    })
}

/// Motions with mass, M-orthonormal, and those without, for each group of bodies that M couples: what is orthonormal body by body is not
/// where a mass lies between two of them, and one that resists nothing but their relative motion leaves a common motion without mass.
fn coupled_by_mass(partition: &Partition, bodies: &Bodies, found: &[Body]) -> Result<Vec<(Mat<f64>, Mat<f64>)>> {
    let groups = Bodies::of(&partition.mass, &bodies.of_row);
    let mut members = vec![Vec::new(); groups.n_bodies];
    for body in found {
        members[groups.of_row[body.dofs[0]] as usize].push(body);
    }
    let space = |group: &Vec<&Body>| match group.as_slice() {
        [body] => Ok((body.orthonormal.clone(), body.massless.clone())),
        group => {
            let n = partition.n_dofs();
            let massive = dense::concatenated(n, group.iter().map(|body| body.orthonormal.as_ref()));
            let (massive, without) = mass_orthonormal(&partition.mass, massive.as_ref(), MASS_OF_ROUNDING)?;
            let massless = group.iter().map(|body| body.massless.as_ref());
            let massless = dense::concatenated(n, std::iter::once(without.as_ref()).chain(massless));
            Ok((massive, massless))
        }
    };
    members.iter().map(space).collect()
}

/// A body that can move and that no interface holds makes K_II singular, and nothing could drive it (catalogue S-04).
fn refuse_floating_bodies(partition: &Partition, bodies: &[Body]) -> Result<()> {
    if partition.n_interface() == 0 {
        return Ok(());
    }
    let floats = |body: &&Body| body.count() > 0 && body.dofs.iter().all(|dof| *dof < partition.n_internal);
    let floating: Vec<&Body> = bodies.iter().filter(floats).collect();
    match floating.first() {
        Some(first) => Err(Error::FloatingBody {
            n_floating: floating.len(),
            n_bodies: bodies.len(),
            dof: partition.name_of(first.dofs[0]),
            is_free_by_digits: partition.has_few_digits() && first.energy.largest_quotient > 0.0,
        }),
        None => Ok(()),
    }
}

/// Numbers of nodes without gaps.
fn dense_numbers(nodes: &[u32]) -> Vec<u32> {
    let mut sorted = nodes.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    nodes.iter().map(|node| sorted.binary_search(node).unwrap_or_default() as u32).collect()
}

struct Body {
    /// Its dofs, ascending.
    dofs: Vec<usize>,
    /// Its free motions with mass, M-orthonormal.
    orthonormal: Mat<f64>,
    /// Its free motions without mass.
    massless: Mat<f64>,
    /// Whether all six motions are free.
    is_classical: bool,
    energy: RigidEnergy,
}

impl Body {
    fn count(&self) -> usize {
        self.orthonormal.ncols() + self.massless.ncols()
    }
}

fn of_body(partition: &Partition, sites: &[Option<Site>], dofs: &[usize]) -> Result<Body> {
    let frame = Frame::of(sites, dofs);
    // Unit motions about the body's own centre, rotations scaled to its size: columns of like length.
    let mut centred = partition.rigid_motions(dofs, frame.centre);
    centred.as_mut().subcols_mut(3, 3).col_iter_mut().for_each(|mut rotation| rotation /= faer::Scale(frame.size));
    let moving = moving_directions(centred.as_ref())?;
    let motions = dense::product(centred.as_ref(), moving.as_ref());
    let (orthonormal, massless) = if partition.fit.is_preloaded() {
        let motions = preload::without_force(partition, motions.as_ref(), moving.as_ref(), &frame)?;
        free_of_preloaded(partition, &motions)?
    } else {
        free_motions(partition, motions.as_ref())?
    };
    let orthonormal = settled(partition, orthonormal);
    let angles = || angles_of(&orthonormal, &motions, moving.as_ref(), frame.size);
    let energy = energy_of(partition, orthonormal.as_ref(), Turned { dofs, angles: &angles });
    // Were all six of a preloaded component free, the preload would show in rotations of its parts alone.
    let is_classical = orthonormal.ncols() + massless.ncols() == 6 && !partition.fit.is_preloaded();
    Ok(Body { dofs: dofs.to_vec(), orthonormal, massless, is_classical, energy })
}

/// The motions with rest at the dofs that move by no more than rounding of the rest, where less force is left of that: what slides along guides
/// leaves everything else at rest, and its combination from six motions not quite.
pub(crate) fn settled(partition: &Partition, mut motions: Mat<f64>) -> Mat<f64> {
    /// Of the largest displacement: ten thousand roundings.
    const AT_REST: f64 = 1e-12;
    let scale = scales(partition);
    let size = |motions: &Mat<f64>, i: usize, j: usize| scale[i] * motions[(i, j)].abs();
    let mut rest = motions.clone();
    for j in 0..motions.ncols() {
        let largest = (0..motions.nrows()).map(|i| size(&motions, i, j)).fold(0.0, f64::max);
        (0..motions.nrows()).filter(|i| size(&motions, *i, j) <= AT_REST * largest).for_each(|i| rest[(i, j)] = 0.0);
    }
    if rest == motions {
        return motions;
    }
    let forces = [&motions, &rest].map(|motions| product(&partition.stiffness, motions.as_ref()));
    for j in 0..motions.ncols() {
        let [before, after] = [0, 1].map(|which| dense::norm(dense::column(forces[which].as_ref(), j)));
        if after < before {
            motions.col_mut(j).copy_from(rest.col(j));
        }
    }
    motions
}

/// The motions that cost no energy: those with mass, M-orthonormal, and those without. Each is held to its own rounding: next to a heavy mass
/// rotations about it, of unit modal mass, are so much larger than its translations that their rounding would hide what holds those. A body
/// of which nothing has mass may be held, as rows that a program left a diagonal entry of K alone are; free it has no motion that can be told.
fn free_motions(partition: &Partition, motions: MatRef<'_, f64>) -> Result<(Mat<f64>, Mat<f64>)> {
    let (massive, massless) = mass_orthonormal(&partition.mass, motions, 0.0)?;
    let found = [Energies::of(partition, massive.as_ref())?, Energies::of(partition, massless.as_ref())?];
    found[0].refuse_negative(partition)?;
    let n_free: usize = found.iter().map(|energies| energies.n_within(&energies.zero)).sum();
    if found[0].motions.ncols() == 0 && n_free > 0 {
        return Err(Error::MasslessRigidMotion { relative_mass: 0.0 });
    }
    if n_free < motions.ncols() && is_free_to_k(partition, &found)? {
        let [massive, massless] = found.map(|energies| energies.motions);
        return Ok((massive, massless));
    }
    Ok((found[0].free(), found[1].free()))
}

/// The motions of a preloaded body that cost no energy. Where rounding hid the force of a rotation and not its energy, what is left are the
/// translations as they are: the combinations of least energy have as much of that rotation as rounding of the translations' own forces makes.
fn free_of_preloaded(partition: &Partition, motions: &WithoutForce) -> Result<(Mat<f64>, Mat<f64>)> {
    let all = motions.all();
    let combined = free_motions(partition, all.as_ref())?;
    let n_free = combined.0.ncols() + combined.1.ncols();
    if n_free == all.ncols() {
        return Ok(combined);
    }
    let (massive, massless) = mass_orthonormal(&partition.mass, motions.others.as_ref(), 0.0)?;
    let free = |motions: &Mat<f64>| Energies::of(partition, motions.as_ref()).map(|energies| energies.free());
    let (massive, massless) = (free(&massive)?, free(&massless)?);
    let apart = [&motions.translations, &massive, &massless].map(|motions| motions.as_ref());
    let apart = dense::concatenated(all.nrows(), apart);
    if apart.ncols() == n_free { free_motions(partition, apart.as_ref()) } else { Ok(combined) }
}

/// Whether motions that cost more than the digits of K explain are zero modes of K all the same: coordinates have digits too, and in a
/// slender part those of coordinates cost more. The coordinates have been compared with K by the worst that its digits can do.
fn is_free_to_k(partition: &Partition, found: &[Energies]) -> Result<bool> {
    let all: usize = found.iter().map(|energies| energies.motions.ncols()).sum();
    let near = |energies: &Energies| {
        let near: Vec<f64> = energies.noise.iter().map(|noise| NOISE_FACTOR * noise).collect();
        energies.n_within(&near)
    };
    if found.iter().map(near).sum::<usize>() < all || partition.model.n_bodies > 1 {
        return Ok(false);
    }
    match algebraic::zero_modes(partition) {
        Ok(zero) => Ok(zero.rigid.count() >= all),
        // Whether K is definite is for others to say.
        Err(Error::IndefiniteStiffness { .. } | Error::NotDefinite { .. } | Error::DigitsTooFew { .. }) => Ok(false),
        Err(error) => Err(error),
    }
}

/// The angles that motions turn a body of some size by. They are combinations of `motions`, and these of its centred unit motions by `moving`.
fn angles_of(orthonormal: &Mat<f64>, motions: &Mat<f64>, moving: MatRef<'_, f64>, size: f64) -> Vec<f64> {
    let combination = dense::product(moving, motions.qr().solve_lstsq(orthonormal).as_ref());
    (0..combination.ncols()).map(|j| dense::norm(&dense::column(combination.as_ref(), j)[3..]) / size).collect()
}

/// What orthonormal motions cost.
fn energy_of(partition: &Partition, orthonormal: MatRef<'_, f64>, turned: Turned<'_>) -> RigidEnergy {
    let (forces, terms) = product_and_terms(&partition.stiffness, orthonormal);
    let energies = dense::dots(orthonormal, forces.as_ref());
    let sizes = energies_of_terms(orthonormal, terms.as_ref());
    let energy = RigidEnergy {
        largest_quotient: energies.into_iter().fold(0.0, |max: f64, energy| max.max(energy.abs())),
        noise: noise_share(partition) * sizes.into_iter().fold(0.0, f64::max),
        ..RigidEnergy::default()
    };
    energy.with_residual(residual(partition, orthonormal, [forces.as_ref(), terms.as_ref()], Some(turned)))
}

/// What rounding of the data can make of an energy, relative to its terms.
fn noise_share(partition: &Partition) -> f64 {
    partition.precision.stiffness.share + f64::EPSILON
}

/// The spectrum tells whether K is indefinite, or rounded by the program that wrote it.
fn refuse_negative(partition: &Partition, energy: f64, noise: f64) -> Result<()> {
    match algebraic::zero_modes(partition) {
        // Too far below zero for a shift that suits rigid-body motions.
        Err(Error::IndefiniteStiffness { .. } | Error::NotDefinite { .. }) => {
            let analysis = Analysis::new(partition.pencil())?;
            let count = whole_count(&analysis, partition.pencil(), 0.5 * energy)?.below;
            Err(Error::NegativeRigidEnergy { energy, noise, count, at: None })
        }
        found => found.map(drop),
    }
}

/// Combinations of the six unit motions that move at least one dof, 6 × (≤ 6), scaled to unit displacement.
pub(crate) fn moving_directions(centred: MatRef<'_, f64>) -> Result<Mat<f64>> {
    let tall = if centred.nrows() >= 6 { centred.to_owned() } else { padded(centred) };
    let (singular, v) = dense::right_singular(tall.as_ref())?;
    let largest = singular.first().copied().unwrap_or(0.0);
    let kept = singular.iter().filter(|value| **value > NO_DISPLACEMENT * largest).count();
    if kept == 6 {
        // All six move: keep them as they are, so that the exact zeros of translations stay exact.
        return Ok(Mat::identity(6, 6));
    }
    Ok(Mat::from_fn(6, kept, |i, j| v[(i, j)] / singular[j]))
}

fn padded(matrix: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(6, matrix.ncols(), |i, j| if i < matrix.nrows() { matrix[(i, j)] } else { 0.0 })
}

/// The space of `motions` as Q with QᵀMQ = I in a mass, and the motions without mass; `rounding` is the share of its terms up to which a
/// mass is none.
fn mass_orthonormal(mass: &SparseMatrix, motions: MatRef<'_, f64>, rounding: f64) -> Result<(Mat<f64>, Mat<f64>)> {
    if motions.ncols() == 0 {
        return Ok((motions.to_owned(), motions.to_owned()));
    }
    let modal_mass = |q: MatRef<'_, f64>| {
        let mut modal_mass = dense::gram(q, product(mass, q).as_ref());
        dense::symmetrise(&mut modal_mass);
        modal_mass
    };
    let (_, directions) = dense::symmetric_eigen(modal_mass(motions).as_ref())?;
    let mut q = dense::product(motions, directions.as_ref());
    // The masses of the directions themselves: eigenvalues carry the rounding of the largest of them.
    let own = modal_mass(q.as_ref());
    let masses: Vec<f64> = (0..q.ncols()).map(|j| own[(j, j)]).collect();
    let largest = masses.iter().fold(0.0f64, |max, mass| max.max(*mass));
    let terms = absolute_energy(mass, q.as_ref());
    let has_mass = |j: &usize| masses[*j] > (NO_MASS * largest).max(rounding * terms[*j]);
    let (massive, massless): (Vec<usize>, Vec<usize>) = (0..q.ncols()).partition(has_mass);
    let of = |kept: &[usize], factor: &dyn Fn(usize) -> f64| {
        Mat::from_fn(q.nrows(), kept.len(), |i, j| q[(i, kept[j])] * factor(kept[j]))
    };
    let massless = of(&massless, &|_| 1.0);
    if massive.is_empty() {
        return Ok((of(&massive, &|_| 1.0), massless));
    }
    q = of(&massive, &|j| 1.0 / masses[j].sqrt());
    // Two more passes remove what rounding of the first left: a body far from round has unlike modal masses. Each leaves the motions what they
    // are but for that: next to a heavy mass translations of unit modal mass are so small that a mixture with rotations would lose them.
    for _ in 0..2 {
        let (masses, directions) = dense::symmetric_eigen(modal_mass(q.as_ref()).as_ref())?;
        if let Some(mass) = masses.iter().find(|mass| mass.is_nan() || **mass <= 0.0) {
            return Err(Error::MasslessRigidMotion { relative_mass: *mass });
        }
        let scaled = Mat::from_fn(masses.len(), masses.len(), |i, j| directions[(i, j)] / masses[j].sqrt());
        let root = dense::product(scaled.as_ref(), directions.transpose());
        q = dense::product(q.as_ref(), root.as_ref());
    }
    Ok((q, massless))
}

/// What some motions cost, each by itself.
struct Energies {
    /// The motions, combined so that none shares energy with another.
    motions: Mat<f64>,
    /// xᵀKx of each, ascending.
    energies: Vec<f64>,
    /// What rounding of the data can make of it, all roundings with one sign.
    noise: Vec<f64>,
    /// Up to which it is zero.
    zero: Vec<f64>,
}

impl Energies {
    fn of(partition: &Partition, x: MatRef<'_, f64>) -> Result<Self> {
        let mut energy = dense::gram(x, product(&partition.stiffness, x).as_ref());
        dense::symmetrise(&mut energy);
        let (_, directions) = dense::symmetric_eigen(energy.as_ref())?;
        let motions = dense::product(x, directions.as_ref());
        let (forces, terms) = product_and_terms(&partition.stiffness, motions.as_ref());
        let sizes = energies_of_terms(motions.as_ref(), terms.as_ref());
        let energies = dense::dots(motions.as_ref(), forces.as_ref());
        let zero = zero::of_alike(&energies, &zero_energies(partition, motions.as_ref(), terms.as_ref()));
        let zero = zero::raised(&energies, &zero, &sizes);
        let noise = sizes.iter().map(|size| noise_share(partition) * size).collect();
        Ok(Self { motions, energies, noise, zero })
    }

    /// How many of them cost no more than `levels`.
    fn n_within(&self, levels: &[f64]) -> usize {
        self.energies.iter().zip(levels).filter(|(energy, level)| energy <= level).count()
    }

    fn free(&self) -> Mat<f64> {
        let free: Vec<usize> = (0..self.energies.len()).filter(|j| self.energies[*j] <= self.zero[*j]).collect();
        Mat::from_fn(self.motions.nrows(), free.len(), |i, j| self.motions[(i, free[j])])
    }

    /// An error where one of unit modal mass has negative energy.
    fn refuse_negative(&self, partition: &Partition) -> Result<()> {
        let Some(j) = (0..self.energies.len()).find(|j| self.energies[*j] < -self.zero[*j]) else { return Ok(()) };
        // What is told is what would have been accepted: at least what the program that wrote K may leave.
        let at_least = zero::LEFT_BY_THE_PRODUCER * f64::EPSILON / noise_share(partition);
        refuse_negative(partition, self.energies[j], self.noise[j] * at_least.max(1.0))
    }
}
