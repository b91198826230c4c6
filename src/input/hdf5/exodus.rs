//! Exodus in netCDF-4, which is HDF5: nodes, sets of nodes and blocks of elements.
//!
//! The kinds of elements are texts of attributes, which are not read, so that no face is known; which nodes each element has is. Classic
//! netCDF is no HDF5.

use std::collections::BTreeMap;

use super::cells::add_table;
use super::dataset::Dataset;
use super::group::{Group, Member};
use super::mesh::{Mesh, points};
use crate::error::Result;
use crate::input::cell_kind::Known;
use crate::input::faces::Gathered;
use crate::input::mesh::named_apart;
use crate::number::counted;

/// Whether a file has the datasets that make it one of this format.
pub(super) fn is_of(root: &Group<'_>) -> Result<bool> {
    let has_nodes = root.member("coord")? == Some(Member::Dataset) || root.member("coordx")? == Some(Member::Dataset);
    Ok(has_nodes && root.member("num_nodes")? == Some(Member::Dataset))
}

/// Reads nodes with their numbers of the map of nodes, sets of nodes, and blocks of elements.
pub(super) fn read(root: &Group<'_>) -> Result<Mesh> {
    let (coordinates, source) = coordinates(root)?;
    let labels = match root.find_dataset("node_num_map")? {
        Some(map) => Some((map.integers()?, map.name().to_owned())),
        None => None,
    };
    let n_nodes = coordinates.len();
    let of_nodes = groups(root, ("node_ns", "ns_names", "ns_prop1", "node set"), n_nodes)?;
    let of_blocks = groups(root, ("connect", "eb_names", "eb_prop1", "block"), n_nodes)?;
    Ok(Mesh { labels, coordinates, source, groups: named_apart(of_nodes, [("elements", of_blocks)]) })
}

/// Coordinates as one table, axis after axis, or as one dataset for each axis.
fn coordinates(root: &Group<'_>) -> Result<(Vec<[f64; 3]>, String)> {
    let mut axes = Vec::new();
    let source;
    if let Some(table) = root.find_dataset("coord")? {
        let shape = table.shape()?;
        let [n_axes @ 1..=3, n_nodes] = shape[..] else {
            return Err(table.wrong_shape(format!("shape {shape:?}"), "shape [1 to 3, n]".to_owned()));
        };
        let values = table.reals()?.values;
        axes.extend(values.chunks(n_nodes.max(1)).take(n_axes).map(<[f64]>::to_vec));
        source = table.name().to_owned();
    } else {
        for name in ["coordx", "coordy", "coordz"] {
            let Some(dataset) = root.find_dataset(name)? else { break };
            axes.push(dataset.reals()?.values);
        }
        source = root.child_name("coordx");
    }
    let n_nodes = axes.first().map_or(0, Vec::len);
    if let Some(axis) = axes.iter().find(|axis| axis.len() != n_nodes) {
        let dataset = root.dataset("coordx")?;
        return Err(dataset.wrong_shape(counted(axis.len(), "value", "values"), format!("{n_nodes}, as for x")));
    }
    let by_node: Vec<f64> = (0..n_nodes).flat_map(|node| axes.iter().map(move |axis| axis[node])).collect();
    Ok((points(&by_node, axes.len().max(1)), source))
}

/// The nodes that the datasets of numbered names list, under the names or numbers that they have.
fn groups(
    root: &Group<'_>,
    (dataset, names, numbers, kind): (&str, &str, &str, &str),
    n_nodes: usize,
) -> Result<BTreeMap<String, Vec<usize>>> {
    let names = root.find_dataset(names)?.map(|names| names.short_names()).transpose()?.unwrap_or_default();
    let numbers = root.find_dataset(numbers)?.map(|numbers| numbers.integers()).transpose()?.unwrap_or_default();
    let mut groups: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (at, members) in (0..).zip(numbered(root, dataset)?) {
        let own = || format!("{kind} {}", numbers.get(at).copied().unwrap_or(at as i64 + 1));
        let name = names.get(at).filter(|name| !name.is_empty()).cloned().unwrap_or_else(own);
        groups.entry(name).or_default().extend(members.checked_indices(1, n_nodes)?);
    }
    for members in groups.values_mut() {
        members.sort_unstable();
        members.dedup();
    }
    Ok(groups)
}

/// The datasets that are numbered from one.
fn numbered<'a>(root: &Group<'a>, name: &str) -> Result<Vec<Dataset<'a>>> {
    let mut found = Vec::new();
    while let Some(dataset) = root.find_dataset(&format!("{name}{}", found.len() + 1))? {
        found.push(dataset);
    }
    Ok(found)
}

/// Blocks of elements without their kinds.
pub(super) fn read_cells(root: &Group<'_>, cells: &mut Gathered<'_>) -> Result<Known> {
    for block in numbered(root, "connect")? {
        add_table(cells, &block, 1)?;
    }
    Ok(Known::Not("the kinds of elements in the layout of Exodus".to_owned()))
}
