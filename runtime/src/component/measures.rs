//! Measures of the deformation of one interface node and their derivatives, eqs. (63), (64) and (90), (91).
//!
//! | symbol | meaning | shape |
//! |---|---|---|
//! | H_E = H_F⁻¹H_j = (R, u) | motion of the node seen from the floating frame | |
//! | E | measure of it: P(H_E), or (d; κ) with d = R x + u − x and κ̃ = (R − Rᵀ)/2 for a node at x | 6 |
//! | J, F | ΔE = J ΔU_j − F ΔU_F; with J = T⁻¹(E), F = T⁻¹(−E) = J − Ê for motion parameters | 6 × 6 |
//! | y = J̇ V − Ḟ V_F | part of Ë that does not come from accelerations | 6 |
//!
//! *By the velocities* a derivative is taken at a fixed place, *by the place* at fixed velocities.

mod classical;
mod motion_based;

use super::Measures;
use crate::motion::{Matrix6, Motion, Vector3, Vector6, multiply_6};

/// Deformation of one interface node.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeMeasure {
    /// H_E.
    pub(super) motion: Motion,
    pub(super) e: Vector6,
    pub(super) j: Matrix6,
    pub(super) f: Matrix6,
    /// F − U.
    pub(super) excess: Matrix6,
}

/// Velocities at one interface node.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeRates {
    /// Ė.
    pub(super) measure: Vector6,
    /// V_j.
    pub(super) node: Vector6,
    /// V_F.
    pub(super) frame: Vector6,
}

impl NodeRates {
    /// The rates of node j from ė, v and V_F.
    pub(super) fn of(j: usize, deformation_rate: &[f64], velocities: &[f64], frame_velocity: &Vector6) -> Self {
        let six = |values: &[f64]| core::array::from_fn(|i| values[6 * j + i]);
        Self { measure: six(deformation_rate), node: six(velocities), frame: *frame_velocity }
    }
}

/// Derivative of y by the velocities, Δy = `measure` ΔĖ + `node` ΔV_j − `frame` ΔV_F.
pub(super) struct RateMatrices {
    pub(super) measure: Matrix6,
    pub(super) node: Matrix6,
    pub(super) frame: Matrix6,
}

/// A derivative by the place, Δ = `node` ΔU_j − `frame` ΔU_F.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaceMatrices {
    pub(super) node: Matrix6,
    pub(super) frame: Matrix6,
}

impl PlaceMatrices {
    /// A ΔE.
    fn of_measure(a: &Matrix6, node: &NodeMeasure) -> Self {
        Self { node: multiply_6(a, &node.j), frame: multiply_6(a, &node.f) }
    }

    /// The sum of both derivatives.
    pub(super) fn plus(&self, other: &Self) -> Self {
        Self { node: sum_6(&self.node, &other.node), frame: sum_6(&self.frame, &other.frame) }
    }

    /// A Δ.
    pub(super) fn multiplied(&self, a: &Matrix6) -> Self {
        Self { node: multiply_6(a, &self.node), frame: multiply_6(a, &self.frame) }
    }
}

impl NodeMeasure {
    /// No deformation: J = F = U.
    pub(super) fn undeformed(rigid: &Matrix6) -> Self {
        Self { motion: Motion::IDENTITY, e: [0.0; 6], j: *rigid, f: *rigid, excess: [[0.0; 6]; 6] }
    }
}

impl Measures {
    /// Measure of a motion relative to the floating frame of a node at `position`, without `excess`; `None` at half a turn.
    #[inline]
    pub(super) fn of(self, motion: &Motion, position: &Vector3) -> Option<NodeMeasure> {
        let parameters = motion.parameters()?;
        Some(match self {
            Self::MotionBased => motion_based::measure(motion, &parameters),
            Self::Classical => classical::measure(motion, position),
        })
    }

    /// y = J̇ V − Ḟ V_F.
    #[inline]
    pub(super) fn rates_times(self, node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> Vector6 {
        match self {
            Self::MotionBased => motion_based::rates_times(node, rates),
            Self::Classical => classical::rates_times(node, position, rates),
        }
    }

    /// Derivative of y by the velocities.
    pub(super) fn rate_matrices(self, node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> RateMatrices {
        match self {
            Self::MotionBased => motion_based::rate_matrices(node, rates),
            Self::Classical => classical::rate_matrices(node, position, rates),
        }
    }

    /// Derivative of J x − F x_F by the place, at fixed x and x_F.
    pub(super) fn carried_by_place(
        self,
        node: &NodeMeasure,
        position: &Vector3,
        [x, x_f]: [&Vector6; 2],
    ) -> PlaceMatrices {
        match self {
            Self::MotionBased => PlaceMatrices::of_measure(&motion_based::carried(node, [x, x_f]), node),
            Self::Classical => classical::carried(node, position, [x, x_f]),
        }
    }

    /// Derivative of y by the place, at fixed Ė, V_j and V_F.
    pub(super) fn rates_by_place(self, node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> PlaceMatrices {
        match self {
            Self::MotionBased => PlaceMatrices::of_measure(&motion_based::rates_by_measure(node, rates), node),
            Self::Classical => classical::rates_by_place(node, position, rates),
        }
    }

    /// Derivatives of Jᵀh and of Fᵀh by the place, at fixed h.
    pub(super) fn forces_by_place(self, node: &NodeMeasure, position: &Vector3, h: &Vector6) -> [PlaceMatrices; 2] {
        match self {
            Self::MotionBased => motion_based::forces_by_measure(node, h).map(|a| PlaceMatrices::of_measure(&a, node)),
            Self::Classical => classical::forces_by_place(node, position, h),
        }
    }
}

fn sum_6(a: &Matrix6, b: &Matrix6) -> Matrix6 {
    core::array::from_fn(|i| core::array::from_fn(|c| a[i][c] + b[i][c]))
}

fn difference_6(a: &Matrix6, b: &Matrix6) -> Matrix6 {
    core::array::from_fn(|i| core::array::from_fn(|c| a[i][c] - b[i][c]))
}
