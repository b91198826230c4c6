//! Whether K and M have their rows in one order: the mass of an element couples the nodes that its stiffness couples.
//!
//! ```text
//! m_i    nodes that M couples with node i
//! k_i    nodes that K couples with it, of those that M couples with anything
//! s_i    nodes in both
//! ```
//! A node is apart where s_i is less than half of m_i and less than half of k_i. Either alone is sound: springs, ties and lumped masses
//! couple in K what M does not, and the added mass of a fluid or a mass element of several nodes couples in M what K does not. In another
//! order M does both, at nearly every node. Of 33 sound pairs of real programs none has a node apart where a dof map tells the nodes. By
//! rows alone two have, a seventh and a tenth of their rows. With nodes of M permuted all nodes are apart but for a few, and most of them
//! with rows direction by direction.
//!
//! One mesh in two orders has as many nodes with one, two, three … neighbours in M as in K, and other pairs of them. What couples more in
//! either matrix changes these counts. So equal counts over other pairs prove another order, of two nodes already, where a dof map tells
//! the nodes. An order that maps the mesh onto itself, all nodes of a row of elements backwards for instance, changes no pair and is not
//! seen here.
//!
//! An order changes no count: the mass of the elements couples as many pairs of nodes as their stiffness. Where M couples fewer, a
//! lumped mass with that of a fluid between pairs of nodes for instance, other neighbours are no sign of an order.
//!
//! A mass that couples no rotation with another node, where K does, is none of the elements of beams and shells: it is lumped, and what it
//! couples was added, between the tubes of a bundle in a fluid for instance. As many tubes as nodes along each are the mesh in another
//! order, as far as pairs tell. Nothing of that is proof, and it is a warning.
//!
//! A diagonal mass couples nothing, and no order of it contradicts K here.

use rayon::prelude::*;

use super::finding::Finding;
use crate::dofs::{Dof, RowNames};
use crate::error::{Error, Result};
use crate::model::node_of_row;
use crate::sparse::SparseMatrix;

/// Pairs of nodes that M couples, of those that K couples, from which on M is taken for the mass of the elements.
const LEAST_SHARE_OF_PAIRS: f64 = 0.75;
/// Pairs of rows likewise: the mass of a solid couples a row with one of three rows of a node, its stiffness with all three.
const LEAST_SHARE_OF_ROWS: f64 = LEAST_SHARE_OF_PAIRS / 3.0;

/// Nodes that a warning names.
const SHOWN_NODES: usize = 3;
/// Fewer nodes with one neighbour each are no mesh, whose counts could say something.
const LEAST_NODES: usize = 4;

/// Nodes whose neighbours in M are others than in K.
struct Apart {
    /// The nodes that share less than half of their neighbours.
    nodes: Vec<u32>,
    /// All nodes apart, where the counts of neighbours prove that M is that of the mesh of K in another order.
    moved: Vec<u32>,
    n_nodes: usize,
}

/// Compares the nodes that M couples with those that K couples.
///
/// # Errors
/// [`Error::MassInAnotherOrder`] where more than half of all nodes are apart, or where M is that of the mesh in another order. Fewer are a
/// finding, and so are those of an added mass, where a dof map tells nodes; of rows alone K and M of one element may couple different ones.
pub(super) fn compared(
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
    dofs: Option<&[Option<Dof>]>,
    names: RowNames<'_>,
) -> Result<Option<Finding>> {
    let of_row = node_of_row(mass.rows(), dofs);
    let (what, least_share) =
        if dofs.is_some() { ("nodes", LEAST_SHARE_OF_PAIRS) } else { ("rows", LEAST_SHARE_OF_ROWS) };
    let Apart { nodes, moved, n_nodes } = Apart::of(stiffness, mass, &of_row, least_share);
    // The counts of rows alone prove nothing.
    let is_moved = dofs.is_some() && !moved.is_empty();
    let name_of = |node: &u32| of_row.iter().position(|of_row| of_row == node).map(|row| names.full(row));
    let proof = if is_moved { &moved } else { &nodes };
    let Some(first) = proof.first().and_then(name_of) else { return Ok(None) };
    let is_of_elements = || dofs.is_none_or(|dofs| !is_added([stiffness, mass], dofs));
    if (2 * nodes.len() > n_nodes || is_moved) && is_of_elements() {
        return Err(Error::MassInAnotherOrder { n_apart: proof.len(), n_nodes, what, first });
    }
    let at = proof.iter().take(SHOWN_NODES).filter_map(name_of).collect::<Vec<_>>().join(", ");
    Ok(dofs.map(|_| Finding::MassCouplesOthers { n_apart: proof.len(), n_nodes, at }))
}

/// Whether K couples rotations with other nodes and M none.
fn is_added(matrices: [&SparseMatrix; 2], dofs: &[Option<Dof>]) -> bool {
    let node = |row: usize| dofs[row].map(|dof| dof.node);
    let turns = |row: &usize| dofs[*row].is_some_and(|dof| dof.direction.is_rotation());
    let couples_rotations = |matrix: &SparseMatrix| {
        let couples = |row: usize| {
            let entries = matrix.outer_view(row);
            let mut entries = entries.iter().flat_map(|row| row.iter());
            entries.any(|(col, value)| *value != 0.0 && node(col) != node(row))
        };
        (0..dofs.len()).filter(turns).any(couples)
    };
    let [stiffness, mass] = matrices;
    couples_rotations(stiffness) && !couples_rotations(mass)
}

impl Apart {
    fn of(stiffness: &SparseMatrix, mass: &SparseMatrix, of_row: &[u32], least_share: f64) -> Self {
        let n_nodes = of_row.iter().max().map_or(0, |max| *max as usize + 1);
        let mut rows = vec![Vec::new(); n_nodes];
        of_row.iter().enumerate().for_each(|(row, node)| rows[*node as usize].push(row));
        let neighbours = |matrix: &SparseMatrix, node: usize| {
            let mut found: Vec<u32> = Vec::new();
            for row in &rows[node] {
                let entries = matrix.outer_view(*row);
                let coupled = entries.iter().flat_map(|row| row.iter()).filter(|(_, value)| **value != 0.0);
                // The rows of a node mostly follow each other: what is to be sorted is a third of the entries, or a sixth.
                for other in coupled.map(|(col, _)| of_row[col]).filter(|other| *other as usize != node) {
                    if found.last() != Some(&other) {
                        found.push(other);
                    }
                }
            }
            found.sort_unstable();
            found.dedup();
            found
        };
        let by_mass: Vec<Vec<u32>> = (0..n_nodes).into_par_iter().map(|node| neighbours(mass, node)).collect();
        // Nodes that M couples with nothing tell nothing.
        let with_mass = |node: usize| {
            let mut found = if by_mass[node].is_empty() { Vec::new() } else { neighbours(stiffness, node) };
            found.retain(|other| !by_mass[*other as usize].is_empty());
            found
        };
        let by_stiffness: Vec<Vec<u32>> = (0..n_nodes).into_par_iter().map(with_mass).collect();
        let n_pairs = |by: &[Vec<u32>]| by.iter().map(Vec::len).sum::<usize>() as f64;
        if n_pairs(&by_mass) < least_share * n_pairs(&by_stiffness) {
            return Self { nodes: Vec::new(), moved: Vec::new(), n_nodes };
        }
        let is_apart = |node: &u32| {
            let (of_mass, of_stiffness) = (&by_mass[*node as usize], &by_stiffness[*node as usize]);
            let n_shared = of_stiffness.iter().filter(|other| of_mass.binary_search(other).is_ok()).count();
            2 * n_shared < of_mass.len() && 2 * n_shared < of_stiffness.len()
        };
        let nodes = (0..n_nodes as u32).into_par_iter().filter(is_apart).collect();
        Self { nodes, moved: moved(&by_mass, &by_stiffness), n_nodes }
    }
}

/// Nodes with other neighbours in M than in K, where both have as many nodes with each number of neighbours; none otherwise.
fn moved(by_mass: &[Vec<u32>], by_stiffness: &[Vec<u32>]) -> Vec<u32> {
    let counts = |by: &[Vec<u32>]| {
        let mut counts: Vec<usize> = by.iter().map(Vec::len).collect();
        counts.sort_unstable();
        counts
    };
    let of_mass = counts(by_mass);
    let is_mesh = of_mass.iter().filter(|count| **count > 1).count() >= LEAST_NODES;
    if !is_mesh || of_mass != counts(by_stiffness) {
        return Vec::new();
    }
    (0..by_mass.len() as u32).filter(|node| by_mass[*node as usize] != by_stiffness[*node as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: usize = 8;

    /// A matrix that couples some pairs of eight rows.
    fn coupling(pairs: &[(usize, usize)]) -> SparseMatrix {
        let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for row in 0..N {
            let is_coupled = |col: &usize| *col == row || pairs.contains(&(row, *col)) || pairs.contains(&(*col, row));
            columns.extend((0..N).filter(is_coupled).map(|col| col as u32));
            values.resize(columns.len(), 1.0);
            pointers.push(columns.len());
        }
        SparseMatrix::new((N, N), pointers, columns, values)
    }

    /// Rows in a line, in a given order.
    fn chain(order: [usize; N]) -> SparseMatrix {
        let pairs: Vec<(usize, usize)> = order.windows(2).map(|pair| (pair[0], pair[1])).collect();
        coupling(&pairs)
    }

    fn n_apart(stiffness: &SparseMatrix, mass: &SparseMatrix) -> usize {
        let nodes: Vec<u32> = (0..N as u32).collect();
        Apart::of(stiffness, mass, &nodes, LEAST_SHARE_OF_PAIRS).nodes.len()
    }

    #[test]
    fn nodes_are_apart_where_neighbours_in_mass_are_others_than_in_stiffness() {
        let natural = chain([0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(n_apart(&natural, &natural), 0);
        assert_eq!(n_apart(&natural, &chain([0, 4, 1, 5, 2, 6, 3, 7])), N);
        // A diagonal mass, a mass element over distant nodes, and the added mass of a fluid at all nodes are sound.
        let every: Vec<(usize, usize)> = (0..N).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
        // So is the mass of a fluid between pairs of nodes that are no neighbours.
        let pairs = [(0, 4), (1, 5), (2, 6), (3, 7)];
        for sound in [coupling(&[]), coupling(&[(0, 7)]), coupling(&every), coupling(&pairs)] {
            assert_eq!(n_apart(&natural, &sound), 0);
        }
    }

    #[test]
    fn two_nodes_exchanged_change_pairs_and_no_count() {
        let nodes: Vec<u32> = (0..N as u32).collect();
        let moved = |k: &SparseMatrix, m: &SparseMatrix| Apart::of(k, m, &nodes, LEAST_SHARE_OF_PAIRS).moved;
        let natural = chain([0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(moved(&natural, &chain([0, 2, 1, 3, 4, 5, 6, 7])), [0, 1, 2, 3]);
        // Backwards is the same mesh, and a spring or a mass element more is another one.
        let [mut spring, mut instrument] = [(0..N - 1).map(|i| (i, i + 1)).collect::<Vec<_>>(), vec![]];
        instrument.extend_from_slice(&spring);
        spring.push((0, 5));
        instrument.push((2, 6));
        assert_eq!(moved(&natural, &chain([7, 6, 5, 4, 3, 2, 1, 0])), [0; 0]);
        assert_eq!(moved(&coupling(&spring), &natural), [0; 0]);
        assert_eq!(moved(&natural, &coupling(&instrument)), [0; 0]);
    }
}
