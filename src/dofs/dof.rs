//! What one row of the matrices stands for.

use supel_runtime::Direction;

/// A degree of freedom of the finite element model: what one row of K and M stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dof {
    /// Label of the node, as the finite element program numbers it.
    pub node: i64,
    /// Direction at the node.
    pub direction: Direction,
}

impl std::fmt::Display for Dof {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "node {} {}", self.node, self.direction)
    }
}

/// The degree of freedom of every row, in row order; none for a scalar dof, an amplitude that belongs to no node and that rigid-body
/// motion leaves at rest.
pub type DofMap = Vec<Option<Dof>>;
