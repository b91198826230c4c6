//! What a matrix calls one of its rows.

use crate::dofs::{Direction, Dof};

/// What a matrix calls one of its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct RowLabel {
    /// Label of the node or of a scalar point; negative where the program made it for itself.
    pub(super) node: i64,
    /// 1 to 6 for the directions, 0 for a scalar point, or what else the program numbers.
    pub(super) component: u8,
}

impl RowLabel {
    /// The degree of freedom; none where it is that of no node: a scalar point, a pressure, a multiplier.
    pub(super) fn dof(self) -> Option<Dof> {
        let direction = Direction::ALL.get(usize::from(self.component.checked_sub(1)?)).copied()?;
        (self.node > 0).then_some(Dof { node: self.node, direction })
    }

    /// Where a row is among those of a superelement, of which this is one in a list: rows of nodes in the order of nodes and directions,
    /// behind those that the program made for itself. Of these the numbers say no more than the order in which they were made.
    pub(super) fn place_in_superelement(self, listed: usize) -> (bool, usize, Self) {
        let is_made = self.node < 0;
        (!is_made, if is_made { listed } else { 0 }, self)
    }

    /// Label and direction of a row that belongs to no node, as a dof map has them: `10,scalar`, and `14,scalar:8` of what a program
    /// numbers 8 at a node.
    pub(super) fn in_map(self) -> String {
        match self.component {
            0 => format!("{},{SCALAR}", self.node),
            component => format!("{},{SCALAR}:{component}", self.node),
        }
    }
}

/// The direction of a scalar dof in a dof map.
const SCALAR: &str = "scalar";

/// What a program numbers a scalar dof by, from such a direction; none of any other direction.
pub(super) fn scalar_component(direction: &str) -> Option<u8> {
    match direction.strip_prefix(SCALAR)? {
        "" => Some(0),
        number => number.strip_prefix(':')?.parse().ok(),
    }
}

impl std::fmt::Display for RowLabel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.dof() {
            Some(dof) => dof.fmt(f),
            None if self.component == 0 => write!(f, "scalar point {}", self.node),
            None => write!(f, "node {} dof {}", self.node, self.component),
        }
    }
}
