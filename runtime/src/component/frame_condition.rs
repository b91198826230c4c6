//! The condition Yᵀe = 0 that defines the floating frame, and what rounding makes of it.

use super::dense;
use super::state::State;
use crate::motion::{Vector3, Vector6};

/// Error of a term of Yᵀe relative to the numbers it is made of: some tens of operations rounded at 1e-16. The search
/// converges quadratically and reaches it.
const ROUNDING: f64 = 1e-14;

/// Which condition Yᵀe = 0 defines the floating frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FloatingFrame {
    /// Y = M̂Û: the deformation has no momentum in the floating frame; the paper's choice, eq. (25).
    MassWeighted,
    /// Y = Û: the deformation measures of the nodes have no mean. It needs no mass and does not depend on the mesh.
    Rigid,
}

/// What rounding makes of Yᵀe: each of its six rows is a sum of translations, rotations and amplitudes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FrameRounding {
    /// Largest coordinate of an interface node.
    pub(super) extent: f64,
    /// Sums of the magnitudes of Y over translations, rotations and amplitudes.
    weights: [Vector6; 3],
}

impl FrameRounding {
    pub(super) fn new(frame: &[Vector6], positions: &[Vector3]) -> Self {
        let mut weights = [[0.0; 6]; 3];
        for (i, row) in frame.iter().enumerate() {
            let kind = if i >= 6 * positions.len() { 2 } else { i % 6 / 3 };
            weights[kind] = dense::plus_scaled(&weights[kind], 1.0, &row.map(f64::abs));
        }
        Self { extent: largest(positions.as_flattened()), weights }
    }

    /// Rounding of each row: displacements are differences of numbers as large as the way of the component.
    pub(super) fn of(&self, state: &State<'_>) -> Vector6 {
        let way = state.motions.iter().fold(self.extent, |size, motion| size.max(largest(&motion.translation)));
        let [translations, rotations, amplitudes] = &self.weights;
        let amplitude = largest(state.amplitudes);
        core::array::from_fn(|a| ROUNDING * (translations[a] * way + rotations[a] + amplitudes[a] * amplitude))
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |size: f64, x| size.max(x.abs()))
}
