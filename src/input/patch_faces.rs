//! Which patches need the cells of a mesh, and their faces.

use serde::{Deserialize, Serialize};

use super::Allowance;
use super::patch::{PatchFaces, Patches};
use crate::error::Result;
use crate::job::{InterfaceJob, Job, ModelJob, NodeSelection, Origin};

/// Whether the cells of a mesh are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cells {
    /// A patch may need them.
    Wanted,
    /// No patch does.
    Unwanted,
}

impl Cells {
    /// What the interfaces of a job may need, and the file of its nodes may have.
    pub fn of(job: &Job) -> Self {
        let is_mesh = job.model.nodes.as_deref().is_some_and(super::kind::is_hdf5_mesh);
        if is_mesh && job.interfaces.iter().any(has_mean_origin) { Self::Wanted } else { Self::Unwanted }
    }
}

/// Whether the origin of an interface is the mean of several nodes.
pub fn has_mean_origin(interface: &InterfaceJob) -> bool {
    let is_one = matches!(&interface.nodes, NodeSelection::Labels(labels) if labels.len() < 2);
    interface.coupling.is_patch() && interface.origin == Origin::Centroid && !is_one
}

/// What the cells in the file of the nodes tell of the faces of each patch; patches without faces are left out.
///
/// # Errors
/// Cells that cannot be those of the nodes, a file that cannot be read or changes meanwhile, more data than `allowance` has room for.
pub fn patch_faces(model: &ModelJob, patches: &Patches, allowance: &Allowance) -> Result<Vec<PatchFaces>> {
    match &model.nodes {
        Some(path) if !patches.list.is_empty() => of_mesh(path, patches, allowance),
        _ => Ok(Vec::new()),
    }
}

#[cfg(feature = "hdf5")]
fn of_mesh(path: &std::path::Path, patches: &Patches, allowance: &Allowance) -> Result<Vec<PatchFaces>> {
    if !super::kind::is_hdf5_mesh(path) {
        return Ok(Vec::new());
    }
    crate::regular_file::unchanged(path, || super::hdf5::read_faces(path, patches, allowance))
}

/// Tables of nodes have no cells.
#[cfg(not(feature = "hdf5"))]
fn of_mesh(_: &std::path::Path, _: &Patches, _: &Allowance) -> Result<Vec<PatchFaces>> {
    Ok(Vec::new())
}
