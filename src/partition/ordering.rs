//! The order of elimination of the internal dofs.
//!
//! Nested dissection runs on the graph of nodes, not of dofs: which is three to six times smaller and has the same separators. For frames
//! minimum degree may need less work, and then it is used.

use std::collections::HashMap;

use rayon::prelude::*;

use super::metis::{Graph, nested_dissection};
use super::minimum_degree::{minimum_degree, work};
use super::parts::Parts;
use super::transformation::{DofOrigin, ReducedDof, Transformation};
use super::transformation_row::TransformationRow;
use crate::cache::{Cache, Key, Kind, Reader, Recorded, Writer, recalled};
use crate::error::Result;
use crate::model::Model;
use crate::plan::Parting;

/// Nodes whose neighbours one task lists.
const NODES_PER_TASK: usize = 2048;
/// Nodes from which on an order takes longer to find than to read: dissection of so many takes a millisecond.
const WORTH_AN_ENTRY: usize = 256;
/// No group of internal dofs.
const NONE: u32 = u32::MAX;

/// Mean number of neighbours of a node below which minimum degree is tried, for a twentieth of the time of dissection: chains
/// of nodes between joints, which dissection cuts where it should eliminate them. In frames of 2 to 3 neighbours minimum
/// degree needed 0.6 to 1.5 times the operations of dissection; in shells (8) of more than 10,000 nodes 1.06 to 1.1 times, in
/// solids (16 to 25) 0.97 to 3.3 times, and where it won there, less than a millisecond.
const FRAME: usize = 4;

/// The order of the partition's dofs.
pub(super) struct Order {
    /// Internal dofs as they are eliminated, interface ones as they are.
    pub(super) dofs: Vec<u32>,
    /// Where each part of the interior ends; one end where they are not told apart.
    pub(super) part_ends: Vec<usize>,
}

/// The new order of the partition's dofs, by parts of the interior where a plan tells them apart.
pub(super) fn elimination_order(model: &Model, transformation: &Transformation, apart: Parting) -> Result<Order> {
    let n_internal = transformation.n_internal();
    let nodes = InternalNodes::new(transformation, n_internal);
    let graph = node_graph(model, transformation, &nodes);
    let parts = Parts::of(&graph, (model, transformation), |dof| nodes.of_dof.get(dof as usize).copied());
    let cache = model.cache.as_ref();
    let mut order = Order { dofs: Vec::with_capacity(transformation.dofs.len()), part_ends: Vec::new() };
    if parts.count < 2 || apart == Parting::Together {
        order.take(&order_of_nodes_or_earlier(&graph, cache)?, &nodes);
    } else {
        let mut members = vec![Vec::new(); parts.count];
        parts.of_group.iter().zip(0u32..).for_each(|(part, group)| members[*part as usize].push(group));
        let mut place = vec![NONE; parts.of_group.len()];
        for members in &members {
            let of_part = order_of_nodes_or_earlier(&graph.induced(members, &mut place), cache)?;
            let groups: Vec<u32> = of_part.into_iter().map(|at| members[at as usize]).collect();
            order.take(&groups, &nodes);
        }
    }
    order.dofs.extend(n_internal as u32..transformation.dofs.len() as u32);
    Ok(order)
}

impl Order {
    /// Adds the dofs of a part, by groups.
    fn take(&mut self, groups: &[u32], nodes: &InternalNodes) {
        groups.iter().for_each(|group| self.dofs.extend_from_slice(nodes.dofs(*group as usize)));
        self.part_ends.push(self.dofs.len());
    }
}

/// An order as an entry of a cache has it.
struct KeptOrder(Vec<u32>);

impl Recorded for KeptOrder {
    const KIND: Kind = Kind::Order;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        to.array(&self.0)
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let order: Vec<u32> = from.array()?;
        let mut is_met = vec![false; order.len()];
        let is_new = |node: &u32| is_met.get_mut(*node as usize).is_some_and(|is_met| !std::mem::replace(is_met, true));
        order.iter().all(is_new).then_some(Self(order))
    }
}

/// The order of the nodes of a graph, or the one that an earlier run has found for it.
fn order_of_nodes_or_earlier(graph: &Graph, cache: Option<&Cache>) -> Result<Vec<u32>> {
    let Graph { starts, neighbours, weights } = graph;
    let key = || Key::of("order of nodes").numbers(starts).numbers(neighbours).numbers(weights);
    let cache = cache.filter(|_| weights.len() >= WORTH_AN_ENTRY);
    let KeptOrder(order) = recalled(cache, key, || order_of_nodes(graph).map(KeptOrder))?;
    // A short one would leave nodes out.
    if order.len() == weights.len() { Ok(order) } else { order_of_nodes(graph) }
}

/// The order of least work among those that are worth finding.
fn order_of_nodes(graph: &Graph) -> Result<Vec<u32>> {
    let n = graph.weights.len();
    let by_dissection = nested_dissection(graph)?.unwrap_or_else(|| (0..n as u32).collect());
    if graph.neighbours.len() >= FRAME * n {
        return Ok(by_dissection);
    }
    let by_degree = minimum_degree(graph)?;
    let is_less = work(graph, &by_degree)? < work(graph, &by_dissection)?;
    Ok(if is_less { by_degree } else { by_dissection })
}

/// The internal dofs grouped by node.
struct InternalNodes {
    /// Group of each internal dof.
    of_dof: Vec<u32>,
    /// Where the dofs of each group begin; one more than groups.
    starts: Vec<usize>,
    /// The dofs of the groups, one group after the other.
    dofs: Vec<u32>,
}

impl InternalNodes {
    /// Groups in the order in which nodes appear.
    fn new(transformation: &Transformation, n_internal: usize) -> Self {
        let internal = &transformation.dofs[..n_internal];
        let n_nodes = internal.iter().map(|dof| dof.node as usize + 1).max().unwrap_or(0);
        let mut group_of_node = vec![NONE; n_nodes];
        let mut starts = vec![0];
        let group = |dof: &ReducedDof| {
            let group = &mut group_of_node[dof.node as usize];
            if *group == NONE {
                *group = starts.len() as u32 - 1;
                starts.push(0);
            }
            starts[*group as usize + 1] += 1;
            *group
        };
        let of_dof: Vec<u32> = internal.iter().map(group).collect();
        for group in 1..starts.len() {
            starts[group] += starts[group - 1];
        }
        let mut next = starts.clone();
        let mut dofs = vec![0; n_internal];
        for (dof, group) in of_dof.iter().enumerate() {
            dofs[next[*group as usize]] = dof as u32;
            next[*group as usize] += 1;
        }
        Self { of_dof, starts, dofs }
    }

    fn len(&self) -> usize {
        self.starts.len() - 1
    }

    fn dofs(&self, group: usize) -> &[u32] {
        &self.dofs[self.starts[group]..self.starts[group + 1]]
    }
}

/// The nodes that K or M couples.
fn node_graph(model: &Model, transformation: &Transformation, nodes: &InternalNodes) -> Graph {
    let group_of_row: Vec<u32> = transformation
        .rows
        .iter()
        .map(|row| match row {
            TransformationRow::Dof(dof) => nodes.of_dof.get(*dof as usize).copied().unwrap_or(NONE),
            // Dofs of a rigid node that are internal couple densely; METIS may place the node anywhere. Other dofs are `Shared`.
            TransformationRow::Tied(_) | TransformationRow::Held => NONE,
        })
        .collect();
    let shared = Shared::of(transformation, nodes);
    let n_nodes = nodes.len();
    let lists: Vec<Lists> = (0..n_nodes.div_ceil(NODES_PER_TASK))
        .into_par_iter()
        .map_init(
            || vec![NONE; n_nodes],
            |last_seen, task| {
                let mut lists = Lists::default();
                for node in (task * NODES_PER_TASK..n_nodes).take(NODES_PER_TASK) {
                    let rows = own_rows(transformation, nodes.dofs(node)).chain(shared.rows_of(node as u32));
                    lists.add((model, &shared), &group_of_row, node as u32, rows, last_seen);
                }
                lists
            },
        )
        .collect();
    let mut graph = Graph { starts: vec![0], neighbours: Vec::new(), weights: Vec::new() };
    for task in lists {
        let before = graph.neighbours.len();
        graph.starts.extend(task.ends.iter().map(|end| (before + end) as i32));
        graph.neighbours.extend(task.neighbours);
    }
    graph.weights.extend((0..n_nodes).map(|node| nodes.dofs(node).len() as i32));
    graph
}

/// The rows that distortions of patches move, or nodes that they follow by constraints; they are no dofs of their own.
#[derive(Default)]
struct Shared {
    groups: HashMap<u32, Vec<u32>>,
    rows: HashMap<u32, Vec<usize>>,
}

impl Shared {
    fn of(transformation: &Transformation, nodes: &InternalNodes) -> Self {
        let mut shared = Self::default();
        // Dofs of the interface are in no group.
        let moves_groups = |dof: &u32| {
            let is_of_patch_node = matches!(transformation.dofs[*dof as usize].origin, DofOrigin::PatchNode(..));
            !is_of_patch_node && (*dof as usize) < nodes.of_dof.len()
        };
        for (row, entries) in transformation.rows.iter().enumerate() {
            let TransformationRow::Tied(entries) = entries else { continue };
            let moving = entries.iter().map(|(dof, _)| *dof).filter(moves_groups);
            let mut groups: Vec<u32> = moving.map(|dof| nodes.of_dof[dof as usize]).collect();
            groups.sort_unstable();
            groups.dedup();
            for group in &groups {
                shared.rows.entry(*group).or_default().push(row);
            }
            if !groups.is_empty() {
                shared.groups.insert(row as u32, groups);
            }
        }
        shared
    }

    fn groups_of(&self, row: u32) -> impl Iterator<Item = u32> {
        self.groups.get(&row).into_iter().flatten().copied()
    }

    fn rows_of(&self, group: u32) -> impl Iterator<Item = usize> {
        self.rows.get(&group).into_iter().flatten().copied()
    }
}

/// The rows of the model that are these dofs.
fn own_rows<'a>(transformation: &'a Transformation, dofs: &'a [u32]) -> impl Iterator<Item = usize> {
    dofs.iter().filter_map(|dof| match transformation.dofs[*dof as usize].origin {
        DofOrigin::Row(row) => Some(row),
        DofOrigin::PatchNode(..) | DofOrigin::Distortion(..) => None,
    })
}

/// The neighbours of some nodes.
#[derive(Default)]
struct Lists {
    neighbours: Vec<i32>,
    /// Where the list of each node ends.
    ends: Vec<usize>,
}

impl Lists {
    /// Adds the list of a node; `last_seen` is the node whose list took each node last.
    fn add(
        &mut self,
        (model, shared): (&Model, &Shared),
        group_of_row: &[u32],
        node: u32,
        rows: impl Iterator<Item = usize>,
        last_seen: &mut [u32],
    ) {
        last_seen[node as usize] = node;
        for row in rows {
            let views = [&model.stiffness, &model.mass].map(|matrix| matrix.outer_view(row));
            for col in views.iter().flatten().flat_map(|view| view.indices()) {
                let own = Some(group_of_row[*col as usize]).filter(|group| *group != NONE);
                for other in own.into_iter().chain(shared.groups_of(*col)) {
                    if last_seen[other as usize] != node {
                        last_seen[other as usize] = node;
                        self.neighbours.push(other as i32);
                    }
                }
            }
        }
        self.ends.push(self.neighbours.len());
    }
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
            let order = order_of_nodes(&graph).expect("memory");
            let cost = |order: &[u32]| work(&graph, order).expect("memory");
            let (by_degree, by_dissection) =
                (minimum_degree(&graph).unwrap(), nested_dissection(&graph).unwrap().unwrap());
            assert!(cost(&order) <= cost(&by_degree) && cost(&order) <= cost(&by_dissection));
            assert_eq!(order == by_degree, is_by_degree);
            let mut sorted = order;
            sorted.sort_unstable();
            assert!(sorted.iter().enumerate().all(|(index, node)| index == *node as usize));
        }
    }
}
