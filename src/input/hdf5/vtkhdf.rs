//! VTKHDF: an unstructured grid in one or several parts; of a series in time the first step.

use super::attribute;
use super::attribute_groups::tags_of;
use super::group::Group;
use super::mesh::Mesh;
use crate::error::{Error, Result};
use crate::input::cell_kind::Known;
use crate::input::faces::Gathered;
use crate::input::mesh::CellMesh;
use crate::input::mesh::vtk::{Piece, Pieces, Tags};

const ROOT: &str = "VTKHDF";
/// The attribute of a mesh that supel wrote: labels are in the array [`LABELS`], and every other one is a group.
pub(crate) const MESH_OF_SUPEL: &str = "SupelMesh";
/// The attribute of an array that has another name than its group: the bytes of that.
pub(crate) const GROUP_NAME: &str = "SupelGroup";
/// The array of labels in such a mesh.
pub(crate) const LABELS: &str = "node";

/// Reads points and the groups that arrays of whole numbers make; of a mesh that supel wrote its labels and groups.
pub(super) fn read(root: &Group<'_>) -> Result<Mesh> {
    let CellMesh { nodes, .. } = grid(root)?;
    let group = root.group(ROOT)?;
    let is_own = attribute::integers(root.h5(), group.location(), group.name(), MESH_OF_SUPEL)?.is_some();
    let mut tags = if is_own { tags_of(group.find_group("PointData")?)? } else { Tags::new() };
    match tags.remove(LABELS) {
        Some(labels) => {
            let labels = Some((labels, format!("/{ROOT}/PointData/{LABELS}")));
            let (coordinates, source) = (nodes.coordinates, format!("/{ROOT}/Points"));
            let data = group.group("PointData")?;
            let named = |(array, marks): (String, Vec<i64>)| {
                let name = data.dataset(&array)?.integer_list_attribute(GROUP_NAME)?;
                let name = name.and_then(|bytes| bytes.iter().map(|byte| u8::try_from(*byte).ok()).collect());
                let name = name.and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or(array);
                Ok((name, members(&marks, coordinates.len())))
            };
            let groups = tags.into_iter().map(named).collect::<Result<_>>()?;
            Ok(Mesh { labels, coordinates, source, groups })
        }
        None => {
            let source = format!("/{ROOT}/Points");
            Ok(Mesh { labels: None, coordinates: nodes.coordinates, source, groups: nodes.groups })
        }
    }
}

/// The nodes that a mark other than zero makes members of a group.
fn members(marks: &[i64], n_nodes: usize) -> Vec<usize> {
    marks.iter().take(n_nodes).enumerate().filter(|(_, mark)| **mark != 0).map(|(node, _)| node).collect()
}

pub(super) fn read_cells(root: &Group<'_>, faces: &mut Gathered<'_>) -> Result<Known> {
    let grid = grid(root)?;
    if let Some(unread) = grid.unread {
        return Ok(Known::Not(unread));
    }
    grid.cells.iter().try_for_each(|cells| cells.each(|cell, nodes| faces.add(cell, nodes)))?;
    Ok(Known::All)
}

fn grid(root: &Group<'_>) -> Result<CellMesh> {
    let group = root.group(ROOT)?;
    if group.find_dataset("Points")?.is_none() || group.find_dataset("Types")?.is_none() {
        let (path, object) = (root.h5().path().to_owned(), group.name().to_owned());
        let found = "a file of another type".to_owned();
        return Err(Error::MeshUnsupported {
            path,
            object,
            found,
            expected: "an unstructured grid, with Points and Types",
        });
    }
    let (n_points, n_cells) = (counts(&group, "NumberOfPoints")?, counts(&group, "NumberOfCells")?);
    let n_numbers = counts(&group, "NumberOfConnectivityIds")?;
    let n_parts = n_parts_of_first_step(&group)?.unwrap_or(n_points.len());
    let points = group.dataset("Points")?.reals()?.values;
    let connectivity = group.dataset("Connectivity")?.integers()?;
    let (offsets, types) = (group.dataset("Offsets")?.integers()?, group.dataset("Types")?.integers()?);
    let (point_tags, cell_tags) = (tags_of(group.find_group("PointData")?)?, tags_of(group.find_group("CellData")?)?);
    let mut pieces = Pieces::default();
    let mut at = [0_usize; 4];
    for part in 0..n_parts {
        let sizes = [&n_points, &n_cells, &n_numbers].map(|counts| counts.get(part).copied());
        let [Some(n_points), Some(n_cells), Some(n_numbers)] = sizes else {
            let dataset = group.dataset("NumberOfPoints")?;
            return Err(dataset.wrong_shape(format!("no number for part {part}"), "one for each part".to_owned()));
        };
        let sizes = [n_points, n_cells, n_numbers, n_cells.saturating_add(1)];
        let ends: Vec<usize> = at.iter().zip(sizes).map(|(at, size)| at.saturating_add(size)).collect();
        let of_part = |tags: &Tags, range: std::ops::Range<usize>| -> Tags {
            tags.iter().filter_map(|(name, values)| Some((name.clone(), values.get(range.clone())?.to_vec()))).collect()
        };
        let short = |name: &str| {
            let dataset = group.dataset(name);
            dataset.map(|dataset| dataset.wrong_shape("too few values".to_owned(), format!("those of part {part}")))
        };
        let Some(own) = points.get(3 * at[0]..3_usize.saturating_mul(ends[0])) else { return Err(short("Points")?) };
        let Some(own_types) = types.get(at[1]..ends[1]) else { return Err(short("Types")?) };
        let Some(numbers) = connectivity.get(at[2]..ends[2]) else { return Err(short("Connectivity")?) };
        let Some(own_offsets) = offsets.get(at[3]..ends[3]) else { return Err(short("Offsets")?) };
        let piece = Piece {
            points: own.to_vec(),
            connectivity: numbers.to_vec(),
            offsets: own_offsets.to_vec(),
            types: own_types.to_vec(),
            point_tags: of_part(&point_tags, at[0]..ends[0]),
            cell_tags: of_part(&cell_tags, at[1]..ends[1]),
        };
        pieces.add(piece).map_err(|(found, expected)| Error::Hdf5Shape {
            path: root.h5().path().to_owned(),
            object: group.name().to_owned(),
            found,
            expected,
        })?;
        at = [ends[0], ends[1], ends[2], ends[3]];
    }
    Ok(pieces.into_mesh())
}

/// Numbers of things, one for each part.
fn counts(group: &Group<'_>, name: &str) -> Result<Vec<usize>> {
    let counts = group.dataset(name)?.integers()?;
    Ok(counts.into_iter().map(|n| usize::try_from(n).unwrap_or(usize::MAX)).collect())
}

/// The parts of the first step, where there are steps: later ones move the points or bring other ones.
fn n_parts_of_first_step(group: &Group<'_>) -> Result<Option<usize>> {
    let Some(steps) = group.find_group("Steps")? else { return Ok(None) };
    let Some(parts) = steps.find_dataset("NumberOfParts")? else { return Ok(Some(1)) };
    Ok(Some(parts.integers()?.first().map_or(1, |n| usize::try_from(*n).unwrap_or(0))))
}
