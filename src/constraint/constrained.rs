//! What the factor of K_II tells of a component at once: constraint modes, mechanisms and the rank of its interface.

use super::constraint_modes::{ConstraintModes, constraint_modes_in};
use super::mechanism::{LooseMotions, with_mechanisms};
use crate::error::Result;
use crate::factor::Cholesky;
use crate::partition::Partition;
use crate::plan::Statics;
use crate::rigid::{InterfaceRank, RigidBodyModes, confirmed_rank, counted_by_matrices, with_passing};

/// A component as its interface sees it.
#[derive(Clone, Debug)]
pub struct Constrained<'a> {
    /// Ψ_S and K̂_BB; none where the interface leaves rigid-body motions free.
    pub modes: Option<ConstraintModes<'a>>,
    /// The rigid-body modes with the motions of mechanisms, and those that mixed boundaries let pass.
    pub rigid: RigidBodyModes,
    /// How well the interface reacts the rigid-body modes.
    pub rank: InterfaceRank,
    /// Mechanisms and what comes near them.
    pub loose: LooseMotions,
    /// Factorisations that counting the motions without energy took.
    pub n_factorisations: usize,
}

/// Solves for the constraint modes and looks for mechanisms among them. Where the interface does not react all rigid-body motions, `rank`
/// is absent: then there are none, and the matrices tell mechanisms.
///
/// # Errors
/// A rigid-body motion leaves the interface at rest as far as the digits tell; a motion without energy and mass; solves that
/// do not come down to rounding; a dense eigenproblem that does not converge.
pub fn constrained<'a>(
    partition: &Partition,
    (factor, form): (&'a Cholesky<'a>, Statics),
    rigid: RigidBodyModes,
    rank: Option<InterfaceRank>,
) -> Result<Constrained<'a>> {
    let Some(rank) = rank else {
        let (rigid, n_factorisations) = counted_by_matrices(partition, rigid)?;
        let (rank, loose) = (InterfaceRank { singular_ratio: 1.0 }, LooseMotions::default());
        return Ok(Constrained { modes: None, rigid, rank, loose, n_factorisations });
    };
    let (rank, n_factorisations) = confirmed_rank(partition, &rigid, rank, factor)?;
    let modes = constraint_modes_in(form, partition, factor, &rigid);
    factor.refinement()?;
    let (rigid, loose) = with_mechanisms(partition, &modes, rigid)?;
    let rigid = with_passing(rigid, partition)?;
    let n_factorisations = n_factorisations + loose.n_factorisations;
    Ok(Constrained { modes: Some(modes), rigid, rank, loose, n_factorisations })
}
