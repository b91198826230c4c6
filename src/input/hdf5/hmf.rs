//! `.hmf`: XDMF's model written into HDF5 itself, the self-contained format of meshio.

use std::collections::BTreeMap;

use super::attribute_groups::tags_of;
use super::cells::add_table;
use super::dataset::Dataset;
use super::group::{Group, Member};
use super::mesh::{Mesh, points_of_rows};
use crate::error::Result;
use crate::input::cell_kind::Known;
use crate::input::faces::Gathered;
use crate::input::mesh::named_apart;
use crate::input::tag_groups::tag_groups;

const GRID: &str = "domain/grid";

/// Whether a file has the dataset that makes it one of this format.
pub(super) fn is_of(root: &Group<'_>) -> Result<bool> {
    let has_domain = root.member("domain")? == Some(Member::Group);
    Ok(has_domain && root.find_dataset(&format!("{GRID}/Geometry"))?.is_some())
}

/// Reads the geometry, one row for each node, and the groups that arrays of whole numbers make.
pub(super) fn read(root: &Group<'_>) -> Result<Mesh> {
    let grid = root.group(GRID)?;
    let geometry: Dataset<'_> = grid.dataset("Geometry")?;
    let coordinates = points_of_rows(&geometry)?;
    let n_nodes = coordinates.len();
    let of_nodes = tags_of(grid.find_group("NodeAttributes")?)?;
    let of_nodes = of_nodes.iter().filter(|(_, tags)| tags.len() == n_nodes);
    let of_nodes = of_nodes.flat_map(|(name, tags)| tag_groups(name, tags)).collect();
    let of_cells = tags_of(grid.find_group("CellAttributes")?)?;
    let of_cells = if of_cells.is_empty() { BTreeMap::new() } else { cell_groups(&grid, &of_cells, n_nodes)? };
    let groups = named_apart(of_nodes, [("elements", of_cells)]);
    Ok(Mesh { labels: None, coordinates, source: geometry.name().to_owned(), groups })
}

/// The tables of cells, in the order of the numbers in their names.
fn tables<'a>(grid: &Group<'a>) -> Result<Vec<Dataset<'a>>> {
    let number = |name: &str| name.strip_prefix("Topology").and_then(|number| number.parse::<usize>().ok());
    let mut numbers: Vec<usize> = grid.members()?.iter().filter_map(|(name, _)| number(name)).collect();
    numbers.sort_unstable();
    numbers.iter().map(|number| grid.dataset(&format!("Topology{number}"))).collect()
}

/// The nodes of the cells of each group. Cells are numbered through all tables.
fn cell_groups(
    grid: &Group<'_>,
    tags: &BTreeMap<String, Vec<i64>>,
    n_nodes: usize,
) -> Result<BTreeMap<String, Vec<usize>>> {
    let mut nodes_of: Vec<Vec<usize>> = Vec::new();
    for dataset in tables(grid)? {
        let n_each = dataset.shape()?.get(1).copied().unwrap_or(1).max(1);
        nodes_of.extend(dataset.checked_indices(0, n_nodes)?.chunks(n_each).map(<[usize]>::to_vec));
    }
    let of_all = tags.iter().filter(|(_, tags)| tags.len() == nodes_of.len());
    let groups = of_all.flat_map(|(name, tags)| tag_groups(name, tags)).map(|(name, cells)| {
        let mut nodes: Vec<usize> = cells.into_iter().flat_map(|cell| nodes_of[cell].iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        (name, nodes)
    });
    Ok(groups.collect())
}

/// Tables of cells without their kinds, which are texts of attributes that are not read.
pub(super) fn read_cells(root: &Group<'_>, cells: &mut Gathered<'_>) -> Result<Known> {
    for table in tables(&root.group(GRID)?)? {
        add_table(cells, &table, 0)?;
    }
    Ok(Known::Not("the kinds of cells in the layout of .hmf".to_owned()))
}
