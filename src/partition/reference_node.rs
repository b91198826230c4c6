//! Nodes of the model that are joined to a whole patch already, as the reference node of a rigid or distributing element is.
//!
//! A solid has translations alone. A node with rotations that K joins to every node of a patch of such is no node of an element of it.

use std::collections::{BTreeMap, BTreeSet};

use super::node_catalogue::NodeCatalogue;
use crate::dofs::Dof;
use crate::job::InterfaceJob;
use crate::model::Model;
use crate::number;

/// Nodes of a patch that an element of beams or shells does not join by chance.
const FEWEST: usize = 3;

/// For each patch that a node of the model is joined to already: that it is there, and what to do with it.
pub fn reference_nodes(model: &Model, interfaces: &[InterfaceJob]) -> Vec<String> {
    let Some(dofs) = model.dofs.as_deref().filter(|_| interfaces.iter().any(|job| job.coupling.is_patch())) else {
        return Vec::new();
    };
    let catalogue = NodeCatalogue::new(model);
    let of_patch = |job: &InterfaceJob| {
        let labels: BTreeSet<i64> = catalogue.select(model, &job.selection()).ok()?.into_iter().collect();
        let node = reference_node(model, dofs, &labels)?;
        let nodes = number::counted(labels.len() as u64, "node", "nodes");
        Some(format!(
            "interface {}: node {node} has rotations and is joined to all {nodes} of the patch; where it is that of a rigid element, \
             take it alone with coupling \"direct\"",
            job.name
        ))
    };
    interfaces.iter().filter(|job| job.coupling.is_patch()).filter_map(of_patch).collect()
}

/// The first node outside of a patch without rotations that has rotations and is joined to each of its nodes.
fn reference_node(model: &Model, dofs: &[Option<Dof>], patch: &BTreeSet<i64>) -> Option<i64> {
    let rows = || dofs.iter().enumerate().filter_map(|(row, dof)| dof.map(|dof| (row, dof)));
    let of_patch = || rows().filter(|(_, dof)| patch.contains(&dof.node));
    if patch.len() < FEWEST || of_patch().any(|(_, dof)| dof.direction.is_rotation()) {
        return None;
    }
    let mut joined: BTreeMap<i64, BTreeSet<i64>> = BTreeMap::new();
    for (row, dof) in of_patch() {
        let entries = model.stiffness.outer_view(row);
        for (column, _) in entries.iter().flat_map(|row| row.iter()).filter(|(_, value)| **value != 0.0) {
            if let Some(other) = dofs[column].filter(|other| other.direction.is_rotation()) {
                joined.entry(other.node).or_default().insert(dof.node);
            }
        }
    }
    joined.into_iter().find(|(_, nodes)| nodes.len() == patch.len()).map(|(node, _)| node)
}
