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

/// The radius of gyration by the masses of dofs, M_ii, of rotations over those of translations; none where either is nothing. Dofs without a
/// direction do not count.
pub(crate) fn gyration(masses: impl IntoIterator<Item = (Option<Direction>, f64)>) -> Option<f64> {
    let [mut translations, mut rotations] = [0.0; 2];
    for (direction, mass) in masses {
        match direction.map(Direction::is_rotation) {
            Some(true) => rotations += mass,
            Some(false) => translations += mass,
            None => {}
        }
    }
    Some(f64::sqrt(rotations / translations)).filter(|radius| radius.is_normal())
}
