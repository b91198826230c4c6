//! A mesh as it is, for whoever wants no model: nodes, and cells in the order of VTK.

use std::path::{Path, PathBuf};

use super::faces::{Cell, CellList, Shape};
use super::format::{ReadCells, ReadNodes};
use super::{Allowance, formats};
use crate::dofs::Nodes;
use crate::error::Result;
use crate::regular_file::{digest, unchanged};

/// A mesh as it was read.
#[derive(Clone, Debug)]
pub struct MeshInput {
    /// The file.
    pub path: PathBuf,
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
    /// Label, position and groups of each node.
    pub nodes: Nodes,
    /// Cells in the order of the file.
    pub cells: Vec<VtkCells>,
    /// What the mesh has that is not read, in words; then it has no cells here.
    pub unread: Option<String>,
    /// Cells without their nodes in the middles of faces and of themselves.
    pub n_simplified: usize,
}

/// Cells of one type of VTK that follow each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VtkCells {
    /// The number of the type.
    pub number: u8,
    /// Nodes of a cell.
    pub n_nodes: usize,
    /// Indices of the nodes, cell after cell, in the order of VTK.
    pub nodes: Vec<u32>,
}

impl MeshInput {
    /// Reads the mesh of a file, in whatever format that is read.
    ///
    /// # Errors
    /// A file that cannot be read or whose content is wrong, more data than `allowance` has room for.
    pub fn read(path: &Path, allowance: &Allowance) -> Result<Self> {
        let format = formats::of_nodes(path)?;
        let read = || {
            let ReadNodes { nodes, .. } = format.read(path, allowance)?;
            let cells = format.read_cells(path, &nodes.coordinates, allowance)?;
            Ok((nodes, cells, digest(path)?))
        };
        let (nodes, ReadCells { cells, unread }, digest) = unchanged(path, read)?;
        let (cells, n_simplified) =
            if unread.is_some() { Default::default() } else { in_vtk(&cells, &nodes.coordinates) };
        Ok(Self { path: path.to_owned(), digest, nodes, cells, unread, n_simplified })
    }

    /// Whether the HDF5 library reads a mesh.
    pub fn is_parsed_in_c(path: &Path) -> bool {
        formats::of_nodes(path).is_ok_and(|format| format.is_parsed_in_c())
    }

    /// How many cells there are.
    pub fn n_cells(&self) -> usize {
        self.cells.iter().map(|cells| cells.nodes.len() / cells.n_nodes).sum()
    }
}

/// Cells in the order of VTK, and how many of them have lost nodes that are at no corner and on no edge.
fn in_vtk(list: &CellList, coordinates: &[[f64; 3]]) -> (Vec<VtkCells>, usize) {
    let mut n_simplified = 0;
    let of_run = |(cell, nodes): &(Cell, Vec<u32>)| {
        let n_nodes = cell.first_central();
        let is_whole = n_nodes == cell.n_nodes();
        n_simplified += if is_whole { 0 } else { nodes.len() / cell.n_nodes() };
        let ordered = nodes.chunks_exact(cell.n_nodes()).flat_map(|nodes| ordered(*cell, nodes, coordinates));
        VtkCells { number: number_of(*cell), n_nodes, nodes: ordered.collect() }
    };
    (list.runs.iter().map(of_run).collect(), n_simplified)
}

/// The number of the type of a cell: with nodes on its edges, or without.
fn number_of(cell: Cell) -> u8 {
    let numbers = match cell.shape() {
        Shape::Triangle => [5, 22],
        Shape::Quadrilateral => [9, 23],
        Shape::Tetrahedron => [10, 24],
        Shape::Brick => [12, 25],
        Shape::Wedge => [13, 26],
        Shape::Pyramid => [14, 27],
    };
    numbers[usize::from(cell.first_central() > cell.n_corners())]
}

/// Corners, and nodes on edges in the order of VTK. Formats have two orders, and the places of the nodes tell which one a cell has: that in
/// which they are nearer to the middles of their edges.
fn ordered(cell: Cell, nodes: &[u32], coordinates: &[[f64; 3]]) -> Vec<u32> {
    let n_corners = cell.n_corners();
    if cell.first_central() == n_corners {
        return nodes[..n_corners].to_vec();
    }
    let place = |at: usize| coordinates[nodes[at] as usize];
    let middle_of = |[a, b]: [usize; 2]| {
        let (a, b) = (place(a), place(b));
        [0, 1, 2].map(|axis| 0.5 * (a[axis] + b[axis]))
    };
    let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
    let misfit = |edges: &[[usize; 2]]| -> f64 {
        edges.iter().zip(n_corners..).map(|(edge, at)| distance(middle_of(*edge), place(at))).sum()
    };
    let own = cell.orders().iter().min_by(|a, b| misfit(a).total_cmp(&misfit(b))).copied().unwrap_or_default();
    let on_edge = |edge: &[usize; 2]| own.iter().position(|other| other == edge).map(|at| nodes[n_corners + at]);
    nodes[..n_corners].iter().copied().chain(cell.edges().iter().filter_map(on_edge)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of 27 nodes at the corners, the edges and between them.
    #[test]
    fn nodes_on_edges_come_in_the_order_of_vtk_whatever_their_own() {
        let brick = Cell::new(Shape::Brick, 27).expect("a brick");
        let corners = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]];
        for order in brick.orders() {
            let middle =
                |edge: &[usize; 2]| [0, 1, 2].map(|axis| (corners[edge[0]][axis] + corners[edge[1]][axis]) / 2);
            let mut places: Vec<[i32; 3]> = corners.to_vec();
            places.extend(order.iter().map(middle));
            places.resize(27, [1, 1, 1]);
            let coordinates: Vec<[f64; 3]> = places.iter().map(|place| place.map(f64::from)).collect();
            let nodes: Vec<u32> = (0..27).collect();
            let mut list = CellList::default();
            list.extend(brick, nodes);
            let (cells, n_simplified) = in_vtk(&list, &coordinates);
            assert_eq!((cells[0].number, cells[0].n_nodes, n_simplified), (25, 20, 1));
            let found: Vec<[i32; 3]> = cells[0].nodes.iter().map(|node| places[*node as usize]).collect();
            let expected: Vec<[i32; 3]> = corners.iter().copied().chain(brick.edges().iter().map(middle)).collect();
            assert_eq!(found, expected);
        }
    }
}
