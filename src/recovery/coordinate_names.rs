//! What the columns of a table of states are called.

use std::collections::HashMap;

use supel_runtime::{Coordinate, InterfaceNode, Superelement};

use crate::report::{is_plain_field, printable};

/// A name for each reduced coordinate, in their order, all different and none in need of quotation marks: `foot.ux` for an interface of one
/// node, `foot.17.ux` for one of several, `rows:4` for a row of a model without nodes (from zero), `eta.1` for a modal amplitude.
/// Where such a name would be ambiguous or has characters that tables use, it is the number of the coordinate, `q1`.
pub fn coordinate_names(superelement: &Superelement) -> Vec<String> {
    let metadata = superelement.metadata();
    let n_interface = superelement.n_interface();
    let names: Vec<String> = metadata
        .coordinates
        .iter()
        .enumerate()
        .map(|(at, coordinate)| match coordinate {
            Coordinate::Interface { node, direction } => {
                format!("{}.{direction}", node_name(&metadata.interface_nodes, *node))
            }
            Coordinate::InterfaceRow { row } => format!("rows:{row}"),
            // Mixed columns are no modes, so that amplitudes are counted and not named.
            _ => format!("eta.{}", at + 1 - n_interface),
        })
        .collect();
    let mut n_alike: HashMap<&str, usize> = HashMap::new();
    names.iter().for_each(|name| *n_alike.entry(name).or_default() += 1);
    let is_plain = |name: &String| n_alike[name.as_str()] == 1 && is_plain_field(name) && printable(name) == *name;
    names
        .iter()
        .enumerate()
        .map(|(at, name)| if is_plain(name) { name.clone() } else { format!("q{}", at + 1) })
        .collect()
}

/// The interface of a node, with its label where the interface has several nodes.
pub(super) fn node_name(nodes: &[InterfaceNode], index: usize) -> String {
    let node = &nodes[index];
    let is_alone = nodes.iter().filter(|other| other.name == node.name).count() == 1;
    match node.label {
        Some(label) if !is_alone => format!("{}.{label}", node.name),
        _ => node.name.clone(),
    }
}
