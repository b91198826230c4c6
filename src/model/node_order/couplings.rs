//! Which nodes a matrix couples, and by which directions.

use rayon::prelude::*;

use crate::dofs::Dof;
use crate::sparse::SparseMatrix;

/// Directions of a node.
const N: usize = 6;
/// Columns without a direction, as another one of the columns.
const NO_DIRECTION: usize = N;

/// The nodes that a matrix couples with each node, and the directions that it couples.
pub(super) struct Couplings {
    /// Of each node itself and the others with the directions coupled, row by column, as bits; ascending.
    of_node: Vec<Vec<(u32, u64)>>,
    /// The rows of each node, ascending.
    rows: Vec<Vec<u32>>,
}

impl Couplings {
    /// Couplings of a matrix. `node_of` has the number of the node of each row, `dofs` its direction, where known.
    pub(super) fn of(matrix: &SparseMatrix, node_of: &[u32], dofs: Option<&[Option<Dof>]>) -> Self {
        let n_nodes = node_of.iter().max().map_or(0, |max| *max as usize + 1);
        let mut rows = vec![Vec::new(); n_nodes];
        node_of.iter().enumerate().for_each(|(row, node)| rows[*node as usize].push(row as u32));
        let direction = |row: usize| dofs.and_then(|dofs| dofs[row]).map(|dof| dof.direction as usize);
        let columns: Vec<(u32, u8)> = node_of
            .iter()
            .enumerate()
            .map(|(col, node)| (*node, direction(col).unwrap_or(NO_DIRECTION) as u8))
            .collect();
        let coupled = |own: &Vec<u32>| {
            let mut found: Vec<(u32, u64)> = Vec::new();
            for row in own {
                let of_row = direction(*row as usize).unwrap_or(NO_DIRECTION);
                let entries = matrix.outer_view(*row as usize);
                for (col, _) in entries.iter().flat_map(|row| row.iter()).filter(|(_, value)| **value != 0.0) {
                    let (node, of_column) = columns[col];
                    let bit = 1 << place(of_row, of_column.into());
                    // The columns of a node mostly follow each other.
                    match found.last_mut() {
                        Some((last, bits)) if *last == node => *bits |= bit,
                        _ => found.push((node, bit)),
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

    pub(super) fn n_nodes(&self) -> usize {
        self.of_node.len()
    }

    /// The nodes coupled with a node, itself included where it is, and by which directions.
    pub(super) fn at(&self, node: u32) -> &[(u32, u64)] {
        &self.of_node[node as usize]
    }

    /// The other nodes coupled with a node, ascending.
    pub(super) fn others(&self, node: u32) -> impl Iterator<Item = u32> {
        self.at(node).iter().map(|(other, _)| *other).filter(move |other| *other != node)
    }

    /// Whether a node is coupled with another one.
    pub(super) fn is_coupled(&self, node: u32) -> bool {
        self.others(node).next().is_some()
    }

    /// The nodes coupled with a node by some directions, ascending.
    pub(super) fn by(&self, node: u32, directions: u64) -> Vec<u32> {
        let coupled = self.at(node).iter().filter(|(_, coupled)| coupled & directions != 0);
        coupled.map(|(other, _)| *other).collect()
    }

    /// Whether some directions couple a node with another one.
    pub(super) fn is_any_by(&self, directions: u64) -> bool {
        let couples = |node: u32| self.at(node).iter().any(|(other, bits)| *other != node && bits & directions != 0);
        (0..self.n_nodes() as u32).into_par_iter().any(couples)
    }

    /// The rows of a node, ascending.
    pub(super) fn rows(&self, node: u32) -> impl Iterator<Item = usize> {
        self.rows[node as usize].iter().map(|row| *row as usize)
    }
}

/// The bits of rows by columns of some directions, each as a bit of `ux` to `rz`.
pub(super) fn bits(rows: u8, columns: u8) -> u64 {
    let pairs = (0..N).flat_map(|row| (0..N).map(move |column| (row, column)));
    let asked = pairs.filter(|(row, column)| rows >> row & 1 == 1 && columns >> column & 1 == 1);
    asked.fold(0, |bits, (row, column)| bits | 1 << place(row, column))
}

/// The bits of rows of some directions by all columns.
pub(super) fn bits_of_rows(rows: u8) -> u64 {
    let of_row = |row: usize| (0..=NO_DIRECTION).fold(0, |bits, column| bits | 1 << place(row, column));
    (0..N).filter(|row| rows >> row & 1 == 1).fold(0, |bits, row| bits | of_row(row))
}

/// The bit of a row by a column.
fn place(row: usize, column: usize) -> usize {
    (N + 1) * row + column
}
