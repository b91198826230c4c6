//! Constraint modes: unit displacements of the interface, one at a time.

use faer::Mat;

use super::rigid_correction::{Carried, defect, left_inverse, rigid_error};
use super::schur_complement::condensed_stiffness;
use crate::dense;
use crate::factor::Cholesky;
use crate::partition::Partition;
use crate::rigid::{RigidBodyModes, unit_motions};

/// Ψ_S with what it took to make it exact.
#[derive(Clone, Debug)]
pub struct ConstraintModes {
    /// Ψ_S, n_I × n_B, corrected.
    pub modes: Mat<f64>,
    /// The correction at the interface.
    pub carried: Carried,
    /// K̂_BB = [Ψ_S; I]ᵀ K [Ψ_S; I], n_B × n_B: second order in the error of Ψ_S.
    pub stiffness: Mat<f64>,
    /// max (|Ψ|ᵀ|K||Ψ|)_ii / K_BB,ii over the interface dofs: rounding of K̂_BB is ε times this, relative to the stiffness of
    /// the interface before condensation.
    pub cancellation: f64,
    /// Error of equation (24) as solved: max |Ψ_S U_B − U_I| / max |U_I|.
    pub raw_rigid_error: f64,
}

/// Ψ_S = −K_II⁻¹ K_IB (23), then Ψ_S ← Ψ_S + (U_I − Ψ_S U_B) U_B⁺.
///
/// The correction has rank n_r and removes exactly the part of the error that the condition of K_II amplifies: after
/// it the interface carries every rigid-body motion to rounding, and with it the mass properties.
pub fn constraint_modes(partition: &Partition, factor: &Cholesky<'_>, rigid: &RigidBodyModes) -> ConstraintModes {
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let mut modes = factor.follow_border(Mat::<f64>::identity(n_b, n_b).as_ref());
    let mut raw_rigid_error = 0.0;
    let mut carried = Carried::nothing(n_b);
    // Without an interface there is nothing to be carried.
    if rigid.count() > 0 && n_b > 0 {
        raw_rigid_error = rigid_error(partition, modes.as_ref(), rigid.orthonormal.as_ref()).value;
        // Any basis of the motions serves; those of unit length U_B⁺ can tell apart whatever the mass they move.
        let unit = unit_motions(partition, rigid).unwrap_or_else(|_| rigid.orthonormal.clone());
        let (u_i, u_b) = unit.as_ref().split_at_row(n_i);
        let defect = defect(modes.as_ref(), u_i, u_b);
        carried = Carried { motions: u_b.to_owned(), lift: left_inverse(partition, modes.as_ref(), u_b) };
        dense::add_product(modes.as_mut(), 1.0, defect.as_ref(), carried.lift.as_ref());
    }
    let (stiffness, cancellation) = condensed_stiffness(partition, modes.as_ref());
    ConstraintModes { modes, carried, stiffness, cancellation, raw_rigid_error }
}
