//! The order of elimination of the internal dofs.
//!
//! Nested dissection runs on the graph of nodes, not of dofs: three to six times smaller, the same separators. In frames
//! minimum degree may need less work, and then it is taken.

use super::metis::{Graph, nested_dissection};
use super::minimum_degree::{minimum_degree, work};
use super::transformation::{Transformation, TransformationRow};
use crate::model::Model;

/// Mean number of neighbours of a node below which minimum degree is tried, for a twentieth of the time of dissection: chains
/// of nodes between joints, which dissection cuts where it should eliminate them. In frames of 2 to 3 neighbours minimum
/// degree needed 0.6 to 1.5 times the operations of dissection; in shells (8) of more than 10,000 nodes 1.06 to 1.1 times, in
/// solids (16 to 25) 0.97 to 3.3 times, and where it won there, less than a millisecond.
const FRAME: usize = 4;

/// The new order of the partition's dofs: internal ones as they are eliminated, interface ones as they are.
pub(super) fn elimination_order(model: &Model, transformation: &Transformation) -> Vec<u32> {
    let n_internal = transformation.n_internal();
    let nodes = InternalNodes::new(transformation, n_internal);
    let graph = node_graph(model, transformation, &nodes);
    let mut order = Vec::with_capacity(transformation.dofs.len());
    for node in order_of_nodes(&graph) {
        order.extend_from_slice(&nodes.dofs[node as usize]);
    }
    order.extend(n_internal as u32..transformation.dofs.len() as u32);
    order
}

/// The order of least work among those that are worth finding.
fn order_of_nodes(graph: &Graph) -> Vec<u32> {
    let n = graph.weights.len();
    let by_dissection = nested_dissection(graph).unwrap_or_else(|| (0..n as u32).collect());
    if graph.neighbours.len() >= FRAME * n {
        return by_dissection;
    }
    let by_degree = minimum_degree(graph).and_then(|order| work(graph, &order).map(|work| (order, work)));
    match (by_degree, work(graph, &by_dissection)) {
        (Some((order, less)), Some(work)) if less < work => order,
        _ => by_dissection,
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Joints of a square lattice of n × n, with `between` nodes along each beam.
    fn frame(n: usize, between: usize) -> Graph {
        let mut lists: Vec<Vec<i32>> = vec![Vec::new(); n * n];
        let mut beam = |from: usize, to: usize| {
            let mut last = from;
            for at in 0..=between {
                let next = if at == between { to } else { lists.len() };
                if next == lists.len() {
                    lists.push(Vec::new());
                }
                lists[last].push(next as i32);
                lists[next].push(last as i32);
                last = next;
            }
        };
        for row in 0..n {
            for col in 0..n - 1 {
                beam(row * n + col, row * n + col + 1);
                beam(col * n + row, (col + 1) * n + row);
            }
        }
        let mut graph = Graph { starts: vec![0], neighbours: Vec::new(), weights: vec![6; lists.len()] };
        for list in lists {
            graph.neighbours.extend(list);
            graph.starts.push(graph.neighbours.len() as i32);
        }
        graph
    }

    #[test]
    fn frame_takes_the_order_of_less_work() {
        // Small frames are better off with minimum degree, large plane lattices with dissection.
        for (graph, is_by_degree) in [(frame(12, 4), true), (frame(100, 0), false)] {
            let order = order_of_nodes(&graph);
            let cost = |order: &[u32]| work(&graph, order).expect("memory");
            let (by_degree, by_dissection) = (minimum_degree(&graph).unwrap(), nested_dissection(&graph).unwrap());
            assert!(cost(&order) <= cost(&by_degree) && cost(&order) <= cost(&by_dissection));
            assert_eq!(order == by_degree, is_by_degree);
            let mut sorted = order;
            sorted.sort_unstable();
            assert!(sorted.iter().enumerate().all(|(index, node)| index == *node as usize));
        }
    }
}
