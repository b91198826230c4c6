//! `.hmf`: XDMF's model written into HDF5 itself, the self-contained format of meshio.

use super::dataset::Dataset;
use super::group::{Group, Member};
use super::mesh::{Mesh, points_of_rows};
use crate::error::Result;

/// The dataset that makes a file one of this format.
pub(super) fn find<'a>(root: &Group<'a>) -> Result<Option<Dataset<'a>>> {
    if root.member("domain")? == Some(Member::Group) { root.find_dataset("domain/grid/Geometry") } else { Ok(None) }
}

/// Reads the geometry, one row for each node.
pub(super) fn read(geometry: &Dataset<'_>) -> Result<Mesh> {
    Ok(Mesh::of_points(points_of_rows(geometry)?, geometry.name().to_owned()))
}
