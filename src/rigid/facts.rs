//! What the decisions of a plan need to know of a model.

use super::rank::InterfaceRank;
use super::rigid_body_modes::{RigidBodyModes, RigidSource};
use crate::partition::Partition;
use crate::plan::{Facts, Hold, MassPattern};
use crate::sparse::is_diagonal;

/// Sizes and properties of a partitioned model whose rigid-body modes are known; `rank` is absent where its interface leaves some of them
/// free.
pub fn facts(partition: &Partition, rigid: &RigidBodyModes, rank: Option<InterfaceRank>) -> Facts {
    Facts {
        n_dofs: partition.n_dofs(),
        n_internal: partition.n_internal,
        n_interface: partition.n_interface(),
        n_rigid: rigid.count(),
        modes_in_file: rigid.in_file(partition),
        hold: if rank.is_some() { Hold::Whole } else { Hold::Part },
        has_geometric_modes: rigid.source == RigidSource::Geometric,
        mass: if is_diagonal(&partition.mass) { MassPattern::Diagonal } else { MassPattern::Coupled },
        n_parts: partition.part_ends.len(),
        loads_inside: (0..partition.loads.count()).map(|load| partition.loads.acts_inside(load)).collect(),
    }
}
