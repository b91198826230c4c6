//! The cells of the mesh that has the nodes of a model, to compare with what its stiffness couples.

use std::path::Path;

use super::faces::CellList;
use super::format::ReadCells;
use super::note::InputNote;
use super::{Allowance, formats};
use crate::dofs::Nodes;
use crate::error::{ErrorClass, Result};
use crate::regular_file::unchanged;

/// Cells with one number of nodes that follow each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshCells {
    /// Nodes of a cell.
    pub n_nodes: usize,
    /// Indices of the nodes, cell after cell.
    pub nodes: Vec<u32>,
}

/// The cells of the file of the nodes, of known kinds or of any that a table has; none where its format has none, and where its layout is
/// not read or they are damaged, which a note says.
///
/// # Errors
/// A file that cannot be read or changes meanwhile, more data than `allowance` has room for.
pub(super) fn mesh_cells(
    (path, nodes): (&Path, &Nodes),
    allowance: &Allowance,
    notes: &mut Vec<InputNote>,
) -> Result<Vec<MeshCells>> {
    let format = formats::of_nodes(path)?;
    if !format.has_cells() {
        return Ok(Vec::new());
    }
    let unread_note = |why: String| InputNote::CellsUnread { path: path.to_owned(), why };
    match unchanged(path, || format.read_cells(path, &nodes.coordinates, allowance)) {
        Ok(ReadCells { cells, unread }) => {
            let found = listed(cells);
            let unread = unread.filter(|_| found.is_empty());
            notes.extend(unread.map(|what| unread_note(format!("supel does not read {what}"))));
            Ok(found)
        }
        // Nothing else of the model needs them.
        Err(error) if error.class() == ErrorClass::InputData => {
            notes.push(unread_note(error.to_string()));
            Ok(Vec::new())
        }
        Err(error) => Err(error),
    }
}

fn listed(cells: CellList) -> Vec<MeshCells> {
    let of_runs = cells.runs.into_iter().map(|(cell, nodes)| MeshCells { n_nodes: cell.n_nodes(), nodes });
    #[cfg(feature = "hdf5")]
    let of_runs = of_runs.chain(cells.tables.into_iter().map(|(n_nodes, nodes)| MeshCells { n_nodes, nodes }));
    of_runs.collect()
}
