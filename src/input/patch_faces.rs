//! Which patches need the cells of a mesh, and their faces.

use serde::{Deserialize, Serialize};

use super::patch::{PatchFaces, Patches};
use super::{Allowance, formats};
use crate::error::Result;
use crate::job::{Coupling, InterfaceJob, Job, ModelJob, NodeSelection, Origin, Weights};
use crate::regular_file::unchanged;

/// Whether the cells of a mesh are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cells {
    /// A patch may need them, a pressure, or a picture of recovered nodes.
    Wanted,
    /// Nothing does.
    Unwanted,
}

impl Cells {
    /// What a job may need, and the file of its nodes may have.
    pub fn of(job: &Job) -> Self {
        let is_mesh = job
            .model
            .nodes
            .as_deref()
            .and_then(|path| formats::of_nodes(path).ok())
            .is_some_and(|format| format.has_cells());
        let is_wanted = job.interfaces.iter().any(looks_at_faces)
            || job.loads.iter().any(|load| load.pressure.is_some())
            || job.write.recovery.is_some();
        if is_mesh && is_wanted { Self::Wanted } else { Self::Unwanted }
    }
}

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
