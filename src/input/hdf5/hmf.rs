//! `.hmf`: XDMF's model written into HDF5 itself, the self-contained format of meshio.

use super::cells::Known;
use super::dataset::Dataset;
use super::faces::Gathered;
use super::group::{Group, Member};
use super::mesh::{Mesh, points_of_rows};
use crate::error::Result;

const GEOMETRY: &str = "domain/grid/Geometry";

/// Whether a file has the dataset that makes it one of this format.
pub(super) fn is_of(root: &Group<'_>) -> Result<bool> {
    Ok(root.member("domain")? == Some(Member::Group) && root.find_dataset(GEOMETRY)?.is_some())
}

/// Reads the geometry, one row for each node.
pub(super) fn read(root: &Group<'_>) -> Result<Mesh> {
    let geometry: Dataset<'_> = root.dataset(GEOMETRY)?;
    Ok(Mesh::of_points(points_of_rows(&geometry)?, geometry.name().to_owned()))
}

/// The kinds of cells are texts of attributes, which are not read.
pub(super) fn read_cells(_: &Group<'_>, _: &mut Gathered<'_>) -> Result<Known> {
    Ok(Known::Not("a table of cells in the layout of .hmf".to_owned()))
}
