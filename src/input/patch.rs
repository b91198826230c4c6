//! Rigid patches whose origin is the mean of their nodes, and the centroid of the faces between these nodes.
//!
//! The mean counts every node once, however large the faces around it are: on a graded mesh the two are at different places.

use serde::{Deserialize, Serialize};

use super::Allowance;
use crate::error::Result;
use crate::job::{Coupling, InterfaceJob, Job, ModelJob, NodeSelection, Origin};

/// The nodes of a rigid patch without an origin of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Name of its interface.
    pub interface: String,
    /// Indices of its nodes in the file of the nodes.
    pub nodes: Vec<usize>,
    /// Where each of them is.
    pub positions: Vec<[f64; 3]>,
}

/// The patches of a job whose faces are looked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patches {
    /// Each with two or more nodes; no node belongs to two.
    pub list: Vec<Patch>,
    /// Nodes of the file.
    pub n_nodes: usize,
}

/// The faces of a patch: cells of surfaces, and outer faces of volume cells, all of whose nodes belong to it.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchFaces {
    /// Name of its interface.
    pub interface: String,
    /// How many there are.
    pub n_faces: usize,
    /// Their area-weighted centroid.
    pub centroid: [f64; 3],
}

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
    interface.coupling == Coupling::Rigid && interface.origin == Origin::Centroid && !is_one
}

/// The faces of each patch, as far as the file of the nodes has cells; patches without faces are left out.
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
