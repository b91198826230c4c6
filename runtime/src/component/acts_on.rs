//! What forces act on: the deformation of a component, or its whole motion.
//!
//! The component moves by ė in its floating frame, and by ε = ė + U V_F altogether; both are (J − W Q) v, with W = F for
//! the first and W = F − U for the second, because V_F = Q v.

use super::measures::NodeMeasure;
use crate::motion::Matrix6;

/// What a quantity of the component acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ActsOn {
    /// The deformation ė: W = F.
    Deformation,
    /// The whole motion ε = ė + U V_F: W = F − U.
    Motion,
}

impl ActsOn {
    /// W of one node.
    #[inline]
    pub(super) fn carried(self, node: &NodeMeasure) -> &Matrix6 {
        match self {
            Self::Deformation => &node.f,
            Self::Motion => &node.excess,
        }
    }
}
