//! The model every family hands over, and the assembly of its matrices.

use std::collections::BTreeMap;

/// One entry of a sparse matrix: row, column, value.
pub type Entry = (u32, u32, f64);

/// Stiffness and mass of a finite element model with the meaning of its rows.
///
/// Both triangles are stored, each position once, sorted by row and column; entry (i, j) has the bits of (j, i).
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Number of degrees of freedom.
    pub n: usize,
    /// K, n × n.
    pub stiffness: Vec<Entry>,
    /// M, n × n.
    pub mass: Vec<Entry>,
    /// Position of each node.
    pub nodes: Vec<[f64; 3]>,
    /// Label of each node.
    pub labels: Vec<i64>,
    /// Label of the node and direction (0 to 5: ux, uy, uz, rx, ry, rz) of each row; empty for algebraic models.
    pub dofs: Vec<(i64, u8)>,
    /// Named groups of node labels.
    pub groups: BTreeMap<String, Vec<i64>>,
}

/// Isotropic linear elasticity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density.
    pub density: f64,
}

impl Material {
    /// Unit modulus and density, Poisson's ratio 0.3.
    pub const UNIT: Self = Self { young: 1.0, poisson: 0.3, density: 1.0 };
    /// Steel in metre, kilogram, second.
    pub const STEEL_SI: Self = Self { young: 2.1e11, poisson: 0.3, density: 7850.0 };
    /// Steel in millimetre, tonne, second: stresses in MPa.
    pub const STEEL_MM_T_S: Self = Self { young: 2.1e5, poisson: 0.3, density: 7.85e-9 };
}

impl Model {
    /// A model of nodes labelled 1, 2, … that all have the same directions, rows in node order.
    pub fn node_major(nodes: Vec<[f64; 3]>, directions: &[u8], stiffness: Assembler, mass: Assembler) -> Self {
        Self::of_entries(nodes, directions, stiffness.finish(), mass.finish())
    }

    /// A model of nodes labelled 1, 2, … that all have the same directions, from assembled matrices.
    pub fn of_entries(nodes: Vec<[f64; 3]>, directions: &[u8], stiffness: Vec<Entry>, mass: Vec<Entry>) -> Self {
        let labels: Vec<i64> = (1..).take(nodes.len()).collect();
        let dofs: Vec<(i64, u8)> =
            labels.iter().flat_map(|&node| directions.iter().map(move |&direction| (node, direction))).collect();
        Self { n: dofs.len(), stiffness, mass, nodes, labels, dofs, groups: BTreeMap::new() }
    }

    /// Adds the group of the nodes whose position satisfies a condition.
    pub fn add_group(&mut self, name: &str, holds: impl Fn([f64; 3]) -> bool) {
        let members = self.labels.iter().zip(&self.nodes).filter(|&(_, &x)| holds(x)).map(|(&label, _)| label);
        self.groups.insert(name.to_owned(), members.collect());
    }

    /// Geometric rigid-body modes U about the origin, as columns: three translations and three rotations.
    ///
    /// Columns that vanish for the directions the model has (rotations of a bar along x) are kept.
    ///
    /// # Panics
    /// If a row names a node that does not exist.
    pub fn rigid_body_modes(&self) -> [Vec<f64>; 6] {
        let position: BTreeMap<i64, [f64; 3]> = self.labels.iter().copied().zip(self.nodes.iter().copied()).collect();
        let mut modes: [Vec<f64>; 6] = std::array::from_fn(|_| vec![0.0; self.n]);
        for (row, &(node, direction)) in self.dofs.iter().enumerate() {
            let [x, y, z] = position[&node];
            // Displacement of a unit rotation about axis a is e_a × x.
            let by_rotation = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
            let direction = usize::from(direction);
            if direction < 3 {
                modes[direction][row] = 1.0;
                for axis in 0..3 {
                    modes[3 + axis][row] = by_rotation[axis][direction];
                }
            } else {
                modes[direction][row] = 1.0;
            }
        }
        modes
    }

    /// Total mass, t'Mt for the unit translation t along an axis 0, 1 or 2.
    pub fn total_mass(&self, axis: usize) -> f64 {
        let translation = &self.rigid_body_modes()[axis];
        dot(translation, &multiply(&self.mass, translation))
    }
}

/// y = A x for a matrix given by its entries.
pub fn multiply(entries: &[Entry], x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    for &(row, column, value) in entries {
        y[row as usize] += value * x[column as usize];
    }
    y
}

/// Scalar product, summed in index order.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(a, b)| a * b).sum()
}

/// Vector product a × b.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// Collects contributions to a symmetric matrix.
///
/// Only the upper triangle of what is added is used and the sum is mirrored at the end, so that the result is
/// symmetric to the bit whatever the order of the contributions.
#[derive(Clone, Debug, Default)]
pub struct Assembler {
    upper: Vec<Entry>,
}

impl Assembler {
    /// Adds to a symmetric matrix entry; entries below the diagonal are taken as mirrored and left out.
    pub fn add(&mut self, row: u32, column: u32, value: f64) {
        if row <= column {
            self.upper.push((row, column, value));
        }
    }

    /// Adds a symmetric element matrix, given by rows, at the rows and columns `dofs`.
    pub fn add_element<const N: usize>(&mut self, dofs: &[u32; N], element: &[[f64; N]; N]) {
        for (i, &row) in dofs.iter().enumerate() {
            for (j, &column) in dofs.iter().enumerate() {
                // The upper triangle of the element serves both halves.
                self.add(row, column, element[i.min(j)][i.max(j)]);
            }
        }
    }

    /// Adds all entries of a symmetric matrix.
    pub fn extend(&mut self, entries: impl IntoIterator<Item = Entry>) {
        for (row, column, value) in entries {
            self.add(row, column, value);
        }
    }

    /// The assembled matrix: both triangles, each position once, sorted.
    pub fn finish(mut self) -> Vec<Entry> {
        self.upper.sort_by_key(|&(row, column, _)| (row, column));
        let mut summed: Vec<Entry> = Vec::with_capacity(self.upper.len());
        for (row, column, value) in self.upper {
            match summed.last_mut() {
                Some(last) if (last.0, last.1) == (row, column) => last.2 += value,
                _ => summed.push((row, column, value)),
            }
        }
        let mirrored: Vec<Entry> = summed
            .iter()
            .filter(|&&(row, column, _)| row != column)
            .map(|&(row, column, v)| (column, row, v))
            .collect();
        summed.extend(mirrored);
        summed.sort_unstable_by_key(|&(row, column, _)| (row, column));
        summed
    }
}
