//! The order of elimination of the internal dofs.
//!
//! Nested dissection runs on the graph of nodes, not of dofs: three to six times smaller, the same separators.

use super::metis::{Graph, nested_dissection};
use super::transformation::{Transformation, TransformationRow};
use crate::model::Model;

/// The new order of the partition's dofs: internal ones as they are eliminated, interface ones as they are.
pub(super) fn elimination_order(model: &Model, transformation: &Transformation) -> Vec<u32> {
    let n_internal = transformation.n_internal();
    let nodes = InternalNodes::new(transformation, n_internal);
    let graph = node_graph(model, transformation, &nodes);
    let by_dissection = nested_dissection(&graph).unwrap_or_else(|| (0..nodes.dofs.len() as u32).collect());
    let mut order = Vec::with_capacity(transformation.dofs.len());
    for node in by_dissection {
        order.extend_from_slice(&nodes.dofs[node as usize]);
    }
    order.extend(n_internal as u32..transformation.dofs.len() as u32);
    order
}

/// The internal dofs grouped by node.
struct InternalNodes {
    /// Group of each internal dof.
    of_dof: Vec<u32>,
    /// The dofs of each group.
    dofs: Vec<Vec<u32>>,
}

impl InternalNodes {
    fn new(transformation: &Transformation, n_internal: usize) -> Self {
        let mut number = std::collections::HashMap::new();
        let mut dofs: Vec<Vec<u32>> = Vec::new();
        let of_dof = transformation.dofs[..n_internal].iter().enumerate().map(|(dof, what)| {
            let group = *number.entry(what.node).or_insert_with(|| {
                dofs.push(Vec::new());
                dofs.len() as u32 - 1
            });
            dofs[group as usize].push(dof as u32);
            group
        });
        let of_dof = of_dof.collect();
        Self { of_dof, dofs }
    }
}

fn node_graph(model: &Model, transformation: &Transformation, nodes: &InternalNodes) -> Graph {
    let n_nodes = nodes.dofs.len();
    let group_of_row: Vec<Option<u32>> = transformation
        .rows
        .iter()
        .map(|row| match row {
            TransformationRow::Dof(dof) => nodes.of_dof.get(*dof as usize).copied(),
            // Dofs of a rigid node that are internal couple densely; METIS may place the node anywhere.
            TransformationRow::Rigid(_) => None,
        })
        .collect();
    let mut rows_of_node: Vec<Vec<u32>> = vec![Vec::new(); n_nodes];
    for (row, group) in group_of_row.iter().enumerate() {
        if let Some(group) = group {
            rows_of_node[*group as usize].push(row as u32);
        }
    }
    let mut graph = Graph { starts: vec![0], neighbours: Vec::new(), weights: Vec::new() };
    let mut last_seen = vec![u32::MAX; n_nodes];
    for (node, rows) in rows_of_node.iter().enumerate() {
        last_seen[node] = node as u32;
        for row in rows {
            for matrix in [&model.stiffness, &model.mass] {
                let Some(view) = matrix.outer_view(*row as usize) else {
                    continue;
                };
                for col in view.indices() {
                    if let Some(other) = group_of_row[*col as usize]
                        && last_seen[other as usize] != node as u32
                    {
                        last_seen[other as usize] = node as u32;
                        graph.neighbours.push(other as i32);
                    }
                }
            }
        }
        graph.starts.push(graph.neighbours.len() as i32);
        graph.weights.push(nodes.dofs[node].len() as i32);
    }
    graph
}
