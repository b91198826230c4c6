//! The rows of a model, for results that stand at its nodes.

use crate::input::{InputFacts, ModeRows};
use crate::partition::{DofOrigin, Partition};

/// What each row that is left of the model is: a dof of the partition, or one that is held or follows others. `facts` are those of its
/// files.
pub fn mode_rows(partition: &Partition, facts: &InputFacts) -> ModeRows {
    let rows = &partition.model.rows;
    let of_dofs = partition.dofs.iter().filter_map(|dof| match dof.origin {
        DofOrigin::Row(row) => Some((rows.of(row), dof.dof)),
        DofOrigin::PatchNode(..) | DofOrigin::Distortion(..) => None,
    });
    let of_followers = partition.followers.iter().map(|follower| (rows.of(follower.row), follower.dof));
    ModeRows {
        n: partition.model.n_dofs + rows.n_dropped(),
        left: of_dofs.chain(of_followers).collect(),
        turning: facts.turning.clone(),
    }
}
