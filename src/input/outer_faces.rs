//! The outer surface of a mesh: faces of its volume cells that occur once, and cells of surfaces elsewhere.

use super::patch::{Face, Faces, Patch, Patches};
use super::patch_faces::patch_faces;
use super::{Allowance, formats};
use crate::dofs::Nodes;
use crate::error::{Result, Selector};
use crate::job::ModelJob;

/// The outer faces of the mesh that has the nodes, by the indices of these; nothing where it has no cells, or they leave them unknown.
///
/// # Errors
/// Those of reading the cells.
pub fn outer_faces(model: &ModelJob, nodes: &Nodes, allowance: &Allowance) -> Result<Vec<Face>> {
    let has_cells = |path: &std::path::PathBuf| formats::of_nodes(path).map(|format| format.has_cells());
    if !model.nodes.as_ref().map(has_cells).transpose()?.unwrap_or(false) || nodes.labels.is_empty() {
        return Ok(Vec::new());
    }
    let whole = Patch { of: Selector::Interface("surface".to_owned()), nodes: (0..nodes.labels.len()).collect() };
    let found = patch_faces(model, &Patches { list: vec![whole], coordinates: &nodes.coordinates }, allowance)?;
    Ok(match found.into_iter().next().map(|patch| patch.faces) {
        Some(Faces::Known { faces, .. }) => faces,
        Some(Faces::Unknown { .. }) | None => Vec::new(),
    })
}
