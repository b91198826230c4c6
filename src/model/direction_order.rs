//! Whether the rows of one direction belong to the nodes that the map gives them.
//!
//! ```text
//! C_a    nodes that the rows of some directions at node a are coupled with by columns of all other directions
//! S_a    nodes that the rows of all other directions at node a are coupled with by columns of these
//! ```
//! An element couples all directions of its nodes, so that C_a lies in S_a. Rigid-body motion does not see rows of one rotation at other nodes,
//! nor those of one displacement at nodes with two coordinates in common: their labels may change places with no force at all. What such
//! rows are coupled with are the neighbours of another node b then: C_a lies in S_b. A spring or a lever that only one direction of a
//! node takes part in adds to C_a a node that is in no S_b together with the others.
//!
//! Directions that no element couples with others, as the stretching of straight bars along an axis, tell nothing.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::finding::Finding;
use crate::dofs::{Dof, RowNames};
use crate::error::{Error, Result};
use crate::model::node_of_row;
use crate::sparse::SparseMatrix;

/// Directions of a node.
const N: usize = 6;
/// Fewer neighbours tell no node from others.
const LEAST_COUPLED: usize = 2;
/// Nodes that a warning names.
const SHOWN_NODES: usize = 3;
/// The directions that are asked together, as bits: each by itself, and all rotations.
const ASKED: [u8; N + 1] = [1, 2, 4, 8, 16, 32, 0b11_1000];

/// Compares the neighbours of the rows of each direction with those of all others.
///
/// # Errors
/// [`Error::DirectionInAnotherOrder`] where the rows of a direction are those of other nodes at more than half of all nodes; fewer are a
/// finding.
pub(super) fn compared(
    (what, matrix): (&'static str, &SparseMatrix),
    dofs: Option<&[Option<Dof>]>,
    names: RowNames<'_>,
) -> Result<Option<Finding>> {
    let Some(dofs) = dofs else { return Ok(None) };
    let blocks = Blocks::of(matrix, dofs);
    let strayed = |asked: &u8| (*asked, blocks.strayed(*asked));
    let Some((asked, nodes)) = ASKED.iter().map(strayed).find(|(_, nodes)| nodes.len() > 1) else { return Ok(None) };
    let rows = nodes.iter().filter_map(|node| blocks.row_of(*node, asked));
    let n_nodes = blocks.of_node.len();
    if 2 * nodes.len() > n_nodes {
        let first = rows.map(|row| names.full(row)).next().unwrap_or_default();
        return Err(Error::DirectionInAnotherOrder { what, n_strayed: nodes.len(), n_nodes, first });
    }
    let at = rows.take(SHOWN_NODES).map(|row| names.full(row)).collect::<Vec<_>>().join(", ");
    Ok(Some(Finding::DirectionOfOthers { what, n_strayed: nodes.len(), n_nodes, at }))
}

/// Which directions of which nodes a matrix couples.
struct Blocks {
    /// Of each node the others with the directions coupled, row by column, as bits; ascending.
    of_node: Vec<Vec<(u32, u64)>>,
    /// The row of each direction.
    rows: Vec<[Option<usize>; N]>,
}

impl Blocks {
    fn of(matrix: &SparseMatrix, dofs: &[Option<Dof>]) -> Self {
        let node_of = node_of_row(matrix.rows(), Some(dofs));
        let n_nodes = node_of.iter().max().map_or(0, |max| *max as usize + 1);
        let direction: Vec<Option<usize>> = dofs.iter().map(|dof| dof.map(|dof| dof.direction as usize)).collect();
        let mut rows = vec![[None; N]; n_nodes];
        for (row, direction) in direction.iter().enumerate() {
            if let Some(direction) = direction {
                rows[node_of[row] as usize][*direction] = Some(row);
            }
        }
        let coupled = |own: &[Option<usize>; N]| {
            let mut found: Vec<(u32, u64)> = Vec::new();
            for (i, row) in own.iter().enumerate().filter_map(|(i, row)| row.map(|row| (i, row))) {
                let entries = matrix.outer_view(row);
                for (col, _) in entries.iter().flat_map(|row| row.iter()).filter(|(_, value)| **value != 0.0) {
                    let Some(j) = direction[col] else { continue };
                    let bit = 1 << (N * i + j);
                    // The columns of a node mostly follow each other.
                    match found.last_mut() {
                        Some((node, bits)) if *node == node_of[col] => *bits |= bit,
                        _ => found.push((node_of[col], bit)),
                    }
                }
            }
            found.sort_unstable_by_key(|(node, _)| *node);
            found.dedup_by(|(node, bits), (kept, of_kept)| {
                let is_same = node == kept;
                *of_kept |= if is_same { *bits } else { 0 };
                is_same
            });
            found
        };
        Self { of_node: rows.par_iter().map(coupled).collect(), rows }
    }

    /// The nodes whose rows of some directions are coupled as those of another node, ascending.
    fn strayed(&self, asked: u8) -> Vec<u32> {
        let (across, of_others) = (bits(asked, !asked), bits(!asked, !asked));
        let is_doubtful = |node: &u32| {
            let is_alone =
                |(other, coupled): &(u32, u64)| other != node && coupled & across != 0 && coupled & of_others == 0;
            self.of_node[*node as usize].iter().any(is_alone)
        };
        let doubtful: Vec<u32> = (0..self.of_node.len() as u32).into_par_iter().filter(is_doubtful).collect();
        let (mut strayed, mut taken) = (BTreeSet::new(), BTreeSet::new());
        for node in doubtful {
            let of_node = self.seen(node, asked);
            let found = self.fits(&of_node, asked).into_iter().find(|other| !taken.contains(&other.node));
            let Some(other) = found else { continue };
            taken.insert(other.node);
            strayed.insert(node);
            strayed.extend(other.fits(&of_node).then_some(other.node));
        }
        strayed.into_iter().collect()
    }

    /// The neighbours of a node by the rows asked and by all others.
    fn seen(&self, node: u32, asked: u8) -> Seen {
        let [across, own] =
            [bits(asked, !asked), bits(!asked, !asked)].map(|directions| self.neighbours(node, directions));
        Seen { node, across, own }
    }

    /// Other nodes whose neighbours are those of the rows asked of a node. What a spring or a lever adds to a node comes with the neighbours of
    /// the node itself, and is none, unless the rows of the other node are coupled as those of this one: the two were exchanged.
    fn fits(&self, of_node: &Seen, asked: u8) -> Vec<Seen> {
        let Some(first) = of_node.across.first().filter(|_| of_node.across.len() >= LEAST_COUPLED) else {
            return Vec::new();
        };
        let near = self.neighbours(*first, bits(!asked, !asked)).into_iter();
        let others = near.filter(|other| *other != of_node.node).map(|other| self.seen(other, asked));
        let is_exchanged = |other: &Seen| other.fits(of_node) && !other.has_own();
        others.filter(|other| of_node.fits(other) && (!of_node.has_own() || is_exchanged(other))).collect()
    }

    fn neighbours(&self, node: u32, directions: u64) -> Vec<u32> {
        let of_node = self.of_node[node as usize].iter();
        of_node.filter(|(_, coupled)| coupled & directions != 0).map(|(other, _)| *other).collect()
    }

    /// The first row of a node in one of the directions asked.
    fn row_of(&self, node: u32, asked: u8) -> Option<usize> {
        (0..N).filter(|direction| asked >> direction & 1 == 1).find_map(|direction| self.rows[node as usize][direction])
    }
}

/// What a matrix couples a node with.
struct Seen {
    node: u32,
    /// C_a.
    across: Vec<u32>,
    /// S_a.
    own: Vec<u32>,
}

impl Seen {
    /// Whether the rows asked of this node are coupled with neighbours of another one alone.
    fn fits(&self, other: &Self) -> bool {
        let is_near = |node: &u32| *node == other.node || other.own.binary_search(node).is_ok();
        self.across.len() >= LEAST_COUPLED && self.across.iter().all(is_near)
    }

    /// Whether they are coupled with all neighbours of this node.
    fn has_own(&self) -> bool {
        self.own.iter().all(|node| *node == self.node || self.across.binary_search(node).is_ok())
    }
}

/// The bits of rows by columns of some directions.
fn bits(rows: u8, columns: u8) -> u64 {
    let of_row = u64::from(columns & 0b11_1111);
    (0..N).filter(|row| rows >> row & 1 == 1).fold(0, |bits, row| bits | of_row << (N * row))
}
