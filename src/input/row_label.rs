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
