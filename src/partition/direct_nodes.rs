//! Direct coupling: the interface has the nodes' own degrees of freedom.

use super::interface_node::{InterfaceNode, Resolved, Rows};
use super::node_catalogue::NodeCatalogue;
use crate::dofs::Dof;
use crate::error::{Error, Result};
use crate::job::{Coupling, InterfaceJob};

/// A node of the model as a node of the interface.
pub(super) fn node(catalogue: &NodeCatalogue, job: &InterfaceJob, label: i64) -> Result<Resolved> {
    let of_node = catalogue.rows_of(job, label)?;
    let mut directions = job.dofs.clone().unwrap_or_else(|| of_node.keys().copied().collect());
    directions.sort_unstable();
    let rows = directions
        .iter()
        .map(|direction| {
            of_node.get(direction).copied().ok_or_else(|| Error::DofMissing {
                interface: job.name.clone(),
                dof: Dof { node: label, direction: *direction },
            })
        })
        .collect::<Result<_>>()?;
    let node = InterfaceNode {
        name: job.name.clone(),
        label: Some(label),
        position: catalogue.position(label),
        directions,
        coupling: Coupling::Direct,
        n_nodes: 1,
    };
    Ok(Resolved { node, rows: Rows::Own(rows) })
}
