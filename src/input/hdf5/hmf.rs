//! `.hmf`: XDMF's model written into HDF5 itself, the self-contained format of meshio.

use super::file::Group;
use super::mesh::{Mesh, points_of_rows};
use crate::error::Result;

/// Reads `/domain/grid/Geometry`, one row for each node.
pub(super) fn read(root: &Group<'_>) -> Result<Mesh> {
    let geometry = root.group("domain/grid")?.dataset("Geometry")?;
    Ok(Mesh::of_points(points_of_rows(&geometry)?, geometry.name().to_owned()))
}
