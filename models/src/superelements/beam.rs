//! Superelements of beams, from straight 2-node Timoshenko elements, and of random numbers.
//!
//! An element has the exact static stiffness, Φ = 12 EI/(GA l²), and the consistent mass of its shape functions with rotary
//! inertia.

use supel_runtime::motion::{Vector3, cross, dot};
use supel_runtime::{
    Coordinate, Direction, Generator, InterfaceNode, Matrix, Metadata, Method, ModelSummary, RigidBodyModes,
    Superelement, Tensors, Validity, Verdict, Verification,
};

use crate::random::SplitMix64;

/// Stiffness and mass of a cross-section; about axes 1 (along), 2, 3.
#[derive(Clone, Copy)]
pub struct Section {
    pub ea: f64,
    pub ga: f64,
    pub gj: f64,
    pub ei: [f64; 2],
    pub mass: f64,
    pub inertia: [f64; 3],
}

/// A soft section, whose frequencies and deformations are of order one.
pub const SOFT: Section =
    Section { ea: 1e4, ga: 4e3, gj: 150.0, ei: [100.0, 160.0], mass: 2.0, inertia: [0.05, 0.02, 0.03] };

/// A square matrix, row by row.
#[derive(Clone)]
pub struct Square {
    pub n: usize,
    pub data: Vec<f64>,
}

impl Square {
    pub fn zero(n: usize) -> Self {
        Self { n, data: vec![0.0; n * n] }
    }

    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.data[i * self.n + j]
    }

    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        self.data[i * self.n + j] += value;
    }

    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        self.data.chunks_exact(self.n).map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
    }

    /// Solution of A x = b by elimination with row exchanges.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let n = self.n;
        let (mut a, mut x) = (self.data.clone(), b.to_vec());
        for c in 0..n {
            let pivot = (c..n).max_by(|i, j| a[i * n + c].abs().total_cmp(&a[j * n + c].abs())).expect("a row");
            for j in 0..n {
                a.swap(c * n + j, pivot * n + j);
            }
            x.swap(c, pivot);
            for i in c + 1..n {
                let factor = a[i * n + c] / a[c * n + c];
                for j in c..n {
                    a[i * n + j] -= factor * a[c * n + j];
                }
                x[i] -= factor * x[c];
            }
        }
        for c in (0..n).rev() {
            x[c] = (x[c] - (c + 1..n).map(|j| a[c * n + j] * x[j]).sum::<f64>()) / a[c * n + c];
        }
        x
    }
}

/// Stiffness and mass of a chain of elements through `nodes`, six dofs at each.
pub fn chain(nodes: &[Vector3], section: &Section) -> (Square, Square) {
    let (mut k, mut m) = (Square::zero(6 * nodes.len()), Square::zero(6 * nodes.len()));
    for (e, ends) in nodes.windows(2).enumerate() {
        let axes = element_axes(&ends[0], &ends[1]);
        let length = dot(&difference(&ends[1], &ends[0]), &axes[0]);
        for (global, local) in [(&mut k, element_stiffness(section, length)), (&mut m, element_mass(section, length))] {
            for i in 0..12 {
                for j in 0..12 {
                    let mut value = 0.0;
                    for a in 0..3 {
                        for b in 0..3 {
                            value += axes[a][i % 3] * local[i / 3 * 3 + a][j / 3 * 3 + b] * axes[b][j % 3];
                        }
                    }
                    global.add(6 * e + i, 6 * e + j, value);
                }
            }
        }
    }
    (k, m)
}

fn difference(a: &Vector3, b: &Vector3) -> Vector3 {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Rows: along the element, and two across.
fn element_axes(start: &Vector3, end: &Vector3) -> [Vector3; 3] {
    let unit = |v: Vector3| v.map(|x| x / dot(&v, &v).sqrt());
    let along = unit(difference(end, start));
    let aside = if along[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
    let second = unit(cross(&aside, &along));
    [along, second, cross(&along, &second)]
}

/// Dofs of bending in the plane of axes 1 and 2: v, θ₃ at both ends; and of axes 1 and 3: w, −θ₂.
const PLANES: [([usize; 4], [f64; 4]); 2] =
    [([1, 5, 7, 11], [1.0, 1.0, 1.0, 1.0]), ([2, 4, 8, 10], [1.0, -1.0, 1.0, -1.0])];

fn element_stiffness(s: &Section, l: f64) -> [[f64; 12]; 12] {
    let mut k = [[0.0; 12]; 12];
    for (dof, stiffness) in [(0, s.ea / l), (3, s.gj / l)] {
        for (i, j, sign) in [(dof, dof, 1.0), (dof + 6, dof + 6, 1.0), (dof, dof + 6, -1.0), (dof + 6, dof, -1.0)] {
            k[i][j] = sign * stiffness;
        }
    }
    for ((dofs, signs), ei) in PLANES.iter().zip([s.ei[1], s.ei[0]]) {
        let phi = 12.0 * ei / (s.ga * l * l);
        let factor = ei / (l * l * l * (1.0 + phi));
        let (four, two) = ((4.0 + phi) * l * l, (2.0 - phi) * l * l);
        let block = [
            [12.0, 6.0 * l, -12.0, 6.0 * l],
            [6.0 * l, four, -6.0 * l, two],
            [-12.0, -6.0 * l, 12.0, -6.0 * l],
            [6.0 * l, two, -6.0 * l, four],
        ];
        for (i, row) in block.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                k[dofs[i]][dofs[j]] = signs[i] * signs[j] * factor * value;
            }
        }
    }
    k
}

fn element_mass(s: &Section, l: f64) -> [[f64; 12]; 12] {
    // Gauss-Legendre, four points: exact to degree seven, and products of the shapes have degree six.
    let points =
        [(0.861_136_311_594_052_6, 0.347_854_845_137_453_85), (0.339_981_043_584_856_26, 0.652_145_154_862_546_1)];
    let mut m = [[0.0; 12]; 12];
    for (x, weight) in
        points.into_iter().flat_map(|(x, w)| [(0.5 + 0.5 * x, 0.5 * w * l), (0.5 - 0.5 * x, 0.5 * w * l)])
    {
        for (dof, mass) in [(0, s.mass), (3, s.inertia[0])] {
            let shape = [1.0 - x, x];
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                m[dof + 6 * i][dof + 6 * j] += weight * mass * shape[i] * shape[j];
            }
        }
        for ((dofs, signs), (ei, inertia)) in PLANES.iter().zip([(s.ei[1], s.inertia[2]), (s.ei[0], s.inertia[1])]) {
            let phi = 12.0 * ei / (s.ga * l * l);
            let (x2, x3) = (x * x, x * x * x);
            let shift = [
                1.0 - 3.0 * x2 + 2.0 * x3 + phi * (1.0 - x),
                l * (x - 2.0 * x2 + x3 + 0.5 * phi * (x - x2)),
                3.0 * x2 - 2.0 * x3 + phi * x,
                l * (x3 - x2 + 0.5 * phi * (x2 - x)),
            ];
            let turn = [
                6.0 * (x2 - x) / l,
                1.0 - 4.0 * x + 3.0 * x2 + phi * (1.0 - x),
                6.0 * (x - x2) / l,
                3.0 * x2 - 2.0 * x + phi * x,
            ];
            let scale = weight / ((1.0 + phi) * (1.0 + phi));
            for i in 0..4 {
                for j in 0..4 {
                    m[dofs[i]][dofs[j]] +=
                        signs[i] * signs[j] * scale * (s.mass * shift[i] * shift[j] + inertia * turn[i] * turn[j]);
                }
            }
        }
    }
    m
}

/// The chain reduced to the interface nodes and `n_modes` static answers to inertia, mass-orthonormal.
pub struct ReducedBeam {
    pub superelement: Superelement,
    /// Ψ, all dofs × r, row by row.
    pub basis: Vec<f64>,
}

/// Numbers and metadata of the chain through `nodes`, reduced, and the basis.
pub fn reduced_parts(
    nodes: &[Vector3],
    section: &Section,
    interface: &[usize],
    n_modes: usize,
) -> (Tensors, Metadata, Vec<f64>) {
    let (k, m) = chain(nodes, section);
    let basis = basis(&k, &m, interface, n_modes);
    let r = 6 * interface.len() + n_modes;
    let project = |a: &Square| {
        let columns: Vec<Vec<f64>> = (0..r).map(|j| basis.iter().skip(j).step_by(r).copied().collect()).collect();
        let images: Vec<Vec<f64>> = columns.iter().map(|column| a.times(column)).collect();
        let product = |i: usize, j: usize| columns[i].iter().zip(&images[j]).map(|(x, y)| x * y).sum::<f64>();
        Matrix::from_fn(r, r, |i, j| 0.5 * (product(i, j) + product(j, i)))
    };
    let positions: Vec<Vector3> = interface.iter().map(|node| nodes[*node]).collect();
    let (tensors, metadata) = parts(project(&k), project(&m), &positions);
    (tensors, metadata, basis)
}

/// The reduced chain as a superelement.
pub fn reduced(nodes: &[Vector3], section: &Section, interface: &[usize], n_modes: usize) -> ReducedBeam {
    let (tensors, metadata, basis) = reduced_parts(nodes, section, interface, n_modes);
    ReducedBeam { superelement: Superelement::new(tensors, metadata).expect("the parts fit"), basis }
}

/// An arc away from the origin in eight elements, both ends interface nodes.
pub fn arc(n_modes: usize) -> ReducedBeam {
    reduced(&arc_nodes(), &SOFT, &[0, 8], n_modes)
}

/// Nodes of the arc.
pub fn arc_nodes() -> Vec<Vector3> {
    (0..=8).map(|i| f64::from(i) / 8.0).map(|s| [1.0 + 2.0 * s, -0.5 + s * s, 0.3 + 0.4 * s * s * s]).collect()
}

/// Ψ = [I, 0; Ψ_S, Ψ_D] in the order of the nodes: Ψ_S = −K_II⁻¹K_IB, Ψ_D from K_II⁻¹M_II applied again and again.
fn basis(k: &Square, m: &Square, interface: &[usize], n_modes: usize) -> Vec<f64> {
    let is_interface = |dof: usize| interface.contains(&(dof / 6));
    let internal: Vec<usize> = (0..k.n).filter(|dof| !is_interface(*dof)).collect();
    let part = |a: &Square| {
        let data = internal.iter().flat_map(|i| internal.iter().map(|j| a.at(*i, *j))).collect();
        Square { n: internal.len(), data }
    };
    let (k_ii, m_ii) = (part(k), part(m));
    let r = 6 * interface.len() + n_modes;
    let mut basis = vec![0.0; k.n * r];
    for column in 0..6 * interface.len() {
        let dof = 6 * interface[column / 6] + column % 6;
        basis[dof * r + column] = 1.0;
        let load: Vec<f64> = internal.iter().map(|i| -k.at(*i, dof)).collect();
        for (i, value) in internal.iter().zip(k_ii.solve(&load)) {
            basis[i * r + column] = value;
        }
    }
    let mut random = SplitMix64::new(42);
    let mut modes: Vec<Vec<f64>> = Vec::new();
    for mode in 0..n_modes {
        // Starting from random loads, so that every direction is reached.
        let load = if mode < 3 { random.vector(k_ii.n, 1.0) } else { m_ii.times(&modes[mode - 3]) };
        let mut x = k_ii.solve(&load);
        for _ in 0..2 {
            for other in &modes {
                let along: f64 = m_ii.times(&x).iter().zip(other).map(|(a, b)| a * b).sum();
                x.iter_mut().zip(other).for_each(|(a, b)| *a -= along * b);
            }
            let norm: f64 = m_ii.times(&x).iter().zip(&x).map(|(a, b)| a * b).sum::<f64>().sqrt();
            x.iter_mut().for_each(|a| *a /= norm);
        }
        for (i, value) in internal.iter().zip(&x) {
            basis[i * r + 6 * interface.len() + mode] = *value;
        }
        modes.push(x);
    }
    basis
}

/// Displacements of the nodes under the six rigid-body motions, 6k × 6.
pub fn rigid_motion(positions: &[Vector3], row: usize, column: usize) -> f64 {
    let [x, y, z] = positions[row / 6];
    let d = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]];
    match (row % 6, column) {
        (a, b) if a == b => 1.0,
        (a, b) if a < 3 && b >= 3 => d[a][b - 3],
        _ => 0.0,
    }
}

/// Numbers and metadata of a superelement with six dofs at each interface node, from its matrices.
pub fn parts(stiffness: Matrix, mass: Matrix, positions: &[Vector3]) -> (Tensors, Metadata) {
    let (r, n_b) = (stiffness.rows(), 6 * positions.len());
    let rigid = Matrix::from_fn(r, 6, |i, j| if i < n_b { rigid_motion(positions, i, j) } else { 0.0 });
    let entry = |a: usize, b: usize| -> f64 {
        (0..r * r).map(|i| rigid[(i / r, a)] * mass[(i / r, i % r)] * rigid[(i % r, b)]).sum()
    };
    let rigid_body_mass = Matrix::from_fn(6, 6, entry);
    let interface_nodes = positions.iter().enumerate().map(|(node, position)| InterfaceNode {
        name: format!("node {node}"),
        label: None,
        dofs: Direction::ALL.to_vec(),
        position: *position,
    });
    let of_nodes = (0..n_b).map(|i| Coordinate::Interface { node: i / 6, direction: Direction::ALL[i % 6] });
    let frequencies: Vec<f64> = (n_b..r).map(|i| (i - n_b + 1) as f64).collect();
    let of_modes = frequencies.iter().enumerate().map(|(mode, omega)| Coordinate::FixedInterfaceMode {
        mode,
        frequency_hz: omega / std::f64::consts::TAU,
        error_bar_hz: None,
    });
    let metadata = Metadata {
        generator: Generator { name: "test".into(), version: "1".into(), parts_of_earlier_runs: None },
        method: Method::ModeAcceleration,
        units: None,
        interface_nodes: interface_nodes.collect(),
        coordinates: of_nodes.chain(of_modes).collect(),
        dropped: Vec::new(),
        load_names: Vec::new(),
        modes_held: Vec::new(),
        quantities: Vec::new(),
        matrices: Vec::new(),
        validity: Validity::default(),
        flags: Default::default(),
        model: ModelSummary { n_dofs: r as u64, rigid_body_modes: RigidBodyModes::Geometric, mass_properties: None },
        inputs: Default::default(),
        job: serde_json::json!({}),
        verification: Verification { verdict: Verdict::Pass, checks: Vec::new() },
    };
    let tensors = Tensors {
        stiffness,
        mass,
        rigid_body_modes: rigid,
        rigid_body_mass,
        interface_positions: positions.to_vec(),
        interface_frames: vec![[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]; positions.len()],
        frequencies,
        ..Tensors::default()
    };
    (tensors, metadata)
}

/// A component of random numbers: a full mass, and a full stiffness without rigid-body forces.
pub fn random_parts(n_nodes: usize, n_modal: usize, seed: u64) -> (Tensors, Metadata) {
    let mut random = SplitMix64::new(seed);
    let r = 6 * n_nodes + n_modal;
    let positions: Vec<Vector3> = (0..n_nodes).map(|_| random.vector_3(1.0)).collect();
    let mut definite = || {
        let a = random.vector(r * r, 1.0);
        let product = |i: usize, j: usize| (0..r).map(|k| a[i * r + k] * a[j * r + k]).sum::<f64>() / r as f64;
        Matrix::from_fn(r, r, |i, j| product(i, j) + if i == j { 0.5 } else { 0.0 })
    };
    let (k, mass) = (definite(), definite());
    // x less the rigid motion that node 0 makes.
    let n_b = 6 * n_nodes;
    let unmoved: Vec<f64> = (0..r * r)
        .map(|index| {
            let (i, j) = (index / r, index % r);
            let own = if i == j { 1.0 } else { 0.0 };
            // Rigid motion of node i under a unit displacement j of node 0.
            let shifted: Vec<Vector3> = positions.iter().map(|x| difference(x, &positions[0])).collect();
            own - if i < n_b && j < 6 { rigid_motion(&shifted, i, j) } else { 0.0 }
        })
        .collect();
    let half: Vec<f64> = (0..r * r).map(|i| (0..r).map(|c| k[(i / r, c)] * unmoved[c * r + i % r]).sum()).collect();
    let entry = |i: usize, j: usize| (0..r).map(|c| unmoved[c * r + i] * half[c * r + j]).sum::<f64>();
    let stiffness = Matrix::from_fn(r, r, |i, j| 0.5 * (entry(i, j) + entry(j, i)));
    parts(stiffness, mass, &positions)
}
