//! Bodies: the connected parts of the model.
//!
//! Connection is judged between nodes, not between rows: the axial and the bending rows of a straight beam are not
//! coupled in K and yet belong to one body.

use std::collections::{HashMap, HashSet};

use crate::dofs::Dof;
use crate::sparse::SparseMatrix;

/// The connected parts of the node graph of K.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bodies {
    /// Body of each row.
    pub of_row: Vec<u32>,
    /// How many there are.
    pub n_bodies: usize,
}

impl Bodies {
    /// Finds the parts by union of the nodes that share an entry of K.
    pub fn of(stiffness: &SparseMatrix, node_of_row: &[u32]) -> Self {
        let mut parent = joined(stiffness, node_of_row, |_| true);
        let mut number = HashMap::new();
        let of_row = node_of_row
            .iter()
            .map(|node| {
                let next = number.len() as u32;
                *number.entry(root(&mut parent, *node)).or_insert(next)
            })
            .collect();
        Self { of_row, n_bodies: number.len() }
    }

    /// How many parts there are of the rows that a condition keeps.
    pub fn count_among(stiffness: &SparseMatrix, node_of_row: &[u32], is_kept: impl Fn(usize) -> bool) -> usize {
        let mut parent = joined(stiffness, node_of_row, &is_kept);
        let kept = (0..node_of_row.len()).filter(|row| is_kept(*row));
        kept.map(|row| root(&mut parent, node_of_row[row])).collect::<HashSet<u32>>().len()
    }
}

/// The nodes as a forest whose trees are the parts.
fn joined(stiffness: &SparseMatrix, node_of_row: &[u32], is_kept: impl Fn(usize) -> bool) -> Vec<u32> {
    let n_nodes = node_of_row.iter().max().map_or(0, |max| *max as usize + 1);
    let mut parent: Vec<u32> = (0..n_nodes as u32).collect();
    for (row, view) in stiffness.outer_iterator().enumerate().filter(|(row, _)| is_kept(*row)) {
        for (col, value) in view.iter() {
            if *value != 0.0 && col < row && is_kept(col) {
                let (a, b) = (root(&mut parent, node_of_row[row]), root(&mut parent, node_of_row[col]));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
    }
    parent
}

/// A dense number for the node of each row, in order of first appearance; every row its own node where no map is known, and every
/// scalar dof.
pub fn node_of_row(n_rows: usize, dofs: Option<&[Option<Dof>]>) -> Vec<u32> {
    let Some(dofs) = dofs else {
        return (0..n_rows as u32).collect();
    };
    let mut number = HashMap::with_capacity(n_rows / 3 + 1);
    let mut n_nodes = 0;
    let mut next = || {
        n_nodes += 1;
        n_nodes - 1
    };
    dofs.iter()
        .map(|dof| match dof {
            Some(dof) => *number.entry(dof.node).or_insert_with(&mut next),
            None => next(),
        })
        .collect()
}

fn root(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        let grandparent = parent[parent[node as usize] as usize];
        parent[node as usize] = grandparent;
        node = grandparent;
    }
    node
}
