//! The cells of a mesh with the indices of their nodes, as a format lists them.

use super::cell::Cell;

/// Cells one after another.
#[derive(Debug, Default)]
pub(in super::super) struct CellList {
    /// Cells of one kind that follow each other, with the nodes of each.
    pub(in super::super) runs: Vec<(Cell, Vec<u32>)>,
    /// Cells whose kind is not read: how many nodes each of a table has, with the nodes of all.
    #[cfg(feature = "hdf5")]
    pub(in super::super) tables: Vec<(usize, Vec<u32>)>,
}

impl CellList {
    /// Adds cells of one kind with the nodes of each.
    pub(in super::super) fn extend(&mut self, cell: Cell, nodes: impl IntoIterator<Item = u32>) {
        match self.runs.last_mut() {
            Some((last, listed)) if *last == cell => listed.extend(nodes),
            _ => self.runs.push((cell, nodes.into_iter().collect())),
        }
    }
}
