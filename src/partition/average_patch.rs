//! Average coupling: a node of six degrees of freedom follows the mean motion of a patch, which stays free to deform.
//!
//! The mean motion is the rigid one that is nearest to the translations of the patch, weighted. The patch has it and its
//! [`super::distortions`] as dofs in the place of its translations: a change of variables, which ties nothing.

use super::distortions::{Distortions, PatchRow};
use super::interface_node::{InterfaceNode, Resolved, Rows};
use super::node_catalogue::NodeCatalogue;
use super::rigid_patch;
use super::sites::Sites;
use crate::error::{Error, Result};
use crate::job::{InterfaceJob, Weights};

/// The largest weight over the smallest: the mean motion is rounded by as many ε, and a node that counts for less does not count.
const MAX_SPREAD: f64 = 1e6;

/// The node of a patch with the translations of the nodes that have weight.
pub(super) fn node(catalogue: &NodeCatalogue, job: &InterfaceJob, labels: &[i64]) -> Result<Resolved> {
    let selector = job.selection().selector;
    let weights_of_nodes = match &job.weights {
        Some(Weights::Given(given)) => given.clone(),
        _ => vec![1.0; labels.len()],
    };
    let (mut rows, mut weights) = (Vec::new(), Vec::new());
    for (label, weight) in labels.iter().zip(weights_of_nodes) {
        let of_node = catalogue.rows_of(&selector, *label)?.iter();
        // A node without an area takes no part in the mean.
        for (_, row) in of_node.filter(|(direction, _)| !direction.is_rotation() && weight > 0.0) {
            rows.push(*row);
            weights.push(weight);
        }
    }
    let [smallest, largest] = [f64::min, f64::max].map(|of| weights.iter().copied().reduce(of).unwrap_or(1.0));
    if largest > MAX_SPREAD * smallest {
        return Err(Error::WeightSpread { interface: job.name.clone(), smallest, largest });
    }
    Ok(Resolved::new(rigid_patch::interface_node(catalogue, job, labels)?, Rows::Average { rows, weights }))
}

/// The distortions of a patch whose node has `n_directions` dofs, internal ones among them.
///
/// # Errors
/// [`crate::error::Error::PatchRank`].
pub(super) fn distortions(
    sites: &Sites<'_>,
    node: &InterfaceNode,
    (rows, weights): (&[usize], &[f64]),
    n_directions: usize,
) -> Result<Distortions> {
    let levers = rigid_patch::independent(sites, (node, rows), n_directions)?;
    let patch_row = |((row, weight), [x, y, z, ..]): ((&usize, &f64), [f64; 6])| {
        let position = sites.of_row.as_ref().and_then(|sites| sites[*row]).map_or([0.0; 3], |site| site.position);
        PatchRow { node: sites.node_of_row[*row], position, weight: *weight, direction: [x, y, z] }
    };
    let patch: Vec<PatchRow> = rows.iter().zip(weights).zip(levers).map(patch_row).collect();
    Distortions::of(&patch, n_directions)
}
