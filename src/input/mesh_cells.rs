//! The cells of the mesh that has the nodes of a model, to compare with what its stiffness couples.

use std::path::Path;

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

/// The cells of the file of the nodes, as far as their kinds are known; none where its format has none, and where its layout is not read or
/// they are damaged, which a note says.
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
            let unread = unread.filter(|_| cells.runs.is_empty());
            notes.extend(unread.map(|what| unread_note(format!("supel does not read {what}"))));
            let runs = cells.runs.into_iter();
            Ok(runs.map(|(cell, nodes)| MeshCells { n_nodes: cell.n_nodes(), nodes }).collect())
        }
        // Nothing else of the model needs them.
        Err(error) if error.class() == ErrorClass::InputData => {
            notes.push(unread_note(error.to_string()));
            Ok(Vec::new())
        }
        Err(error) => Err(error),
    }
}
