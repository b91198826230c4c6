//! Solids of straight-sided quadratic tetrahedra on a lattice of cells, any of which may be left out.

use crate::element::ElementMatrices;
use crate::model::{Entry, Material, Model};
use crate::tetrahedron::{TET_EDGES, tetrahedron};

/// A mesh of ten-node tetrahedra.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TetMesh {
    /// Position of each node; middles of edges lie halfway.
    pub nodes: Vec<[f64; 3]>,
    /// Nodes of each element, from zero: four corners, then the middles of [`TET_EDGES`].
    pub elements: Vec<[u32; 10]>,
}

/// Orders of the axes along which the six tetrahedra of a cell walk from its lowest corner to its highest; those of odd
/// permutations are mirrored.
const WALKS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];

impl TetMesh {
    /// Six tetrahedra (Kuhn's) in each cell of a lattice on the unit cube that `holds`, corners moved by `map`.
    ///
    /// All cells are cut alike, so that the diagonals of faces agree. The nodes are points of the lattice of half the
    /// width, numbered x fastest.
    pub fn structured(
        cells: [usize; 3],
        map: impl Fn([f64; 3]) -> [f64; 3],
        holds: impl Fn([usize; 3]) -> bool,
    ) -> Self {
        let numbers = used_points(cells, &holds);
        let size = cells.map(|n| 2 * n + 1);
        let index = |p: [usize; 3]| p[0] + size[0] * (p[1] + size[1] * p[2]);
        let corner = |p: [usize; 3]| map(std::array::from_fn(|d| p[d] as f64 / cells[d] as f64));
        let mut mesh = Self::default();
        for p in points(size).filter(|&p| numbers[index(p)] != UNUSED) {
            // The ends of the edge that a point halves; those of a corner are itself.
            let (low, high) = (corner(p.map(|c| c / 2)), corner(p.map(|c| c.div_ceil(2))));
            mesh.nodes.push(std::array::from_fn(|d| 0.5 * (low[d] + high[d])));
        }
        for cell in points(cells).filter(|&cell| holds(cell)) {
            mesh.elements.extend(WALKS.iter().enumerate().map(|(walk, axes)| {
                let mut at = [cell; 4];
                for step in 0..3 {
                    at[step + 1] = at[step];
                    at[step + 1][axes[step]] += 1;
                }
                if walk >= 3 {
                    at.swap(2, 3);
                }
                let number = |a: usize, b: usize| numbers[index(std::array::from_fn(|d| at[a][d] + at[b][d]))];
                std::array::from_fn(|node| match node.checked_sub(4) {
                    None => number(node, node),
                    Some(edge) => number(TET_EDGES[edge][0], TET_EDGES[edge][1]),
                })
            }));
        }
        mesh
    }

    /// Number of nodes that [`Self::structured`] would make.
    pub fn count_nodes(cells: [usize; 3], holds: impl Fn([usize; 3]) -> bool) -> usize {
        used_points(cells, &holds).iter().filter(|&&number| number != UNUSED).count()
    }

    /// K and M with three displacements a node; nodes are labelled from one.
    ///
    /// Element blocks are added to a pattern found beforehand, in the order of the elements: no sorting of
    /// contributions, and 72 bytes for each pair of neighbours in addition to the result.
    ///
    /// # Panics
    /// If an element is turned inside out.
    pub fn assemble(&self, material: &Material) -> Model {
        let mut blocks = NodeBlocks::new(self);
        for element in &self.elements {
            let corners = std::array::from_fn(|a| self.nodes[element[a] as usize]);
            blocks.add(element, &tetrahedron(&corners, material));
        }
        Model::of_entries(self.nodes.clone(), &[0, 1, 2], blocks.stiffness(), blocks.mass())
    }
}

const UNUSED: u32 = u32::MAX;

/// All points of a lattice, x fastest.
fn points([nx, ny, nz]: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
}

/// The number of each point of the lattice of half the width that a cell touches.
fn used_points(cells: [usize; 3], holds: &impl Fn([usize; 3]) -> bool) -> Vec<u32> {
    let size = cells.map(|n| 2 * n + 1);
    let mut numbers = vec![UNUSED; size.iter().product()];
    for cell in points(cells).filter(|&cell| holds(cell)) {
        for [i, j, k] in points([3; 3]) {
            numbers[2 * cell[0] + i + size[0] * (2 * cell[1] + j + size[1] * (2 * cell[2] + k))] = 0;
        }
    }
    for (number, used) in (0..).zip(numbers.iter_mut().filter(|number| **number != UNUSED)) {
        *used = number;
    }
    numbers
}

/// Sums of the elements' blocks for each pair of nodes that share an element, rows and columns ascending.
struct NodeBlocks {
    /// Where the pairs of each node start; one more than nodes.
    starts: Vec<usize>,
    columns: Vec<u32>,
    stiffness: Vec<[[f64; 3]; 3]>,
    /// One number for each pair: directions do not couple in M.
    mass: Vec<f64>,
}

impl NodeBlocks {
    fn new(mesh: &TetMesh) -> Self {
        let n_nodes = mesh.nodes.len();
        let mut of_node = vec![Vec::new(); n_nodes];
        for (element, nodes) in (0_u32..).zip(&mesh.elements) {
            nodes.iter().for_each(|&node| of_node[node as usize].push(element));
        }
        let (mut starts, mut columns) = (vec![0], Vec::new());
        let mut neighbours: Vec<u32> = Vec::new();
        for elements in of_node {
            neighbours.clear();
            neighbours.extend(elements.iter().flat_map(|&element| mesh.elements[element as usize]));
            neighbours.sort_unstable();
            neighbours.dedup();
            columns.extend_from_slice(&neighbours);
            starts.push(columns.len());
        }
        let n_pairs = columns.len();
        Self { starts, columns, stiffness: vec![[[0.0; 3]; 3]; n_pairs], mass: vec![0.0; n_pairs] }
    }

    fn add(&mut self, nodes: &[u32; 10], element: &ElementMatrices<30>) {
        for (a, &row) in nodes.iter().enumerate() {
            let first = self.starts[row as usize];
            let neighbours = &self.columns[first..self.starts[row as usize + 1]];
            for (b, column) in nodes.iter().enumerate() {
                // Every pair of an element is in the pattern, which was made from the elements.
                let Ok(place) = neighbours.binary_search(column) else { unreachable!("a pair outside the pattern") };
                for (i, row) in self.stiffness[first + place].iter_mut().enumerate() {
                    for (j, sum) in row.iter_mut().enumerate() {
                        // The upper triangle of the element serves both halves.
                        let (r, s) = (3 * a + i, 3 * b + j);
                        *sum += element.stiffness[r.min(s)][r.max(s)];
                    }
                }
                self.mass[first + place] += element.mass[3 * a.min(b)][3 * a.max(b)];
            }
        }
    }

    fn stiffness(&self) -> Vec<Entry> {
        let mut entries = Vec::with_capacity(9 * self.columns.len());
        for (node, i, pairs) in self.rows() {
            for pair in pairs {
                let column = 3 * self.columns[pair];
                entries.extend((0..).zip(self.stiffness[pair][i]).map(|(j, value)| (node, column + j, value)));
            }
        }
        entries
    }

    fn mass(&self) -> Vec<Entry> {
        let mut entries = Vec::with_capacity(3 * self.columns.len());
        for (row, i, pairs) in self.rows() {
            entries.extend(pairs.map(|pair| (row, 3 * self.columns[pair] + i as u32, self.mass[pair])));
        }
        entries
    }

    /// Row, its direction and the pairs of its node, row by row.
    fn rows(&self) -> impl Iterator<Item = (u32, usize, std::ops::Range<usize>)> {
        let nodes = self.starts.windows(2).map(|bounds| bounds[0]..bounds[1]);
        (0_u32..).zip(nodes).flat_map(|(node, pairs)| (0..3).map(move |i| (3 * node + i as u32, i, pairs.clone())))
    }
}
