//! Direct coupling: the interface has the nodes' own degrees of freedom.

use super::axes;
use super::interface_node::{InterfaceNode, Resolved, Rows};
use super::node_catalogue::NodeCatalogue;
use crate::error::Result;
use crate::job::{Coupling, InterfaceJob};

/// A node of the model as a node of the interface.
pub(super) fn node(catalogue: &NodeCatalogue, job: &InterfaceJob, label: i64) -> Result<Resolved> {
    let (directions, rows) = catalogue.dofs_of(&job.selection(), label)?.into_iter().unzip();
    let position = catalogue.position(label);
    let node = InterfaceNode {
        name: job.name.clone(),
        label: Some(label),
        position,
        fit: None,
        axes: axes::of_nodes(job, position.as_slice().chunks(1).next())?,
        directions,
        coupling: Coupling::Direct,
        n_nodes: 1,
    };
    Ok(Resolved::new(node, Rows::Own(rows)))
}
