//! The mechanism: its nodes, supports, joints and loads, and the sums over its components.

use faer::Mat;
use supel_runtime::Superelement;
use supel_runtime::component::{DeadLoad, RecoveredNode};
use supel_runtime::motion::{Motion, Vector3, velocity_to_origin};

use super::body::{Body, Formulation};
use super::configuration::Configuration;
use super::forces::{Forces, Matrices};
use crate::Result;
use crate::joint::{Joint, Row, Support, Supports};

/// A dead load on a node of the mechanism, times a function of time.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// Node of the mechanism, force (N) and moment (N m) in inertial axes.
    pub unit: DeadLoad,
    /// The factor at a time, s.
    pub history: fn(f64) -> f64,
}

impl Load {
    /// A force on a node.
    pub fn force(node: usize, force: Vector3, history: fn(f64) -> f64) -> Self {
        Self { unit: DeadLoad { node, force, moment: [0.0; 3] }, history }
    }

    /// A moment on a node.
    pub fn moment(node: usize, moment: Vector3, history: fn(f64) -> f64) -> Self {
        Self { unit: DeadLoad { node, force: [0.0; 3], moment }, history }
    }
}

/// A node's coordinates here are those of the point at the node, which has no lever.
const NO_LEVER: Vector3 = [0.0; 3];

/// A mechanism of modal components.
#[derive(Debug)]
pub struct System {
    /// First position of each node.
    pub positions: Vec<Vector3>,
    bodies: Vec<Body>,
    /// What becomes of each coordinate.
    pub supports: Vec<Support>,
    /// Joints with multipliers.
    pub joints: Vec<Joint>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Acceleration of gravity, in inertial axes.
    pub gravity: Vector3,
    /// Velocities at the start, which the joints allow.
    pub initial_velocity: Vec<f64>,
}

impl System {
    /// A mechanism at rest of components, each with the nodes of the mechanism that its interface nodes are.
    ///
    /// # Errors
    /// A superelement that the component refuses; a node that is not where the interface node is.
    pub fn new(
        positions: Vec<Vector3>,
        supports: &[Supports],
        parts: &[(&Superelement, &[usize])],
        formulation: Formulation,
    ) -> Result<Self> {
        let mut first_amplitude = 6 * positions.len();
        let mut bodies = Vec::new();
        for &(superelement, nodes) in parts {
            let body = Body::new(superelement, nodes, &positions, first_amplitude, formulation)?;
            first_amplitude += superelement.n_modal();
            bodies.push(body);
        }
        let mut supports = supports.concat();
        supports.resize(first_amplitude, Support::Free);
        let initial_velocity = vec![0.0; supports.len()];
        Ok(Self {
            positions,
            bodies,
            supports,
            joints: Vec::new(),
            loads: Vec::new(),
            gravity: [0.0; 3],
            initial_velocity,
        })
    }

    /// Number of coordinates.
    pub fn n(&self) -> usize {
        self.supports.len()
    }

    /// Numbers of the coordinates that are free to move.
    pub fn free(&self) -> Vec<usize> {
        (0..self.n()).filter(|i| matches!(self.supports[*i], Support::Free)).collect()
    }

    /// No node has moved.
    pub fn initial(&self) -> Configuration {
        let n_nodes = self.positions.len();
        Configuration { motions: vec![Motion::IDENTITY; n_nodes], amplitudes: vec![0.0; self.n() - 6 * n_nodes] }
    }

    /// The configuration after an increment of all coordinates from another one.
    pub fn moved(&self, from: &Configuration, increment: &[f64]) -> Configuration {
        let n_nodes = self.positions.len();
        let node = |j: usize| {
            let at_node = std::array::from_fn(|i| increment[6 * j + i]);
            from.motions[j].compose(&Motion::exp(&velocity_to_origin(&self.positions[j], &at_node)))
        };
        let amplitudes = from.amplitudes.iter().zip(&increment[6 * n_nodes..]).map(|(eta, step)| eta + step);
        Configuration { motions: (0..n_nodes).map(node).collect(), amplitudes: amplitudes.collect() }
    }

    /// Where a node is.
    pub fn position(&self, at: &Configuration, node: usize) -> Vector3 {
        at.motions[node].apply(&self.positions[node])
    }

    /// Forces at a time, configuration, velocity and acceleration.
    ///
    /// # Errors
    /// A deformation that the component cannot express.
    pub fn forces(&mut self, time: f64, at: &Configuration, velocity: &[f64], acceleration: &[f64]) -> Result<Forces> {
        let n = self.n();
        let applied = self.loaded(at, time);
        let mut forces = Forces { elastic: vec![0.0; n], inertial: vec![0.0; n], damping: vec![0.0; n], applied };
        for body in &mut self.bodies {
            body.place(at, velocity, acceleration)?;
            body.evaluate()?;
            body.add_forces(&self.gravity, &mut forces)?;
        }
        Ok(forces)
    }

    /// Tangent matrices at a configuration, velocity and acceleration.
    ///
    /// # Errors
    /// As [`Self::forces`].
    pub fn matrices(&mut self, at: &Configuration, velocity: &[f64], acceleration: &[f64]) -> Result<Matrices> {
        let mut matrices = Matrices::zeros(self.n());
        for body in &mut self.bodies {
            body.place(at, velocity, acceleration)?;
            body.tangents()?;
            body.add_matrices(&mut matrices)?;
        }
        Ok(matrices)
    }

    /// Tangent matrices at a configuration, at rest.
    ///
    /// # Errors
    /// As [`Self::forces`].
    pub fn matrices_at_rest(&mut self, at: &Configuration) -> Result<Matrices> {
        let rest = vec![0.0; self.n()];
        self.matrices(at, &rest, &rest)
    }

    /// Kinetic, strain and potential energy in gravity in the state last evaluated; the last is zero with all mass at the
    /// inertial origin.
    ///
    /// # Errors
    /// A superelement whose loads of gravity are the weight of no body.
    pub fn energies(&self) -> Result<[f64; 3]> {
        let mut sum = [0.0; 3];
        for body in &self.bodies {
            let own = body.energies(&self.gravity)?;
            sum = std::array::from_fn(|i| sum[i] + own[i]);
        }
        Ok(sum)
    }

    /// Power that the damping of all components takes in the state last evaluated, W.
    pub fn dissipated_power(&self) -> f64 {
        self.bodies.iter().map(Body::dissipated_power).sum()
    }

    /// Displacements of the nodes inside a body that its superelement recovers, and the body's floating frame, in the state
    /// last evaluated; `positions` are those of the nodes at the start.
    ///
    /// # Errors
    /// The superelement recovers other nodes than those at `positions`.
    pub fn interior(&self, body: usize, positions: &[Vector3]) -> Result<(Vec<RecoveredNode>, Motion)> {
        let body = &self.bodies[body];
        Ok((body.recovered(positions)?, *body.floating_frame()))
    }

    /// Loads at a time, without gravity.
    fn loaded(&self, at: &Configuration, time: f64) -> Vec<f64> {
        let mut applied = vec![0.0; self.n()];
        for load in &self.loads {
            let (node, factor) = (load.unit.node, (load.history)(time));
            let unit = load.unit.in_node(&at.motions[node], &NO_LEVER);
            applied[6 * node..6 * node + 6].iter_mut().zip(unit).for_each(|(sum, value)| *sum += factor * value);
        }
        applied
    }

    /// Adds the stiffness of the loads, which turn in the axes of their nodes.
    pub fn add_load_stiffness(&self, at: &Configuration, time: f64, stiffness: &mut Mat<f64>) {
        for load in &self.loads {
            let (first, factor) = (6 * load.unit.node, (load.history)(time));
            let unit = load.unit.stiffness_in_node(&at.motions[load.unit.node], &NO_LEVER);
            for (i, row) in unit.iter().enumerate() {
                row.iter().enumerate().for_each(|(j, value)| stiffness[(first + i, first + j)] += factor * value);
            }
        }
    }

    /// Rows of all joints at a time.
    pub fn constraints(&self, time: f64, at: &Configuration) -> Vec<Row> {
        self.joints.iter().flat_map(|joint| joint.rows(time, &at.motions, &self.positions)).collect()
    }
}
