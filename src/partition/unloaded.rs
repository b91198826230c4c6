//! Interface dofs on which, by the scene, no load acts.

use std::collections::BTreeMap;

use crate::dofs::Direction;

/// Interface dofs that the scene says are unloaded, with what messages call them.
#[derive(Clone, Debug, Default)]
pub(super) struct Unloaded {
    /// Rows of the model.
    pub(super) rows: BTreeMap<usize, String>,
    /// Directions of the nodes of patches, by the number of the node.
    pub(super) of_patches: BTreeMap<(usize, Direction), String>,
}
