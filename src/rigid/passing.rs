//! The rigid-body motions that a support lets pass.

use faer::{Mat, MatRef};

use super::rigid_body_modes::{RigidBodyModes, RigidEnergy};
use crate::dense;
use crate::error::Result;
use crate::job::Boundary;
use crate::partition::Partition;
use crate::sparse::{SparseMatrix, diagonal, product};

/// Singular values of the rigid-body motions at the held dofs, relative to the largest or to the motions anywhere, below which a motion
/// passes. The interface rank uses the same figure.
const PASSES: f64 = 1e-10;

/// Rigid-body modes with those that pass where the partition holds some of its interface for its modes.
///
/// # Errors
/// A dense decomposition that does not converge.
pub fn with_passing(rigid: RigidBodyModes, partition: &Partition) -> Result<RigidBodyModes> {
    let Some(pencil) = partition.mixed.as_ref().and_then(|mixed| mixed.pencil.as_ref()) else { return Ok(rigid) };
    let held = partition.held_under(Boundary::MixedInterface);
    let passing = passing_motions((partition, &rigid), &held, (&pencil.kept, &pencil.mass))?;
    Ok(RigidBodyModes { passing: Some(Box::new(passing)), ..rigid })
}

/// Combinations of motions (n' rows) that leave the `held` interface dofs at rest.
///
/// # Errors
/// A dense decomposition that does not converge.
pub(crate) fn that_pass(partition: &Partition, motions: MatRef<'_, f64>, held: &[bool]) -> Result<Mat<f64>> {
    let n_i = partition.n_internal;
    let held: Vec<usize> = (0..held.len()).filter(|dof| held[*dof]).map(|dof| n_i + dof).collect();
    Ok(dense::product(motions, passing(motions, &held, &diagonal(&partition.stiffness))?.as_ref()))
}

/// The motions with mass that leave the `held` interface dofs at rest: their rows `kept`, orthonormal in the mass of those.
///
/// # Errors
/// A dense decomposition that does not converge.
pub(crate) fn passing_motions(
    (partition, rigid): (&Partition, &RigidBodyModes),
    held: &[bool],
    (kept, mass): (&[usize], &SparseMatrix),
) -> Result<RigidBodyModes> {
    let motions = that_pass(partition, rigid.massive(), held)?;
    let mut motions = Mat::from_fn(kept.len(), motions.ncols(), |i, j| motions[(kept[i], j)]);
    // The second pass takes up the rounding of the first.
    for _ in 0..2 {
        let mut modal = dense::gram(motions.as_ref(), product(mass, motions.as_ref()).as_ref());
        dense::symmetrise(&mut modal);
        let (masses, directions) = dense::symmetric_eigen(modal.as_ref())?;
        let unit = Mat::from_fn(masses.len(), masses.len(), |i, j| directions[(i, j)] / masses[j].sqrt());
        motions = dense::product(motions.as_ref(), unit.as_ref());
    }
    Ok(RigidBodyModes {
        mass_orthonormal: product(mass, motions.as_ref()),
        modes: motions.clone(),
        orthonormal: motions,
        n_massless: 0,
        n_mechanisms: 0,
        n_grey: 0,
        source: rigid.source,
        is_classical: false,
        energy: RigidEnergy::default(),
        passing: None,
    })
}

/// How many combinations of motions of the interface (n_B × n_r) leave the dofs `held` at rest; `scales` make the dofs alike.
///
/// # Errors
/// A dense decomposition that does not converge.
pub(crate) fn n_passing(motions: MatRef<'_, f64>, scales: &[f64], held: &[usize]) -> Result<usize> {
    n_moving_less(PASSES, motions, scales, held)
}

/// How many motions move the held coordinates by no more than a share of what the largest does, as [`n_passing`].
///
/// # Errors
/// A dense decomposition that does not converge.
pub(crate) fn n_moving_less(share: f64, motions: MatRef<'_, f64>, scales: &[f64], held: &[usize]) -> Result<usize> {
    let n_r = motions.ncols();
    if held.is_empty() || n_r == 0 {
        return Ok(n_r);
    }
    // Motions of one length, so that none is small by itself.
    let of = |at: usize, j: usize| motions[(at, j)] / scales[at];
    // One that leaves the whole interface at rest has no length there.
    let length = |j: usize| match dense::norm(&(0..motions.nrows()).map(|at| of(at, j)).collect::<Vec<f64>>()) {
        0.0 => 1.0,
        length => length,
    };
    let lengths: Vec<f64> = (0..n_r).map(length).collect();
    let at_held = Mat::from_fn(held.len().max(n_r), n_r, |i, j| held.get(i).map_or(0.0, |at| of(*at, j) / lengths[j]));
    let (singular, _) = dense::right_singular(at_held.as_ref())?;
    // Where all of them pass, the largest is rounding itself: then a motion that does not is as large as it is anywhere.
    let anywhere = 1.0 / (motions.nrows() as f64).sqrt();
    Ok(singular.iter().filter(|value| **value <= share * singular[0].max(anywhere)).count())
}

/// Combinations of the motions that vanish at the held dofs; rows weighted by stiffness, so that rotations and
/// translations count alike.
fn passing(q: MatRef<'_, f64>, held: &[usize], stiffness: &[f64]) -> Result<Mat<f64>> {
    let n_r = q.ncols();
    if held.is_empty() || n_r == 0 {
        return Ok(Mat::identity(n_r, n_r));
    }
    // A free particle has no stiffness and is held all the same.
    let weight = |dof: usize| if stiffness[dof] > 0.0 { stiffness[dof].sqrt() } else { 1.0 };
    let at_held =
        Mat::from_fn(held.len().max(n_r), n_r, |i, j| held.get(i).map_or(0.0, |dof| q[(*dof, j)] * weight(*dof)));
    let (singular, v) = dense::right_singular(at_held.as_ref())?;
    // The root mean square of the largest motion, with which to compare where all of them pass.
    let squares = |j: usize| (0..q.nrows()).map(|dof| (q[(dof, j)] * weight(dof)).powi(2)).sum::<f64>();
    let anywhere = ((0..n_r).map(squares).fold(0.0, f64::max) / q.nrows() as f64).sqrt();
    let rank = singular.iter().filter(|value| **value > PASSES * singular[0].max(anywhere)).count();
    Ok(v.as_ref().subcols(rank, n_r - rank).to_owned())
}
