//! Terms of the exact stiffness that belong to one node.

use super::measures::PlaceMatrices;
use crate::motion::Matrix6;

/// How velocities and accelerations at one node change with the place.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaceTerms {
    /// z.
    pub(super) velocity: PlaceMatrices,
    /// ζ at fixed V_F, and what is taken from it for ∂V_F.
    pub(super) acceleration: PlaceMatrices,
    pub(super) of_frame: Matrix6,
}

impl PlaceTerms {
    pub(super) const ZERO: Self = {
        let zero = PlaceMatrices { node: [[0.0; 6]; 6], frame: [[0.0; 6]; 6] };
        Self { velocity: zero, acceleration: zero, of_frame: [[0.0; 6]; 6] }
    };
}
