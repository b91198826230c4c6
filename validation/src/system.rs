//! Modal components assembled into a mechanism.
//!
//! ```text
//! q   n = 6 k + Σ n_η   nodes of the mechanism, six each, then the amplitudes of each component
//! ```
//! A node's velocity is taken at the node and in its own axes, (Rᵀẋ; ω), so that "the node stays" is "the first three are
//! zero". The component takes the velocity of the point at the inertial origin (motion formalism, corrected eq. 92):
//! V = S v with S = \[I x̃₀; 0 I\] of the node's first position x₀; forces go back by Sᵀ.

use faer::Mat;
use supel_runtime::Superelement;
use supel_runtime::component::{DeadLoad, FloatingFrame, Measures, RecoveredNode};
use supel_runtime::motion::{Motion, Vector3};

use crate::Result;
use crate::body::{Body, to_origin};
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

/// Where everything is.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// Motion of each node from its first position.
    pub motions: Vec<Motion>,
    /// Amplitudes of all components.
    pub amplitudes: Vec<f64>,
}

/// Forces on all coordinates.
#[derive(Clone, Debug, Default)]
pub struct Forces {
    /// f_E (81).
    pub elastic: Vec<f64>,
    /// f_I (84).
    pub inertial: Vec<f64>,
    /// Loads and gravity.
    pub applied: Vec<f64>,
}

impl Forces {
    /// f_E + f_I − f_ext.
    pub fn residual(&self) -> Vec<f64> {
        let sums = self.elastic.iter().zip(&self.inertial).map(|(elastic, inertial)| elastic + inertial);
        sums.zip(&self.applied).map(|(sum, applied)| sum - applied).collect()
    }
}

/// Tangent matrices, n × n.
#[derive(Clone, Debug)]
pub struct Matrices {
    /// K_T (82).
    pub stiffness: Mat<f64>,
    /// M_I (86).
    pub mass: Mat<f64>,
}

/// How a component defines its floating frame and its deformation.
#[derive(Clone, Copy, Debug)]
pub struct Formulation {
    /// Y of eq. (8).
    pub frame: FloatingFrame,
    /// Motion-based or classical.
    pub measures: Measures,
}

impl System {
    /// A mechanism at rest of components, each with the nodes of the mechanism that its interface nodes are.
    ///
    /// # Errors
    /// A superelement that the component refuses.
    pub fn new(
        positions: Vec<Vector3>,
        supports: &[Supports],
        parts: &[(&Superelement, &[usize])],
        formulation: Formulation,
    ) -> Result<Self> {
        let mut first_amplitude = 6 * positions.len();
        let mut bodies = Vec::new();
        for &(superelement, nodes) in parts {
            let body = Body::new(superelement, nodes, first_amplitude, formulation)?;
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
            from.motions[j].compose(&Motion::exp(&to_origin(&self.positions[j], &increment[6 * j..6 * j + 6])))
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
        let mut forces = Forces { elastic: vec![0.0; n], inertial: vec![0.0; n], applied };
        let (positions, gravity) = (&self.positions, self.gravity);
        for body in &mut self.bodies {
            body.place(positions, at, velocity, acceleration);
            body.evaluate()?;
            body.add_forces(positions, &gravity, &mut forces);
        }
        Ok(forces)
    }

    /// K_T = Jᵀ_P K J_P and M_I at a configuration, at rest; n × n.
    ///
    /// # Errors
    /// As [`Self::forces`].
    pub fn matrices(&mut self, at: &Configuration) -> Result<Matrices> {
        let n = self.n();
        let (rest, positions) = (vec![0.0; n], &self.positions);
        let mut matrices = Matrices { stiffness: Mat::zeros(n, n), mass: Mat::zeros(n, n) };
        for body in &mut self.bodies {
            body.place(positions, at, &rest, &rest);
            body.tangents()?;
            body.add_matrices(positions, &mut matrices);
        }
        Ok(matrices)
    }

    /// Kinetic, strain and potential energy in gravity in the state last evaluated; the last is zero with all mass at the
    /// inertial origin.
    pub fn energies(&self) -> [f64; 3] {
        let of = |body: &Body| body.energies(&self.gravity);
        self.bodies.iter().map(of).fold([0.0; 3], |sum, e| std::array::from_fn(|i| sum[i] + e[i]))
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
