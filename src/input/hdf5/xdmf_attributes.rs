//! Attributes of an XDMF: whole numbers at nodes, which make groups.

use std::collections::BTreeMap;
use std::path::Path;

use roxmltree::{Document, Node};

use super::file::{H5, with_memory};
use super::group::Group;
use super::xdmf_reference::inside_folder;
use crate::error::Result;
use crate::input::Allowance;
use crate::input::tag_groups::tag_groups;
use crate::regular_file::unchanged;

/// The groups of nodes. Of attributes in HDF5 those count that are in the file of the geometry, whose digest is kept; of a series in time the
/// first of a name counts.
pub(super) fn node_groups(
    document: &Document<'_>,
    (path, geometry): (&Path, &str),
    n_nodes: usize,
    allowance: &Allowance,
) -> Result<BTreeMap<String, Vec<usize>>> {
    let mut tags: BTreeMap<&str, Vec<i64>> = BTreeMap::new();
    for node in document.descendants().filter(|node| node.has_tag_name("Attribute")) {
        let (Some(name), "Node") = (node.attribute("Name"), node.attribute("Center").unwrap_or("Node")) else {
            continue;
        };
        let mut items = node.children().filter(|child| child.has_tag_name("DataItem"));
        let (Some(item), None) = (items.next(), items.next()) else { continue };
        if is_whole(item) && !tags.contains_key(name) {
            let values = values(item, (path, geometry), allowance)?;
            tags.extend(values.filter(|values| values.len() == n_nodes).map(|values| (name, values)));
        }
    }
    Ok(tags.iter().flat_map(|(name, tags)| tag_groups(name, tags)).collect())
}

/// Whether an item has whole numbers of its own.
fn is_whole(item: Node<'_, '_>) -> bool {
    let kind = item.attribute("NumberType").or_else(|| item.attribute("DataType")).unwrap_or("Float");
    let is_uniform =
        item.attribute("ItemType").is_none_or(|kind| kind == "Uniform") && !item.has_attribute("Reference");
    is_uniform && matches!(kind, "Int" | "UInt" | "Char" | "UChar" | "Short" | "UShort")
}

/// The numbers of an item; none where they are elsewhere or in another form.
fn values(item: Node<'_, '_>, (path, geometry): (&Path, &str), allowance: &Allowance) -> Result<Option<Vec<i64>>> {
    let content = item.text().unwrap_or_default().trim();
    match item.attribute("Format").unwrap_or("XML").to_ascii_uppercase().as_str() {
        "XML" => Ok(content.split_ascii_whitespace().map(|word| word.parse().ok()).collect()),
        "HDF" => {
            let of_geometry = inside_folder(path, geometry).map(|(file, _)| file);
            let Some((file, object)) =
                inside_folder(path, content).filter(|(file, _)| Some(file) == of_geometry.as_ref())
            else {
                return Ok(None);
            };
            let read = || {
                let h5 = H5::open(&file, allowance)?;
                Group::root(&h5)?.dataset(object)?.integers()
            };
            unchanged(&file, || with_memory(&file, read)).map(Some)
        }
        _ => Ok(None),
    }
}
