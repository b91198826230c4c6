//! The layouts of meshes in HDF5, one line each; the content tells which one a file has.

use super::group::{Group, Member};
use super::mesh::Mesh;
use super::{cgns, exodus, hmf, med, med_cells, moab, moab_cells, vtkhdf};
use crate::error::{Error, Result};
use crate::input::cell_kind::Known;
use crate::input::faces::Gathered;

/// A layout of a mesh in HDF5.
pub(super) struct Layout {
    is_of: fn(&Group<'_>) -> Result<bool>,
    /// Reads nodes and groups.
    pub(super) nodes: fn(&Group<'_>) -> Result<Mesh>,
    /// Takes up the faces of patches.
    pub(super) cells: fn(&Group<'_>, &mut Gathered<'_>) -> Result<Known>,
}

/// The layouts, the more particular first.
const LAYOUTS: [Layout; 6] = [
    Layout { is_of: |root| has_group(root, "ENS_MAA"), nodes: med::read, cells: med_cells::read },
    Layout { is_of: |root| has_group(root, "tstt"), nodes: moab::read, cells: moab_cells::read },
    Layout { is_of: |root| has_group(root, "VTKHDF"), nodes: vtkhdf::read, cells: vtkhdf::read_cells },
    Layout { is_of: exodus::is_of, nodes: exodus::read, cells: exodus::read_cells },
    Layout { is_of: cgns::is_of, nodes: cgns::read, cells: cgns::read_cells },
    Layout { is_of: hmf::is_of, nodes: hmf::read, cells: hmf::read_cells },
];

fn has_group(root: &Group<'_>, name: &str) -> Result<bool> {
    Ok(root.member(name)? == Some(Member::Group))
}

/// The layout of a file.
///
/// # Errors
/// [`Error::MeshUnknown`] where the file has none of them; those of reading.
pub(super) fn of(root: &Group<'_>) -> Result<&'static Layout> {
    for layout in &LAYOUTS {
        if (layout.is_of)(root)? {
            return Ok(layout);
        }
    }
    let holds = root.members()?.into_iter().map(|(name, _)| root.child_name(&name)).collect();
    Err(Error::MeshUnknown { path: root.h5().path().to_owned(), holds })
}
