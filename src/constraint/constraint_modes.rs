//! Constraint modes: unit displacements of the interface, one at a time.

use faer::Mat;

use super::attachment::Attachment;
use super::rigid_correction::{Carried, defect, left_inverse, left_inverse_by, left_inverse_of, rigid_error};
use super::schur_complement::{condensed_stiffness, sampled_cancellation};
use super::static_modes::{LowRank, StaticModes};
use crate::cache::{Key, Kind, Reader, Recorded, Writer, recalled};
use crate::dense;
use crate::factor::{Cholesky, Storage};
use crate::partition::Partition;
use crate::plan::Statics;
use crate::rigid::{RigidBodyModes, unit_motions};
use crate::sparse::diagonal;

/// Ψ_S with what it took to make it exact.
#[derive(Clone, Debug)]
pub struct ConstraintModes<'a> {
    /// Ψ_S, n_I × n_B, corrected.
    pub modes: StaticModes<'a>,
    /// The correction at the interface.
    pub carried: Carried,
    /// K̂_BB = [Ψ_S; I]ᵀ K [Ψ_S; I], n_B × n_B: second order in the error of Ψ_S. Where no constraint mode is formed, what elimination
    /// leaves of the interface, which is the same matrix to first order.
    pub stiffness: Mat<f64>,
    /// max (|Ψ|ᵀ|K||Ψ|)_ii / K_BB,ii over the interface dofs: rounding of K̂_BB is ε times this, relative to the stiffness of
    /// the interface before condensation.
    pub cancellation: f64,
    /// Error of equation (24) as solved: max |Ψ_S U_B − U_I| / max |U_I|.
    pub raw_rigid_error: f64,
    /// What they are made of where the interface leaves rigid-body motions free: Ψ_R then, and no constraint modes.
    pub attachment: Option<Attachment>,
}

impl ConstraintModes<'_> {
    /// Goes on with the key of what is made of them and of the partition.
    pub(crate) fn key(&self, key: Key) -> Key {
        // Operators take them as they are stored, or make them again by solves.
        let Carried { motions, lift } = &self.carried;
        let key = key.text(self.modes.form()).shown(&self.attachment.is_some()).columns(self.stiffness.as_ref());
        key.columns(motions.as_ref()).columns(lift.as_ref())
    }
}

/// Ψ_S = −K_II⁻¹ K_IB (23), then Ψ_S ← Ψ_S + (U_I − Ψ_S U_B) U_B⁺.
///
/// The correction has rank n_r and removes exactly the part of the error that the condition of K_II amplifies: after
/// it the interface carries every rigid-body motion to rounding, and with it the mass properties.
pub fn constraint_modes(
    partition: &Partition,
    factor: &Cholesky<'_>,
    rigid: &RigidBodyModes,
) -> ConstraintModes<'static> {
    let n_b = partition.n_interface();
    // What refinement took of a factor in single precision is part of the report.
    let cache = partition.cache().filter(|_| factor.storage() == Storage::Double && n_b > 0);
    let solved = || Ok(Solved(factor.follow_border(Mat::<f64>::identity(n_b, n_b).as_ref())));
    let Solved(mut modes) = recalled(cache, || partition.key_of_stiffness("constraint modes"), solved)
        .expect("a factor follows every motion of its border");
    let mut raw_rigid_error = 0.0;
    let mut carried = Carried::nothing(n_b);
    // Without an interface there is nothing to be carried.
    if rigid.count() > 0 && n_b > 0 {
        let [u_i, u_b] = motions_to_carry(partition, rigid);
        let solved = StaticModes::stored(modes);
        raw_rigid_error = rigid_error(partition, &solved, rigid.orthonormal.as_ref()).value;
        let defect = defect(&solved, u_i.as_ref(), u_b.as_ref());
        modes = solved.to_columns();
        let lift = left_inverse(partition, modes.as_ref(), u_b.as_ref());
        dense::add_product(modes.as_mut(), 1.0, defect.as_ref(), lift.as_ref());
        carried = Carried { motions: u_b, lift };
    }
    let modes = StaticModes::stored(modes);
    let (stiffness, cancellation) = condensed_stiffness(partition, &modes);
    ConstraintModes { modes, carried, stiffness, cancellation, raw_rigid_error, attachment: None }
}

/// Constraint modes before they are corrected, as an entry of a cache has them.
struct Solved(Mat<f64>);

impl Recorded for Solved {
    const KIND: Kind = Kind::Statics;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        to.columns(self.0.as_ref())
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        from.columns().map(Self)
    }
}

/// The constraint modes in the form that a plan has chosen.
pub fn constraint_modes_in<'a>(
    form: Statics,
    partition: &Partition,
    factor: &'a Cholesky<'a>,
    rigid: &RigidBodyModes,
) -> ConstraintModes<'a> {
    match form {
        Statics::Stored => constraint_modes(partition, factor, rigid),
        Statics::ByFactor | Statics::Condensed => by_factor(form, partition, factor, rigid),
        Statics::Carried => carried_by_motions(partition, rigid),
    }
}

/// Any basis of the motions serves; those of unit length U_B⁺ can tell apart whatever the mass they move.
fn motions_to_carry(partition: &Partition, rigid: &RigidBodyModes) -> [Mat<f64>; 2] {
    let unit = unit_motions(partition, rigid).unwrap_or_else(|_| rigid.orthonormal.clone());
    let (u_i, u_b) = unit.as_ref().split_at_row(partition.n_internal);
    [u_i.to_owned(), u_b.to_owned()]
}

/// Ψ_S that the factor makes each time, corrected as the stored one is.
///
/// Where no column is ever made, the weights of U_B⁺ are what the interior takes of the energy of each dof, ψᵀK_IIψ = (K_BB − K̂_BB)_jj: there is
/// no mass then that the correction changes.
fn by_factor<'a>(
    form: Statics,
    partition: &Partition,
    factor: &'a Cholesky<'a>,
    rigid: &RigidBodyModes,
) -> ConstraintModes<'a> {
    let (n_i, n_b, n_r) = (partition.n_internal, partition.n_interface(), rigid.count());
    let nothing = |n_r: usize| LowRank { tall: Mat::zeros(n_i, n_r), wide: Mat::zeros(n_r, n_b) };
    let solved = StaticModes::by_factor(factor, nothing(0));
    let schur = (form == Statics::Condensed).then(|| factor.condensed());
    let (mut carried, mut raw_rigid_error, mut correction) = (Carried::nothing(n_b), 0.0, nothing(0));
    if n_r > 0 && n_b > 0 {
        let [u_i, u_b] = motions_to_carry(partition, rigid);
        raw_rigid_error = rigid_error(partition, &solved, rigid.orthonormal.as_ref()).value;
        let lift = match &schur {
            Some(schur) => {
                let outer = diagonal(&partition.stiffness).split_off(n_i);
                let inside: Vec<f64> = (0..n_b).map(|j| (outer[j] - schur[(j, j)]).max(0.0)).collect();
                left_inverse_by(partition, &inside, u_b.as_ref())
            }
            None => left_inverse_of(partition, &solved, u_b.as_ref()),
        };
        correction = LowRank { tall: defect(&solved, u_i.as_ref(), u_b.as_ref()), wide: lift.clone() };
        carried = Carried { motions: u_b, lift };
    }
    let modes = StaticModes::by_factor(factor, correction);
    let (stiffness, cancellation) = match schur {
        Some(schur) => (schur, sampled_cancellation(partition, &modes)),
        None => condensed_stiffness(partition, &modes),
    };
    let modes = modes.with_stiffness(stiffness.clone());
    ConstraintModes { modes, carried, stiffness, cancellation, raw_rigid_error, attachment: None }
}

/// Ψ_S = U_I U_B⁻¹ where the interface has as many dofs as there are rigid-body motions: nothing deforms, and K̂_BB is what K makes of these
/// motions.
fn carried_by_motions(partition: &Partition, rigid: &RigidBodyModes) -> ConstraintModes<'static> {
    let [u_i, u_b] = motions_to_carry(partition, rigid);
    let lift = dense::inverse(u_b.as_ref());
    let modes = StaticModes::carried(LowRank { tall: u_i, wide: lift.clone() });
    let (stiffness, cancellation) = condensed_stiffness(partition, &modes);
    let modes = modes.with_stiffness(stiffness.clone());
    let carried = Carried { motions: u_b, lift };
    ConstraintModes { modes, carried, stiffness, cancellation, raw_rigid_error: 0.0, attachment: None }
}
