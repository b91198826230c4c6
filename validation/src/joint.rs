//! Joints between two nodes, or a node and the ground: constraints at position level, enforced by Lagrange multipliers.
//!
//! ```text
//! gap      g = (R_c n)ᵀ (x_a − x_b)   the joint's point, as it moves with sides a and b, along a direction n that turns with c
//! square   g = (R_a p)ᵀ (R_b q)       two directions that were perpendicular at the start
//! ```
//! | joint | rows |
//! |---|---|
//! | spherical | three gaps in inertial axes |
//! | revolute | those, and the axis of a square to two directions across it of b |
//! | clamp | the three gaps, and the squares of all axes |
//! | prescribed rotation | those of a clamp, with b's axes turned by the angle at the time |
//! | prismatic | the gaps across the axis, which turns with b, and the squares of all axes |
//! | point on a plane | the gap along the normal, which turns with b |
//!
//! Gradients are those of the node's own increments (Rᵀδx; δθ), so that a multiplier is a force (N) or a moment (N m).
//! Supports that hold a node's own directions (clamp, spherical joint on the ground, motion in a plane, prescribed
//! rotation) need no multiplier: those coordinates are not free, see [`Support`]. Rows that supports keep already, those of
//! a revolute joint between nodes held in the plane across its axis, take no part.

use supel_runtime::motion::{
    IDENTITY_3, Matrix3, Motion, Vector3, Vector6, cross, dot, join, times_3, transposed_times_3,
};

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

/// What a joint takes hold of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// It does not move.
    Ground,
    /// A node of the mechanism.
    Node(usize),
}

/// What a joint holds; axes are in inertial axes at the start and may have any length.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// The point, in all directions.
    Spherical,
    /// The point and all turns but those about the axis.
    Revolute {
        /// Axis of the turns.
        axis: Vector3,
    },
    /// All turns, and the point but along the axis, which turns with the second side.
    Prismatic {
        /// Axis of the slide.
        axis: Vector3,
    },
    /// The point and all turns.
    Clamp,
    /// The point and all turns; the first side has turned against the second by an angle that is prescribed.
    PrescribedRotation {
        /// Axis of the turn.
        axis: Vector3,
        /// Angle over time, rad; zero at the start, and smooth from a step before it.
        angle: fn(f64) -> f64,
    },
    /// The point in a plane that turns with the second side; in a planar mechanism the massless slider with its pin.
    PointOnPlane {
        /// Normal of the plane.
        normal: Vector3,
    },
}

/// A joint between two sides, in inertial axes.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// What it holds.
    pub kind: Kind,
    /// The side that moves and the one that carries the axis or the plane; a joint does not tell them apart otherwise.
    pub sides: [Side; 2],
    /// Where it is at the start: the material point of both sides.
    pub point: Vector3,
}

/// One constraint: its value, and its gradient with respect to the increments of nodes in their own axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Violation: m, or the sine of an angle.
    pub violation: f64,
    /// Nodes with their gradients, translations first.
    pub gradient: Vec<(usize, Vector6)>,
}

impl Joint {
    /// The rows of the joint at a time and a configuration of the nodes at `positions`; nothing is violated at the start.
    ///
    /// # Panics
    /// If an axis is zero.
    pub fn rows(&self, time: f64, motions: &[Motion], positions: &[Vector3]) -> Vec<Row> {
        let [a, b] = self.sides.map(|side| Grip::new(side, &self.point, motions, positions));
        let gaps = || IDENTITY_3.map(|direction| gap([&a, &b], &direction, &Grip::ground(&self.point)));
        let square = |own: &Vector3, other: &Vector3| square([&a, &b], [own, other]);
        let turned_squares = |[x, y, z]: [Vector3; 3], turn: &Matrix3| {
            [(x, y), (y, z), (z, x)].map(|(own, other)| square(&own, &times_3(turn, &other)))
        };
        let squares = |axes: [Vector3; 3]| turned_squares(axes, &IDENTITY_3);
        match &self.kind {
            Kind::Spherical => gaps().into(),
            Kind::Revolute { axis } => {
                let [axis, p, q] = axes(axis);
                gaps().into_iter().chain([square(&axis, &p), square(&axis, &q)]).collect()
            }
            Kind::Prismatic { axis } => {
                let axes = axes(axis);
                let across = [axes[1], axes[2]].map(|direction| gap([&a, &b], &direction, &b));
                across.into_iter().chain(squares(axes)).collect()
            }
            Kind::Clamp => gaps().into_iter().chain(squares(IDENTITY_3)).collect(),
            Kind::PrescribedRotation { axis, angle } => {
                let axes = axes(axis);
                let turn = Motion::exp(&join(&[0.0; 3], &axes[0].map(|x| angle(time) * x))).rotation;
                gaps().into_iter().chain(turned_squares(axes, &turn)).collect()
            }
            Kind::PointOnPlane { normal } => vec![gap([&a, &b], &axes(normal)[0], &b)],
        }
    }
}

/// A side of a joint at a configuration.
struct Grip {
    side: Side,
    motion: Motion,
    /// Where the joint's point is that moves with this side.
    place: Vector3,
    /// From the node to the joint's point, in the node's own axes.
    lever: Vector3,
}

impl Grip {
    fn new(side: Side, point: &Vector3, motions: &[Motion], positions: &[Vector3]) -> Self {
        let Side::Node(node) = side else { return Self::ground(point) };
        let motion = motions[node];
        Self { side, motion, place: motion.apply(point), lever: minus(point, &positions[node]) }
    }

    fn ground(point: &Vector3) -> Self {
        Self { side: Side::Ground, motion: Motion::IDENTITY, place: *point, lever: [0.0; 3] }
    }

    /// A spatial direction in the side's own axes.
    fn own(&self, direction: &Vector3) -> Vector3 {
        transposed_times_3(&self.motion.rotation, direction)
    }

    /// A row's gradient with respect to this side, of a force and a moment about the joint's point in its own axes.
    fn gradient(&self, force: Vector3, moment: Vector3) -> Option<(usize, Vector6)> {
        let Side::Node(node) = self.side else { return None };
        let of_lever = cross(&self.lever, &force);
        Some((node, join(&force, &std::array::from_fn(|d| of_lever[d] + moment[d]))))
    }
}

/// The distance of the joint's points along a direction that turns with a side.
fn gap([a, b]: [&Grip; 2], direction: &Vector3, carrier: &Grip) -> Row {
    let along = times_3(&carrier.motion.rotation, direction);
    let apart = minus(&a.place, &b.place);
    let [on_a, on_b] = [a, b].map(|side| side.own(&along));
    // δ(R n) = R (δθ × n).
    let turning = if carrier.side == b.side { cross(direction, &b.own(&apart)) } else { [0.0; 3] };
    let gradient = [a.gradient(on_a, [0.0; 3]), b.gradient(on_b.map(|f| -f), turning)];
    Row { violation: dot(&along, &apart), gradient: gradient.into_iter().flatten().collect() }
}

/// The cosine between a direction that turns with each side.
fn square([a, b]: [&Grip; 2], [p, q]: [&Vector3; 2]) -> Row {
    let (along_p, along_q) = (times_3(&a.motion.rotation, p), times_3(&b.motion.rotation, q));
    let gradient = [a.gradient([0.0; 3], cross(p, &a.own(&along_q))), b.gradient([0.0; 3], cross(q, &b.own(&along_p)))];
    Row { violation: dot(&along_p, &along_q), gradient: gradient.into_iter().flatten().collect() }
}

/// Unit vectors along and across an axis; exact ones of a coordinate axis.
fn axes(along: &Vector3) -> [Vector3; 3] {
    let unit = |v: &Vector3| {
        let length = dot(v, v).sqrt();
        assert!(length > 0.0, "a joint's axis {v:?} has no direction");
        v.map(|x| x / length)
    };
    let along = unit(along);
    let smallest = (0..3).fold(0, |best, d| if along[d].abs() < along[best].abs() { d } else { best });
    let across = unit(&cross(&along, &IDENTITY_3[smallest]));
    [along, across, cross(&along, &across)]
}

fn minus(x: &Vector3, y: &Vector3) -> Vector3 {
    std::array::from_fn(|d| x[d] - y[d])
}

#[cfg(test)]
mod tests {
    use supel_runtime::motion::velocity_to_origin;

    use super::*;

    const AXIS: Vector3 = [0.3, -0.8, 0.5];
    const POSITIONS: [Vector3; 2] = [[1.0, 2.0, 0.0], [-0.5, 1.0, 0.7]];

    fn joints() -> impl Iterator<Item = Joint> {
        let kinds = [
            Kind::Spherical,
            Kind::Revolute { axis: AXIS },
            Kind::Prismatic { axis: AXIS },
            Kind::Clamp,
            Kind::PointOnPlane { normal: AXIS },
            Kind::PrescribedRotation { axis: AXIS, angle: |time| time },
        ];
        let [a, b] = [Side::Node(0), Side::Node(1)];
        let sides = [[a, b], [b, a], [a, Side::Ground], [Side::Ground, b]];
        kinds.into_iter().flat_map(move |kind| sides.map(|sides| Joint { kind, sides, point: [0.4, -0.3, 1.1] }))
    }

    fn moved(motions: &[Motion; 2], node: usize, own: &Vector6) -> [Motion; 2] {
        let mut moved = *motions;
        moved[node] = motions[node].compose(&Motion::exp(&velocity_to_origin(&POSITIONS[node], own)));
        moved
    }

    #[test]
    fn rows_are_the_gradients_of_the_violation() {
        let at = [[0.3, -0.2, 0.1, 0.2, 0.5, -0.4], [-0.1, 0.4, 0.2, -0.3, 0.1, 0.6]].map(|v| Motion::exp(&v));
        let size = 1e-5;
        for joint in joints() {
            for (number, row) in joint.rows(0.7, &at, &POSITIONS).iter().enumerate() {
                for (node, d) in [0, 1].into_iter().flat_map(|node| (0..6).map(move |d| (node, d))) {
                    // A step of the node along or about its own axis d.
                    let violation = |step: f64| {
                        let mut increment = [0.0; 6];
                        increment[d] = step;
                        joint.rows(0.7, &moved(&at, node, &increment), &POSITIONS)[number].violation
                    };
                    let slope = (violation(size) - violation(-size)) / (2.0 * size);
                    let of_node = row.gradient.iter().find(|entry| entry.0 == node);
                    let expected = of_node.map_or(0.0, |(_, gradient)| gradient[d]);
                    // Third derivatives of order one times size²/6, and rounding of 1e-15 over the step.
                    assert!((slope - expected).abs() < 1e-9, "{joint:?} {number}: {slope} for {expected}");
                }
            }
        }
    }

    #[test]
    fn joints_allow_what_they_are_named_for() {
        let rest = [Motion::IDENTITY; 2];
        let counts = [3, 5, 5, 6, 1, 6].into_iter().flat_map(|n| [n; 4]);
        for (joint, n_rows) in joints().zip(counts) {
            let violations_at = |time: f64, motions: &[Motion; 2]| -> Vec<f64> {
                joint.rows(time, motions, &POSITIONS).iter().map(|row| row.violation.abs()).collect()
            };
            let violations = |motions: &[Motion; 2]| violations_at(0.0, motions);
            let start = violations(&rest);
            assert_eq!(start.len(), n_rows, "{joint:?}");
            let nodes = joint.sides.map(|side| if let Side::Node(node) = side { Some(node) } else { None });
            let node = nodes[0].or(nodes[1]).expect("a node");
            let unit = axes(&AXIS)[0];
            let about = |turn: Vector3| join(&cross(&joint.point, &turn), &turn);
            let slide = join(&unit, &[0.0; 3]);
            let across = join(&axes(&AXIS)[1], &[0.0; 3]);
            let turns = [about(unit), about([0.4, 0.1, 0.9])];
            // Along the axis, across it; about it through the point, about another direction.
            let allowed = match joint.kind {
                Kind::Spherical => [false, false, true, true],
                Kind::Revolute { .. } => [false, false, true, false],
                Kind::Prismatic { .. } => [true, false, false, false],
                Kind::Clamp | Kind::PrescribedRotation { .. } => [false; 4],
                Kind::PointOnPlane { .. } => [false, true, true, true],
            };
            for (motion, allowed) in [slide, across, turns[0], turns[1]].iter().zip(allowed) {
                // The plane and the slide's axis turn with the second side and hold no matter which side moves.
                let mut motions = rest;
                motions[node] = Motion::exp(motion);
                let worst = violations(&motions).into_iter().fold(0.0, f64::max);
                // Rounding of positions and levers of order one, or an order-one motion that is not allowed.
                assert!(if allowed { worst < 1e-14 } else { worst > 0.1 }, "{joint:?} {motion:?}: {worst}");
            }
            assert!(start.iter().all(|violation| *violation < 1e-15), "{joint:?}: {start:?}");
            if let Kind::PrescribedRotation { .. } = joint.kind {
                // By the angle of the time, one way round for the first side and the other for the second.
                let angle = if nodes[0].is_some() { 1.0 } else { -1.0 };
                let turned = |angle: f64| [Motion::exp(&about(unit.map(|x| angle * x))), rest[1]];
                let turned = if node == 0 { turned(angle) } else { [rest[0], turned(angle)[0]] };
                assert!(violations_at(1.0, &turned).iter().all(|violation| *violation < 1e-15), "{joint:?}");
            }
        }
    }
}
