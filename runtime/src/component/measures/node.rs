//! Deformation of one interface node, its rates, and the matrices of their derivatives.

use crate::motion::{Matrix6, Motion, Vector6, multiply_6};

/// Deformation of one interface node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeMeasure {
    /// H_E.
    pub(crate) motion: Motion,
    pub(crate) e: Vector6,
    pub(crate) j: Matrix6,
    pub(crate) f: Matrix6,
    /// F − U.
    pub(crate) excess: Matrix6,
}

/// Velocities at one interface node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeRates {
    /// Ė.
    pub(crate) measure: Vector6,
    /// V_j.
    pub(crate) node: Vector6,
    /// V_F.
    pub(crate) frame: Vector6,
}

impl NodeRates {
    /// The rates of node j from ė, v and V_F.
    pub(crate) fn of(j: usize, deformation_rate: &[f64], velocities: &[f64], frame_velocity: &Vector6) -> Self {
        let six = |values: &[f64]| core::array::from_fn(|i| values[6 * j + i]);
        Self { measure: six(deformation_rate), node: six(velocities), frame: *frame_velocity }
    }
}

/// Derivative of y by the velocities, Δy = `measure` ΔĖ + `node` ΔV_j − `frame` ΔV_F.
pub(crate) struct RateMatrices {
    pub(crate) measure: Matrix6,
    pub(crate) node: Matrix6,
    pub(crate) frame: Matrix6,
}

/// A derivative by the place, Δ = `node` ΔU_j − `frame` ΔU_F.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaceMatrices {
    pub(crate) node: Matrix6,
    pub(crate) frame: Matrix6,
}

impl PlaceMatrices {
    /// A ΔE.
    pub(super) fn of_measure(a: &Matrix6, node: &NodeMeasure) -> Self {
        Self { node: multiply_6(a, &node.j), frame: multiply_6(a, &node.f) }
    }

    /// The sum of both derivatives.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { node: sum_6(&self.node, &other.node), frame: sum_6(&self.frame, &other.frame) }
    }

    /// A Δ.
    pub(crate) fn multiplied(&self, a: &Matrix6) -> Self {
        Self { node: multiply_6(a, &self.node), frame: multiply_6(a, &self.frame) }
    }
}

impl NodeMeasure {
    /// No deformation: J = F = U.
    pub(crate) fn undeformed(rigid: &Matrix6) -> Self {
        Self { motion: Motion::IDENTITY, e: [0.0; 6], j: *rigid, f: *rigid, excess: [[0.0; 6]; 6] }
    }
}

pub(super) fn sum_6(a: &Matrix6, b: &Matrix6) -> Matrix6 {
    core::array::from_fn(|i| core::array::from_fn(|c| a[i][c] + b[i][c]))
}

pub(super) fn difference_6(a: &Matrix6, b: &Matrix6) -> Matrix6 {
    core::array::from_fn(|i| core::array::from_fn(|c| a[i][c] - b[i][c]))
}
