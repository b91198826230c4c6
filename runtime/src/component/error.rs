//! Why a superelement makes no component, and why a component cannot be evaluated.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::direction::Direction;

/// Why a superelement cannot undergo large motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ComponentError {
    /// The superelement has no interface node.
    #[error(
        "the superelement has no interface node; its motion is that of its interface nodes: reduce it with at least one"
    )]
    NoInterfaceNodes,
    /// The stiffness is the tangent of a preloaded state, which does not turn with the component.
    #[error(
        "the superelement is preloaded: its stiffness resists rotations as the preload of one direction in space does, which large motion turns; use it in linear analyses, or reduce the component without preload"
    )]
    Preloaded,
    /// The superelement has no mass.
    #[error(
        "the superelement was made for statics alone and has no mass; reduce the component for another analysis than `static`"
    )]
    NoMass,
    /// Part of the interface are bare rows. It is not known what they displace.
    #[error(
        "{count} interface coordinates are rows without a node; large motion needs positions and six dofs: give the nodes' coordinates and reduce again"
    )]
    InterfaceRows {
        /// How many.
        count: usize,
    },
    /// An interface node lacks translations or rotations.
    #[error(
        "interface node {node} (from 0, `{name}`) has no {}; large motion needs three translations and three rotations at each interface node: couple it by `rigid` or `average`, which give it six, and reduce again",
        list(missing)
    )]
    MissingDofs {
        /// Number of the node.
        node: usize,
        /// Its name.
        name: String,
        /// What it lacks.
        missing: Vec<Direction>,
    },
    /// The superelement has more motions without deformation than a body has.
    #[error(
        "the superelement has {found} rigid-body modes, expected 6: its parts move against each other; make a component of each"
    )]
    Mechanism {
        /// Number of rigid-body modes.
        found: usize,
    },
    /// The stiffness resists rigid-body motion.
    #[error(
        "a rigid-body {motion} of the component makes forces: {residual:.1e} of those its parts make, at most {limit:.0e} expected; reduce the component unconstrained and fix its interface nodes in the simulation"
    )]
    NotFree {
        /// `translation along x`, …
        motion: &'static str,
        /// Largest force relative to the sum of the magnitudes of its parts.
        residual: f64,
        /// What is allowed.
        limit: f64,
    },
    /// The component is so far from the origin that its own inertia is lost in that about the origin.
    #[error(
        "the centre of mass is {distance:.1e} from the origin, where the radius of gyration {radius:.1e} of the component is lost in rounding, at most {limit:.0e} times the radius expected; place the model near the origin, or choose the rigid floating frame"
    )]
    FarFromOrigin {
        /// Distance of the centre of mass from the origin.
        distance: f64,
        /// Radius of gyration about the centre of mass, of the axis that suffers most.
        radius: f64,
        /// What is allowed.
        limit: f64,
    },
    /// The mass does not determine the floating frame: some rigid-body motions have no inertia of their own.
    #[error(
        "the mass of the component does not resist each rigid-body motion, or too far from the origin for rounding to tell, so that a mass-weighted floating frame is undefined; place the model near the origin, or choose the rigid floating frame"
    )]
    MasslessMotion,
}

/// Why a component could not be evaluated in a given state. The component itself is unharmed; the results in the workspace
/// are those of no state until the next evaluation succeeds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// An argument has the wrong length.
    #[error(
        "found {found} {what}, expected {expected}, as the component has; give the arrays and the workspace of this component"
    )]
    WrongLength {
        /// What the argument is.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it needs.
        expected: usize,
    },
    /// An argument is infinite or not a number.
    #[error(
        "entry {index} (from 0) of the {what} is infinite or not a number, expected a finite value; has the integration diverged? take a smaller step"
    )]
    NotFinite {
        /// What the argument is.
        what: &'static str,
        /// Number of its entry.
        index: usize,
    },
    /// The workspace was made by another component, of whatever size.
    #[error(
        "the workspace was made by another component; evaluate each component in workspaces that it has made itself"
    )]
    ForeignWorkspace,
    /// No state has been evaluated, or the last evaluation failed.
    #[error("the last evaluation in the workspace failed, so that it holds no state; evaluate one first")]
    NoState,
    /// The loads of gravity in the file are not the weight of a body.
    #[error(
        "the loads of gravity in the file are not the weight of a body, the same mass along each axis at one centre, so that they have no potential; use their forces, or write the file without them"
    )]
    NoPotential,
    /// The rotation of a node is not a rotation matrix.
    #[error("the rotation of interface node {node} (from 0) is not a rotation matrix; orthonormalise it")]
    NotRotation {
        /// Number of the node.
        node: usize,
    },
    /// The floating frame given to start from is not a rigid-body motion.
    #[error(
        "the floating frame to start from is not a finite translation and a rotation matrix; orthonormalise it, or give none"
    )]
    InvalidFrame,
    /// Products of the arguments leave the range of numbers.
    #[error(
        "the {what} cannot be held in double precision: the state has values beyond any physical size; has the integration diverged? take a smaller step"
    )]
    Overflow {
        /// Which result.
        what: &'static str,
    },
    /// A node has turned by half a turn against the floating frame.
    #[error(
        "interface node {node} (from 0) has turned by half a turn against the floating frame; the component is valid for small deformation: divide it into several"
    )]
    HalfTurn {
        /// Number of the node.
        node: usize,
    },
    /// The deformation is so large that the floating frame is not determined.
    #[error(
        "the interface nodes do not determine the floating frame: a pivot of YᵀF, 1 without deformation, is below 1e-3; the deformation is too large: divide the component into several"
    )]
    FrameSingular,
    /// The floating frame was not found.
    #[error(
        "the floating frame was not found in {iterations} iterations (last correction {correction:.1e}); the deformation is too large: divide the component into several"
    )]
    FrameNotConverged {
        /// Iterations from the last start.
        iterations: usize,
        /// Largest entry of the last correction.
        correction: f64,
    },
    /// The file recovers only some of the translations of a node, or only some of its rotations.
    #[error(
        "the file recovers only some directions of node {label}; to turn them with the floating frame it needs all three translations, and all three rotations or none"
    )]
    IncompleteRecovery {
        /// Label of the node.
        label: i64,
    },
    /// A node that the file does not recover.
    #[error("node {label} is not recovered by the file; reduce it with this node among those of `write.recovery`")]
    NotRecovered {
        /// Label of the node.
        label: i64,
    },
    /// A load on a dof of which the file says that none acts.
    #[error(
        "load along {} of interface node {node} (from 0), which the superelement was told to be unloaded; reduce it without that statement",
        list(&[*direction])
    )]
    UnloadedDof {
        /// Number of the node.
        node: usize,
        /// Direction, turned with the node.
        direction: Direction,
    },
    /// Gravity along what the superelement was not made for.
    #[error(
        "gravity along ({}, {}, {}) of the model, of which the superelement was told that it does not act; reduce it for a scene with that gravity", along[0], along[1], along[2]
    )]
    GravityNotTold {
        /// The acceleration, in axes of the model.
        along: [f64; 3],
    },
    /// A load that the file does not carry.
    #[error("load {load} (from 0) of the file; it carries {n_loads}")]
    UnknownLoad {
        /// Number of the load.
        load: usize,
        /// Number of loads in the file.
        n_loads: usize,
    },
    /// A load on a node that is not there.
    #[error("load on interface node {node} (from 0); the component has {n_nodes}")]
    UnknownNode {
        /// Number of the node.
        node: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
}

fn list(directions: &[Direction]) -> String {
    directions.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
