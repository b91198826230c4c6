//! Springs of stiffness k and tension N between points that nodes carry on rigid arms.
//!
//! ```text
//! W(u) = Σ N (l − L) + ½ k (l − L)²        l the distance of two points, L that in the preloaded state
//! point   x + u + exp(θ) a                 of a node at x with the arm a; a = 0 without rotations
//! ```
//! q is the derivative of W and K the second one, both in closed form; `energy` is W itself, with finite rotations.

use std::array::from_fn;

use supel_models::model::cross;
use supel_models::{Assembler, Inertia, Material, Model, Section, SplitMix64, frame};

type Vector = [f64; 3];

/// One spring: nodes, arms, stiffness, tension.
pub(crate) struct Spring {
    nodes: [usize; 2],
    arms: [Vector; 2],
    stiffness: f64,
    tension: f64,
}

pub(crate) struct Network {
    pub(crate) model: Model,
    /// q.
    pub(crate) forces: Vec<f64>,
    pub(crate) springs: Vec<Spring>,
    pub(crate) n_directions: usize,
}

/// What nodes have.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Nodes {
    /// Displacements.
    Points,
    /// Displacements and rotations, which arms tie to the springs.
    Bodies,
}

/// Stiffness of all springs, N/m, up to a factor of two.
const STIFFNESS: f64 = 1e6;

/// Twelve nodes in three storeys, each tied to all that are near; `strain` is the mean tension over stiffness and length.
pub(crate) fn tower(nodes: Nodes, strain: f64) -> Network {
    let mut random = SplitMix64::new(7);
    let at = tower_nodes();
    let mut springs = Vec::new();
    for i in 0..at.len() {
        for j in i + 1..at.len() {
            // Points take three springs to be held, bodies six.
            let n_springs = if nodes == Nodes::Bodies { 2 } else { 1 };
            for _ in 0..if length(minus(at[i], at[j])) < 1.9 { n_springs } else { 0 } {
                let stiffness = STIFFNESS * (1.0 + random.uniform());
                let mut arm = || from_fn(|_| if nodes == Nodes::Bodies { 0.4 * random.uniform() - 0.2 } else { 0.0 });
                let arms = [arm(), arm()];
                let tension = strain * stiffness * (0.5 + random.uniform());
                springs.push(Spring { nodes: [i, j], arms, stiffness, tension });
            }
        }
    }
    Network::of(at, nodes, springs)
}

/// Points anywhere in a cube, each pair tied by a spring, of which those along x have tension and the others hardly any: rotation about x costs
/// much less than about y and z.
pub(crate) fn cloud(n_points: usize, seed: u64, strain: f64) -> Network {
    let mut random = SplitMix64::new(seed);
    let at: Vec<Vector> = (0..n_points).map(|_| from_fn(|_| random.uniform())).collect();
    let pairs = (0..n_points).flat_map(|i| (i + 1..n_points).map(move |j| [i, j]));
    let spring = |nodes: [usize; 2]| {
        let way = minus(at[nodes[1]], at[nodes[0]]);
        let stiffness = STIFFNESS * (1.0 + random.uniform()) / length(way);
        let tension = strain * stiffness * length(way) * (way[0] / length(way)).powi(8) * random.uniform();
        Spring { nodes, arms: [[0.0; 3]; 2], stiffness, tension }
    };
    let springs = pairs.map(spring).collect();
    Network::of(at, Nodes::Points, springs)
}

/// The tower without tension but for a tie between the first node and the last.
pub(crate) fn tied_tower(nodes: Nodes, strain: f64) -> Network {
    let mut springs = tower(nodes, 0.0).springs;
    let ends = [0, tower_nodes().len() - 1];
    springs.push(Spring { nodes: ends, arms: [[0.0; 3]; 2], stiffness: STIFFNESS, tension: strain * STIFFNESS });
    Network::of(tower_nodes(), nodes, springs)
}

/// The tower with a bolt between its fifth node and the last, of this tension over the stiffness of a spring.
pub(crate) fn bolted_tower(nodes: Nodes, strain: f64, bolt: f64) -> Network {
    let mut springs = tower(nodes, strain).springs;
    springs.push(Spring { nodes: [4, 11], arms: [[0.0; 3]; 2], stiffness: STIFFNESS, tension: bolt * STIFFNESS });
    Network::of(tower_nodes(), nodes, springs)
}

/// The tower without tension but for a strut through a point halfway between two nodes, the last node of the network: under
/// compression that point has no stiffness of its own across the strut but a negative one.
pub(crate) fn strutted_tower(compression: f64) -> Network {
    let mut springs = tower(Nodes::Points, 0.0).springs;
    let mut at = tower_nodes();
    at.push(from_fn(|i| 0.5 * (at[8][i] + at[11][i])));
    let strut =
        |end| Spring { nodes: [end, 12], arms: [[0.0; 3]; 2], stiffness: STIFFNESS, tension: -compression * STIFFNESS };
    springs.extend([8, 11].map(strut));
    Network::of(at, Nodes::Points, springs)
}

/// Bars between nine nodes, a thousand times as stiff along themselves as across, and two ties under a tension of this times their stiffness.
pub(crate) fn tied_frame(strain: f64) -> Network {
    const NODES: [Vector; 9] = [
        [0.0, 0.0, 0.0],
        [0.5, 0.0, 0.05],
        [1.0, 0.1, 0.0],
        [1.5, 0.1, 0.2],
        [0.5, 0.5, 0.0],
        [1.0, 0.6, 0.1],
        [1.5, 0.5, 0.0],
        [2.0, 0.3, 0.1],
        [1.0, 0.3, 0.6],
    ];
    const BARS: [[usize; 2]; 12] =
        [[0, 1], [1, 2], [2, 3], [1, 4], [4, 5], [5, 6], [2, 5], [3, 7], [6, 7], [2, 8], [5, 8], [4, 0]];
    let tie = |nodes| Spring { nodes, arms: [[0.0; 3]; 2], stiffness: STIFFNESS, tension: strain * STIFFNESS };
    let ties = Network::of(NODES.to_vec(), Nodes::Bodies, [[3, 6], [4, 8]].map(tie).into());
    let bars = frame(&NODES, &BARS, &Section::round(0.0125), &Material::STEEL_SI, Inertia::Consistent);
    let mut stiffness = Assembler::default();
    stiffness.extend(ties.model.stiffness.iter().chain(&bars.stiffness).copied());
    Network { model: Model { stiffness: stiffness.finish(), ..bars }, ..ties }
}

fn tower_nodes() -> Vec<Vector> {
    let node = |i: usize| [(i % 2) as f64, 0.8 * (i / 2 % 2) as f64 + 0.1 * (i % 3) as f64, 0.9 * (i / 4) as f64];
    (0..12).map(node).collect()
}

impl Network {
    fn of(at: Vec<Vector>, nodes: Nodes, springs: Vec<Spring>) -> Self {
        let n_directions = if nodes == Nodes::Bodies { 6 } else { 3 };
        let n = n_directions * at.len();
        let (mut stiffness, mut mass, mut forces) = (Assembler::default(), Assembler::default(), vec![0.0; n]);
        for spring in &springs {
            let [a, b] = from_fn(|end| plus(at[spring.nodes[end]], spring.arms[end]));
            let (l, n) = (length(minus(b, a)), minus(b, a).map(|x| x / length(minus(b, a))));
            // Rows of B: the change of b − a by each dof of the two nodes.
            let dofs: Vec<usize> =
                spring.nodes.iter().flat_map(|node| (0..n_directions).map(move |d| n_directions * node + d)).collect();
            let change: Vec<Vector> = dofs.iter().enumerate().map(|(at, _)| spring.change(at, n_directions)).collect();
            let block = |i: usize, j: usize| {
                let along = dot(change[i], n) * dot(change[j], n);
                let of_length = spring.stiffness * along + spring.tension / l * (dot(change[i], change[j]) - along);
                of_length + spring.of_arms(i, j, (n, n_directions))
            };
            for i in 0..dofs.len() {
                forces[dofs[i]] += spring.tension * dot(change[i], n);
                (0..dofs.len()).for_each(|j| stiffness.add(dofs[i] as u32, dofs[j] as u32, block(i, j)));
            }
        }
        for dof in 0..n as u32 {
            mass.add(dof, dof, if dof as usize % n_directions < 3 { 2.0 } else { 0.05 + 0.01 * f64::from(dof % 6) });
        }
        let directions: Vec<u8> = (0..n_directions as u8).collect();
        Self { model: Model::node_major(at, &directions, stiffness, mass), forces, springs, n_directions }
    }

    /// W at some displacements and rotation vectors.
    pub(crate) fn energy(&self, u: &[f64]) -> f64 {
        let of_spring = |spring: &Spring| {
            let [a, b] = from_fn(|end| {
                let node = spring.nodes[end];
                let of = |first: usize| from_fn(|i| u[self.n_directions * node + first + i]);
                let arm = if self.n_directions == 6 { rotated(of(3), spring.arms[end]) } else { spring.arms[end] };
                plus(plus(self.model.nodes[node], of(0)), arm)
            });
            let [a_0, b_0] = from_fn(|end| plus(self.model.nodes[spring.nodes[end]], spring.arms[end]));
            let elongation = length(minus(b, a)) - length(minus(b_0, a_0));
            spring.tension * elongation + 0.5 * spring.stiffness * elongation * elongation
        };
        self.springs.iter().map(of_spring).sum()
    }
}

impl Spring {
    /// How b − a changes by the dof of this number.
    fn change(&self, at: usize, n_directions: usize) -> Vector {
        let (end, direction) = (at / n_directions, at % n_directions);
        let unit = from_fn(|i| f64::from(u8::from(i == direction % 3)));
        let of_point = if direction < 3 { unit } else { cross(unit, self.arms[end]) };
        of_point.map(|x| if end == 0 { -x } else { x })
    }

    /// What turning arms to second order, ½ θ × (θ × a), makes of the tension: ½ (a fᵀ + f aᵀ) − a·f for the force f at the point.
    fn of_arms(&self, i: usize, j: usize, (n, n_directions): (Vector, usize)) -> f64 {
        let ([end, other], [a, b]) = ([i, j].map(|at| at / n_directions), [i, j].map(|at| at % n_directions));
        if end != other || a < 3 || b < 3 {
            return 0.0;
        }
        let (arm, f) = (self.arms[end], n.map(|x| if end == 0 { -self.tension * x } else { self.tension * x }));
        let (a, b) = (a - 3, b - 3);
        0.5 * (arm[a] * f[b] + f[a] * arm[b]) - if a == b { dot(arm, f) } else { 0.0 }
    }
}

/// exp(θ) a, by Rodrigues.
pub(crate) fn rotated(theta: Vector, a: Vector) -> Vector {
    let angle = length(theta);
    if angle == 0.0 {
        return a;
    }
    let axis = theta.map(|x| x / angle);
    let (across, twice) = (cross(axis, a), cross(axis, cross(axis, a)));
    from_fn(|i| a[i] + angle.sin() * across[i] + (1.0 - angle.cos()) * twice[i])
}

fn plus(a: Vector, b: Vector) -> Vector {
    from_fn(|i| a[i] + b[i])
}

fn minus(a: Vector, b: Vector) -> Vector {
    from_fn(|i| a[i] - b[i])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}
