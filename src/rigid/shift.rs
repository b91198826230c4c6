//! The shift at which K_II is factored.

use super::rank::InterfaceRank;
use super::rigid_body_modes::RigidBodyModes;
use crate::eigen::first_shift;
use crate::partition::Partition;

/// The shift at which K_II is factored: zero where it is definite, below zero where no interface holds a free component, or one of no known
/// `rank` that leaves rigid-body motions free.
pub fn shift_of_factor(partition: &Partition, rigid: &RigidBodyModes, rank: Option<InterfaceRank>) -> f64 {
    if (partition.n_interface() > 0 && rank.is_some()) || rigid.count() == 0 {
        return 0.0;
    }
    first_shift(partition.free_problem())
}
