//! Joints between nodes: constraints at position level, enforced by Lagrange multipliers.
//!
//! Supports that hold a node's own directions (clamp, spherical joint on the ground, motion in a plane, prescribed
//! rotation) need no multiplier: those coordinates are not free, see [`Support`].

use supel_runtime::motion::{Motion, Vector3, dot, transposed_times_3};

/// What becomes of one coordinate of a node: translations and rotations about the node's own, turning axes.
#[derive(Clone, Copy, Debug)]
pub enum Support {
    /// It moves.
    Free,
    /// It stays.
    Held,
    /// It turns as a prescribed angle, the angle's value and second derivative at the start.
    Driven {
        /// Angle over time, rad; zero at the start.
        angle: fn(f64) -> f64,
        /// Second derivative of the angle at time zero.
        initial_acceleration: f64,
    },
}

/// Directions of a node in a support: those of x, y, z, then the rotations.
pub type Supports = [Support; 6];

/// Nothing is held.
pub const FREE: Supports = [Support::Free; 6];
/// Everything is held.
pub const CLAMPED: Supports = [Support::Held; 6];
/// Free in the plane z = 0.
pub const PLANAR: Supports = [Support::Free, Support::Free, Support::Held, Support::Held, Support::Held, Support::Free];
/// Held in place, free to turn in every direction.
pub const SPHERICAL: Supports =
    [Support::Held, Support::Held, Support::Held, Support::Free, Support::Free, Support::Free];

/// A pin in the plane z = 0 with a prescribed angle.
pub const fn driven_pin(angle: fn(f64) -> f64, initial_acceleration: f64) -> Supports {
    let mut supports = CLAMPED;
    supports[5] = Support::Driven { angle, initial_acceleration };
    supports
}

/// A joint of one or two nodes, in inertial axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Joint {
    /// Two nodes that share their place in x and y: a revolute joint about z only where supports hold both nodes in the
    /// plane, see [`PLANAR`].
    PlanarPin([usize; 2]),
    /// A node that does not leave the plane through its first position, free to turn: a point on a plane. In a planar
    /// mechanism it is the massless slider with its pin; it is no prismatic joint, which would hold rotations.
    PointOnPlane {
        /// The node.
        node: usize,
        /// Unit normal of the plane.
        normal: Vector3,
    },
}

/// One constraint: its value, and its gradient with respect to the translations of nodes in their own axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Violation, m.
    pub violation: f64,
    /// Nodes with their gradients.
    pub gradient: Vec<(usize, Vector3)>,
}

impl Joint {
    /// The rows of the joint at a configuration of the nodes at `positions`.
    pub fn rows(&self, motions: &[Motion], positions: &[Vector3]) -> Vec<Row> {
        let row = |direction: Vector3, sides: &[(usize, f64)]| {
            let at = |node: usize| motions[node].apply(&positions[node]);
            let start = |node: usize| positions[node];
            let violation = |&(node, sign): &(usize, f64)| sign * dot(&direction, &at(node));
            let initially = |&(node, sign): &(usize, f64)| sign * dot(&direction, &start(node));
            // d x = R dV: the row of the node's own axes is directionᵀR.
            let own = |&(node, sign): &(usize, f64)| {
                (node, transposed_times_3(&motions[node].rotation, &direction).map(|g| sign * g))
            };
            Row {
                violation: sides.iter().map(violation).sum::<f64>() - sides.iter().map(initially).sum::<f64>(),
                gradient: sides.iter().map(own).collect(),
            }
        };
        match *self {
            Self::PlanarPin([a, b]) => {
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|direction| row(direction, &[(a, 1.0), (b, -1.0)])).to_vec()
            }
            Self::PointOnPlane { node, normal } => vec![row(normal, &[(node, 1.0)])],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_the_gradients_of_the_violation() {
        let positions = [[1.0, 2.0, 0.0], [1.0, 2.0, 0.0]];
        let at = [[0.3, -0.2, 0.1, 0.2, 0.5, -0.4], [-0.1, 0.4, 0.2, -0.3, 0.1, 0.6]].map(|v| Motion::exp(&v));
        let (joints, size) =
            ([Joint::PlanarPin([0, 1]), Joint::PointOnPlane { node: 1, normal: [0.0, 1.0, 0.0] }], 1e-6);
        for joint in joints {
            for (number, row) in joint.rows(&at, &positions).iter().enumerate() {
                for (node, gradient) in &row.gradient {
                    for (d, expected) in gradient.iter().enumerate() {
                        // A step of the node along its own axis d, which turns nothing.
                        let violation = |step: f64| {
                            let mut increment = [0.0; 6];
                            increment[d] = step;
                            let mut moved = at;
                            moved[*node] = at[*node].compose(&Motion::exp(&increment));
                            joint.rows(&moved, &positions)[number].violation
                        };
                        let slope = (violation(size) - violation(-size)) / (2.0 * size);
                        // Linear in the step: rounding of positions of order one over the step.
                        assert!((slope - expected).abs() < 1e-9, "{joint:?}: {slope} for {expected}");
                    }
                }
            }
        }
        // At the start nothing is violated, wherever the nodes are.
        let rest = [Motion::IDENTITY; 2];
        assert!(joints.iter().flat_map(|joint| joint.rows(&rest, &positions)).all(|row| row.violation == 0.0));
    }
}
