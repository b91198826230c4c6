//! K_II factored, or the reason why it cannot be.

use crate::error::{Error, Result};
use crate::factor::{Analysis, Cholesky, Storage, boundary_of, few_digits, without_energy};
use crate::partition::Partition;
use crate::rigid::{InterfaceRank, RigidBodyModes, or_lack_of_rank, shift_of_factor};

/// L Lᵀ of K_II, or of (K − σM)_II below the spectrum where no interface holds a free component; `rank` is absent where the interface leaves
/// rigid-body motions free.
///
/// # Errors
/// K_II is not definite; the message names the true reason first: the digits of the data, then an interface that leaves a
/// motion free, rigid-body or mechanism. No memory.
pub fn interior_factor<'a>(
    partition: &'a Partition,
    analysis: &'a Analysis,
    rigid: &RigidBodyModes,
    (storage, rank): (Storage, Option<InterfaceRank>),
) -> Result<Cholesky<'a>> {
    let sigma = shift_of_factor(partition, rigid, rank);
    let (shifted, name) = ((partition.pencil(), sigma), |dof| partition.name_of(dof));
    let factor = match partition.cache() {
        None => Cholesky::kept(analysis, shifted, storage, &name),
        Some(cache) => {
            let key = if sigma == 0.0 { Partition::key_of_stiffness } else { Partition::key_of_matrices };
            let key = key(partition, "factor").shown(&storage).numbers(&[sigma]);
            Cholesky::recalled((cache, &key), analysis, shifted, storage, &name)
        }
    };
    factor.map_err(|error| refused(error, analysis, partition, rigid))
}

fn refused(error: Error, analysis: &Analysis, partition: &Partition, rigid: &RigidBodyModes) -> Error {
    let error = few_digits(error, analysis, (&partition.stiffness).into(), partition.precision.stiffness);
    or_mechanism(or_lack_of_rank(error, partition, rigid), analysis, partition)
}

/// The motion that the interface leaves free, where the digits tell it from all others: more of them would not hold it.
fn or_mechanism(error: Error, analysis: &Analysis, partition: &Partition) -> Error {
    let Error::DigitsTooFew { .. } = error else { return error };
    let stiffness = (&partition.stiffness).into();
    match without_energy(analysis, stiffness, partition.precision.stiffness) {
        Ok(Some(dof)) => Error::NotDefinite { dof: partition.name_of(dof), boundary: boundary_of(analysis, stiffness) },
        _ => error,
    }
}
