//! Whether the rows of K belong to the nodes that the map gives them, by the cells of the mesh: an element couples the nodes of its cell.
//!
//! K couples in addition what springs, ties and beams do, for which a mesh has no cell, and a mesh may have cells of surfaces, of
//! another part, or of elements of lower order. What contradicts both is [`super::apart`]: a map in another order, of other nodes, of
//! another mesh. Nodes at one place, exchanged in the map, make no force under rigid-body motion, and couple with each other's neighbours.
//!
//! ```text
//! k_a    nodes that K couples with node a, of those that cells have
//! c_a    nodes that cells have together with node a
//! c_a \ k_a ⊂ k_b \ c_b,  c_b \ k_b ⊂ k_a \ c_a
//! ```
//! Where K and the cells have other counts of neighbours, a node apart proves nothing by itself: a line of a spider drawn as a cell is no
//! element. Where all that K lacks of the cells of a node it couples with another node beyond the cells of that one, and the other way
//! round, the two were exchanged. Where k_a alone is c_b for the most part it is a warning.

use rayon::prelude::*;

use super::apart::{Apart, n_shared};
use super::couplings::Couplings;
use crate::dofs::{Dof, Nodes, RowNames};
use crate::error::{Error, Result};
use crate::input::MeshCells;
use crate::model::finding::Finding;

/// Fewer neighbours tell no node from others.
const LEAST_COUPLED: usize = 2;
/// Nodes that a warning names.
const SHOWN_NODES: usize = 3;

/// Compares the nodes that K couples with those that cells have in common.
///
/// # Errors
/// [`Error::CellsOfOthers`] where more than half of all nodes of cells are apart, where K is that of the mesh in another order, and where
/// two nodes were exchanged. A node that is coupled as another one is a finding.
pub(super) fn compared(stiffness: &Couplings, cells: &CellGraph, names: RowNames<'_>) -> Result<Option<Finding>> {
    let coupled = |node: u32| if stiffness.is_coupled(node) { cells.neighbours(node) } else { Vec::new() };
    let apart = Apart::of(stiffness.n_nodes(), coupled, |node| stiffness.others(node).collect());
    let n_nodes = apart.n_known;
    let graphs = Graphs { stiffness, cells };
    let (strayed, is_proof) = if !apart.moved.is_empty() {
        (apart.moved, true)
    } else if 2 * apart.nodes.len() > n_nodes {
        (apart.nodes, true)
    } else {
        match graphs.exchanged(&apart.lacking) {
            exchanged if !exchanged.is_empty() => (exchanged, true),
            _ => (graphs.as_others(&apart.nodes), false),
        }
    };
    let name_of = |node: &u32| stiffness.rows(*node).find_map(|row| names.node(row));
    let Some(first) = strayed.first().and_then(name_of) else { return Ok(None) };
    let n_strayed = strayed.len();
    if is_proof {
        return Err(Error::CellsOfOthers { n_strayed, n_nodes, first });
    }
    let at = strayed.iter().take(SHOWN_NODES).filter_map(name_of).map(|node| node.to_string());
    Ok(Some(Finding::CellsOfOthers { n_strayed, n_nodes, at: at.collect::<Vec<_>>().join(", ") }))
}

/// What couples nodes by K, and by cells.
struct Graphs<'a> {
    stiffness: &'a Couplings,
    cells: &'a CellGraph,
}

impl Graphs<'_> {
    /// k_a.
    fn coupled(&self, node: u32) -> Vec<u32> {
        self.stiffness.others(node).filter(|other| self.cells.has(*other)).collect()
    }

    /// c_a without k_a, and k_a without c_a.
    fn differing(&self, node: u32) -> [Vec<u32>; 2] {
        let (by_stiffness, by_cells) = (self.coupled(node), self.cells.neighbours(node));
        let without = |own: &[u32], others: &[u32]| -> Vec<u32> {
            own.iter().copied().filter(|node| others.binary_search(node).is_err()).collect()
        };
        let known: Vec<u32> = by_cells.iter().copied().filter(|node| self.stiffness.is_coupled(*node)).collect();
        [without(&known, &by_stiffness), without(&by_stiffness, &by_cells)]
    }

    /// Nodes that lack neighbours, and were exchanged for others.
    fn exchanged(&self, lacking: &[u32]) -> Vec<u32> {
        let is_within = |some: &[u32], others: &[u32]| some.iter().all(|node| others.binary_search(node).is_ok());
        let is_exchanged = |node: &&u32| {
            let [lacked, beyond] = self.differing(**node);
            let Some(first) = lacked.first().filter(|_| lacked.len() >= LEAST_COUPLED) else { return false };
            let [_, others] = self.differing(*first);
            others.iter().filter(|other| *other != *node).any(|other| {
                let [of_other, beyond_other] = self.differing(*other);
                !of_other.is_empty() && is_within(&lacked, &beyond_other) && is_within(&of_other, &beyond)
            })
        };
        lacking.par_iter().filter(is_exchanged).copied().collect()
    }

    /// Nodes apart that K couples as cells have others.
    fn as_others(&self, apart: &[u32]) -> Vec<u32> {
        let is_as = |of_node: &[u32], other: u32| {
            let of_other = self.cells.neighbours(other);
            let shared = n_shared(of_node, &of_other);
            shared >= LEAST_COUPLED && 2 * shared >= of_node.len().max(of_other.len())
        };
        let is_strayed = |node: &&u32| {
            let of_node = self.coupled(**node);
            let near = of_node.first().map_or_else(Vec::new, |first| self.cells.neighbours(*first));
            near.into_iter().any(|other| other != **node && is_as(&of_node, other))
        };
        apart.iter().filter(is_strayed).copied().collect()
    }
}

/// The number of each node of a mesh that rows have.
pub(super) struct Numbers(Vec<Option<u32>>);

impl Numbers {
    /// `node_of` has the number of the node of each row.
    pub(super) fn of(nodes: &Nodes, dofs: &[Option<Dof>], node_of: &[u32]) -> Self {
        let labelled = dofs.iter().zip(node_of).filter_map(|(dof, node)| dof.map(|dof| (dof.node, *node)));
        let numbers: std::collections::HashMap<i64, u32> = labelled.collect();
        Self(nodes.labels.iter().map(|label| numbers.get(label).copied()).collect())
    }
}

/// Which nodes cells have in common.
pub(super) struct CellGraph {
    /// The nodes of each cell, one after another.
    nodes: Vec<u32>,
    /// Where each cell starts in `nodes`, and the end of the last one.
    starts: Vec<usize>,
    /// The cells of each node, one after another.
    cells: Vec<u32>,
    /// Where those of each node start in `cells`, and the end of the last one.
    of_node: Vec<usize>,
}

impl CellGraph {
    /// That of the cells of a mesh, without the nodes that no rows have.
    pub(super) fn of(cells: &[MeshCells], numbers: &Numbers) -> Self {
        let (mut nodes, mut starts) = (Vec::new(), vec![0]);
        for cell in cells.iter().flat_map(|cells| cells.nodes.chunks_exact(cells.n_nodes)) {
            nodes.extend(cell.iter().filter_map(|node| numbers.0[*node as usize]));
            starts.push(nodes.len());
        }
        let n_nodes = numbers.0.iter().flatten().max().map_or(0, |max| *max as usize + 1);
        let mut of_node = vec![0; n_nodes + 1];
        nodes.iter().for_each(|node| of_node[*node as usize + 1] += 1);
        (0..n_nodes).for_each(|node| of_node[node + 1] += of_node[node]);
        let (mut next, mut of_cells) = (of_node.clone(), vec![0; nodes.len()]);
        for (cell, ends) in starts.windows(2).enumerate() {
            for node in &nodes[ends[0]..ends[1]] {
                let place = &mut next[*node as usize];
                of_cells[*place] = cell as u32;
                *place += 1;
            }
        }
        Self { nodes, starts, cells: of_cells, of_node }
    }

    /// Whether a cell has the node.
    fn has(&self, node: u32) -> bool {
        !self.cells_of(node).is_empty()
    }

    /// The nodes that cells have together with a node, ascending.
    fn neighbours(&self, node: u32) -> Vec<u32> {
        let of_cell = |cell: &u32| &self.nodes[self.starts[*cell as usize]..self.starts[*cell as usize + 1]];
        let mut found: Vec<u32> = self.cells_of(node).iter().flat_map(of_cell).copied().collect();
        found.retain(|other| *other != node);
        found.sort_unstable();
        found.dedup();
        found
    }

    fn cells_of(&self, node: u32) -> &[u32] {
        match self.of_node.get(node as usize..node as usize + 2) {
            Some(&[start, end]) => &self.cells[start..end],
            _ => &[],
        }
    }
}
