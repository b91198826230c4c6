//! Coordinates that K does not know: rotations that cost energy although translations do not.
//!
//! There are three ways to come by them, and the zero modes of the pencil tell which: the rotation is held, the coordinates
//! (or K) are rounded, or they belong to another model.

use faer::Mat;

use super::geometric::Geometric;
use super::{RigidBodyModes, algebraic};
use crate::dense;
use crate::error::{Error, Result};
use crate::partition::Partition;

/// Share of the Rayleigh quotient of the first elastic mode that rounded coordinates may cost. Five digits of a plate of
/// thickness 1:1000 cost 3·10⁻³, one node of a block moved by a hundredth costs 2.5·10⁻² (catalogue I-18, I-19).
const ROUNDED: f64 = 1e-2;

/// How far the worst node may stand out from the median one. Rounding is of one size everywhere: the largest of a million
/// normal numbers is 7 times the median one, and digits may be lost unevenly by some 10. A node out of place by a hundredth
/// stands out by 10³ to 10⁴.
const EVEN: f64 = 100.0;

/// A rotation by the coordinates that K does not let pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// The axis of the rotation.
    pub rotation: &'static str,
    /// Rayleigh quotient of the worst rigid motion of the coordinates; relative to the first elastic eigenvalue once that
    /// is known.
    pub energy: f64,
    /// Largest force of a node relative to its stiffness, over that of the median node or what six digits lose.
    pub concentration: f64,
    /// The dofs where the force is largest, one for each of three nodes.
    pub at: String,
}

/// The rigid-body modes of a component whose coordinates are in doubt, and the factorisations they took.
pub(super) fn settled(partition: &Partition, found: Geometric, misfit: Misfit) -> Result<(RigidBodyModes, usize)> {
    let (zero, first_elastic, n_factorisations) = algebraic::zero_modes(partition)?;
    let Geometric { rigid, motions, are_classical, .. } = found;
    if zero.count() <= rigid.count() && rigid.count() < motions.ncols() {
        // K has no more motions than those of the coordinates that it lets pass: the rotation is held.
        return Ok((rigid, n_factorisations));
    }
    let Misfit { rotation, energy, concentration, at } = misfit;
    let energy = first_elastic.map_or(f64::INFINITY, |lambda| energy / lambda);
    // Of a node out of place all but what the median node shows is too much.
    let expected = if concentration <= EVEN { ROUNDED } else { ROUNDED.min(energy / concentration.powi(2)) };
    if zero.count() < motions.ncols() || energy.is_nan() || energy > expected {
        return Err(Error::CoordinatesDoNotFit { rotation, energy, expected, dof: at });
    }
    let misfit = Some(Misfit { rotation, energy, concentration, at });
    if zero.count() > motions.ncols() {
        return Ok((RigidBodyModes { misfit, ..zero }, n_factorisations));
    }
    // The unit motions without what the rounding put into them: Q QᵀM U is free of energy and still means translation and
    // rotation.
    let modes: Mat<f64> = {
        let amplitudes = dense::gram(zero.mass_orthonormal.as_ref(), motions.as_ref());
        dense::product(zero.orthonormal.as_ref(), amplitudes.as_ref())
    };
    Ok((RigidBodyModes { modes, misfit, is_classical: are_classical, ..zero }, n_factorisations))
}
