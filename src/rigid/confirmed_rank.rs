//! A second look at an interface where K_II has a factor that may be one of rounding.

use super::of_partition::counted_by_matrices;
use super::rank::{InterfaceRank, rank_of_every, rank_within};
use super::rigid_body_modes::RigidBodyModes;
use crate::eigen::{Factored, ModeRequest, Wanted, elastic_modes};
use crate::error::Result;
use crate::factor::Cholesky;
use crate::job::Eigensolver;
use crate::partition::Partition;
use crate::random::SEED;

/// Pivots of K_II below this share of their diagonal entries may be rounding of what K was made from, turned rows and constraints among it:
/// those of slender parts are below it as well, and cost one more search.
const DOUBTFUL_PIVOT: f64 = 1e-8;

/// Looks again at an interface that reacts a motion by no more than the digits of K turn the motions themselves, and where little of the
/// stiffness of a dof is left when K_II is eliminated: K_II is singular but for rounding where its lowest eigenvalue is rounding. Then
/// a rigid-body motion leaves the interface at rest, or a mechanism does, which the matrices tell. The rank, and how many factorisations
/// that took.
///
/// # Errors
/// A motion without energy leaves the interface at rest as far as the digits tell; the eigensolver fails.
pub fn confirmed_rank(
    partition: &Partition,
    rigid: &RigidBodyModes,
    rank: InterfaceRank,
    factor: &Cholesky<'_>,
) -> Result<(InterfaceRank, usize)> {
    let is_reacted = rank.singular_ratio > rigid.energy.angle && factor.smallest_pivot_ratio > DOUBTFUL_PIVOT;
    if is_reacted || partition.n_internal == 0 {
        return Ok((rank, 0));
    }
    let request = ModeRequest { wanted: Wanted::Count(1), eigensolver: Eigensolver::Lanczos, seed: SEED };
    let lowest = elastic_modes(partition.held_problem(), &Factored::new(factor, 0.0), request)?;
    match lowest.errors.first() {
        Some(error) if error.data_bar >= 1.0 => {
            let rank = rank_within(partition, rigid, rigid.energy.angle)?;
            match counted_by_matrices(partition, rigid.clone()) {
                Ok((every, n_factorisations)) => {
                    rank_of_every(partition, (rigid, &every))?;
                    Ok((rank, n_factorisations))
                }
                // What the digits do not let be counted is no lack of this interface.
                Err(error) if error.class().is_of_matrices() => Ok((rank, 0)),
                Err(error) => Err(error),
            }
        }
        _ => Ok((rank, 0)),
    }
}
