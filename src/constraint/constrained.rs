//! What the factor of K_II tells of a component at once: constraint modes, mechanisms and the rank of its interface.

use super::constraint_modes::{ConstraintModes, constraint_modes};
use super::mechanism::{LooseMotions, with_mechanisms};
use crate::error::Result;
use crate::factor::Cholesky;
use crate::partition::Partition;
use crate::rigid::{InterfaceRank, RigidBodyModes, confirmed_rank, with_passing};

/// A component as its interface sees it.
#[derive(Clone, Debug)]
pub struct Constrained {
    /// Ψ_S and K̂_BB.
    pub modes: ConstraintModes,
    /// The rigid-body modes with the motions of mechanisms, and those that mixed boundaries let pass.
    pub rigid: RigidBodyModes,
    /// How well the interface reacts the rigid-body modes.
    pub rank: InterfaceRank,
    /// Mechanisms and what comes near them.
    pub loose: LooseMotions,
}

/// Solves for the constraint modes and looks for mechanisms among them.
///
/// # Errors
/// A rigid-body motion leaves the interface at rest as far as the digits tell; a motion without energy and mass; solves that
/// do not come down to rounding; a dense eigenproblem that does not converge.
pub fn constrained(
    partition: &Partition,
    factor: &Cholesky<'_>,
    rigid: RigidBodyModes,
    rank: InterfaceRank,
) -> Result<Constrained> {
    let rank = confirmed_rank(partition, &rigid, rank, factor)?;
    let modes = constraint_modes(partition, factor, &rigid);
    factor.refinement()?;
    let (rigid, loose) = with_mechanisms(partition, &modes, rigid)?;
    let rigid = with_passing(rigid, partition)?;
    Ok(Constrained { modes, rigid, rank, loose })
}
