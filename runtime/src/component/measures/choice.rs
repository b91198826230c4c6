//! The measures to choose from, and what each makes of a node.

use super::node::{NodeMeasure, NodeRates, PlaceMatrices, RateMatrices};
use super::{classical, motion_based};
use crate::motion::{Motion, Vector3, Vector6};

/// How the deformation of an interface node is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measures {
    /// Motion parameters of the node relative to the floating frame, eq. (63).
    MotionBased,
    /// Displacement and skew part of the rotation in the floating frame, eq. (90); for comparison.
    Classical,
}

impl Measures {
    /// Measure of a motion relative to the floating frame of a node at `position`, without `excess`; `None` at half a turn.
    #[inline]
    pub(crate) fn of(self, motion: &Motion, position: &Vector3) -> Option<NodeMeasure> {
        let parameters = motion.parameters()?;
        Some(match self {
            Self::MotionBased => motion_based::measure(motion, &parameters),
            Self::Classical => classical::measure(motion, position),
        })
    }

    /// y = J̇ V − Ḟ V_F.
    #[inline]
    pub(crate) fn rates_times(self, node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> Vector6 {
        match self {
            Self::MotionBased => motion_based::rates_times(node, rates),
            Self::Classical => classical::rates_times(node, position, rates),
        }
    }

    /// Derivative of y by the velocities.
    pub(crate) fn rate_matrices(self, node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> RateMatrices {
        match self {
            Self::MotionBased => motion_based::rate_matrices(node, rates),
            Self::Classical => classical::rate_matrices(node, position, rates),
        }
    }

    /// Derivative of J x − F x_F by the place, at fixed x and x_F.
    pub(crate) fn carried_by_place(
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
    pub(crate) fn rates_by_place(self, node: &NodeMeasure, position: &Vector3, rates: &NodeRates) -> PlaceMatrices {
        match self {
            Self::MotionBased => PlaceMatrices::of_measure(&motion_based::rates_by_measure(node, rates), node),
            Self::Classical => classical::rates_by_place(node, position, rates),
        }
    }

    /// Derivatives of Jᵀh and of Fᵀh by the place, at fixed h.
    pub(crate) fn forces_by_place(self, node: &NodeMeasure, position: &Vector3, h: &Vector6) -> [PlaceMatrices; 2] {
        match self {
            Self::MotionBased => motion_based::forces_by_measure(node, h).map(|a| PlaceMatrices::of_measure(&a, node)),
            Self::Classical => classical::forces_by_place(node, position, h),
        }
    }
}
