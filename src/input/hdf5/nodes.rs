//! Nodes of a mesh in one of the formats that live in HDF5; the content tells which.

use std::path::Path;

use super::file::{H5, with_memory};
use super::{layout, xdmf};
use crate::dofs::Nodes;
use crate::error::Result;
use crate::input::Allowance;
use crate::input::file_start::FileStart;
use crate::input::hdf5::group::Group;
use crate::input::hdf5::mesh::Mesh;
use crate::input::unsupported_format::{self, Wanted};

/// Bytes of a node: position, label, and the labels once more while they are compared.
const NODE: u64 = 40;

/// Reads the nodes of a mesh: `.hmf`, XDMF with its `.h5`, `.med` with its node and element groups, `.h5m` (MOAB).
///
/// Labels are those of the file, or 1 to N where the format has none. Missing coordinates of a mesh in the plane or on a
/// line are zero. A group of elements becomes the group of their nodes; where a group of nodes has the same name and
/// other nodes, the element group is called `NAME (elements)`.
///
/// # Errors
///
/// The file cannot be read, holds no mesh of these formats or several, refers to data outside its folder, or has
/// coordinates, labels or node numbers that cannot be right.
pub fn read_nodes(path: &Path) -> Result<Nodes> {
    unsupported_format::refuse(&FileStart::of(path)?, Wanted::Table)?;
    read_nodes_within(path, &Allowance::of(None)).map(|(nodes, _)| nodes)
}

/// [`read_nodes`] of a file that is no other known format, in the memory that is allowed, and the digest of the file that an XDMF refers to.
///
/// # Errors
///
/// [`crate::error::Error::MemoryRead`] and those of [`read_nodes`].
pub(crate) fn read_nodes_within(path: &Path, allowance: &Allowance) -> Result<(Nodes, Option<String>)> {
    let (mesh, digest) = if is_xml(path)? {
        xdmf::read(path, allowance)?
    } else {
        (with_memory(path, || read_hdf5(path, allowance))?, None)
    };
    Ok((mesh.into_nodes(path)?, digest))
}

/// The files that a mesh in XML refers to, where they can be told.
pub(crate) fn referenced_files(path: &Path) -> Vec<std::path::PathBuf> {
    if is_xml(path).unwrap_or(false) { xdmf::referenced_files(path) } else { Vec::new() }
}

/// The digest of the file that a mesh in XML takes its geometry from now; none where that is in itself.
///
/// # Errors
///
/// A file that cannot be read.
pub(crate) fn data_digest(path: &Path) -> Result<Option<String>> {
    if is_xml(path)? { xdmf::data_digest(path) } else { Ok(None) }
}

/// True if the first character that is not a blank opens a tag, or if the file is called XDMF and is empty.
pub(super) fn is_xml(path: &Path) -> Result<bool> {
    let start = FileStart::of(path)?;
    let is_empty = start.head.is_empty() && path.extension().is_some_and(|name| name == "xdmf" || name == "xmf");
    Ok(start.is_xml() || is_empty)
}

fn read_hdf5(path: &Path, allowance: &Allowance) -> Result<Mesh> {
    let h5 = H5::open(path, allowance)?;
    let root = Group::root(&h5)?;
    let mesh = (layout::of(&root)?.nodes)(&root)?;
    h5.hold(NODE * mesh.coordinates.len() as u64)?;
    Ok(mesh)
}
