//! Which patches look at the faces of a mesh, and these.

use super::patch::{PatchFaces, Patches};
use super::{Allowance, formats};
use crate::error::Result;
use crate::job::{Coupling, InterfaceJob, ModelJob, NodeSelection, Origin, Weights};
use crate::regular_file::unchanged;

/// Whether the faces between the nodes of an interface tell something of it: its weights, its origin, or how far that is from their
/// centroid.
pub fn looks_at_faces(interface: &InterfaceJob) -> bool {
    let is_one = matches!(&interface.nodes, NodeSelection::Labels(labels) if labels.len() < 2);
    // Where the job names no weights, quadratic faces say that equal ones are poor.
    let weighs = interface.weights == Some(Weights::Area)
        || interface.coupling == Coupling::Average && interface.weights.is_none();
    let tell = matches!(interface.origin, Origin::Centroid | Origin::Area) || weighs;
    interface.coupling.is_patch() && tell && !is_one
}

/// What the cells in the file of the nodes tell of the faces of each patch; patches without faces are left out.
///
/// # Errors
/// Cells that cannot be those of the nodes, a file that cannot be read or changes meanwhile, more data than `allowance` has room for.
pub fn patch_faces(model: &ModelJob, patches: &Patches<'_>, allowance: &Allowance) -> Result<Vec<PatchFaces>> {
    match &model.nodes {
        Some(path) if !patches.list.is_empty() => {
            let format = formats::of_nodes(path)?;
            if format.has_cells() {
                unchanged(path, || format.read_faces(path, patches, allowance))
            } else {
                Ok(Vec::new())
            }
        }
        _ => Ok(Vec::new()),
    }
}
