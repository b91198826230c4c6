//! Approximate minimum degree (Amestoy, Davis, Duff 1996), and what an order of elimination costs.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};

use super::metis::Graph;
use crate::error::{Error, Result};
use crate::heap::fallibly;

/// Without memory another order would do, but give other bytes.
const NO_MEMORY: Error = Error::OutOfMemory { what: "the order of elimination" };

/// The minimum degree order: `order[k]` is the node eliminated at step k.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) fn minimum_degree(graph: &Graph) -> Result<Vec<u32>> {
    let n = graph.weights.len();
    let as_numbered: Vec<u32> = (0..n as u32).collect();
    let (pointers, indices) = upper_triangle(graph, &as_numbered);
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &pointers, None, &indices);
    let (mut order, mut place) = (vec![0usize; n], vec![0usize; n]);
    let scratch = amd::order_scratch::<usize>(n, indices.len());
    let mut memory = fallibly(|| MemBuffer::try_new(scratch)).map_err(|_| NO_MEMORY)?;
    let stack = MemStack::new(&mut memory);
    amd::order(&mut order, &mut place, pattern, amd::Control::default(), stack).map_err(|_| NO_MEMORY)?;
    Ok(order.into_iter().map(|node| node as u32).collect())
}

/// Σ c² over the columns of L, one for each node: what elimination costs in this order, up to the dofs of a node.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) fn work(graph: &Graph, order: &[u32]) -> Result<f64> {
    let n = order.len();
    let (pointers, indices) = upper_triangle(graph, order);
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &pointers, None, &indices);
    let (mut tree, mut counts) = (vec![0isize; n], vec![0usize; n]);
    let scratch = prefactorize_symbolic_cholesky_scratch::<usize>(n, indices.len());
    let mut memory = fallibly(|| MemBuffer::try_new(scratch)).map_err(|_| NO_MEMORY)?;
    prefactorize_symbolic_cholesky(&mut tree, &mut counts, pattern, MemStack::new(&mut memory));
    Ok(counts.into_iter().map(|count| (count as f64).powi(2)).sum())
}

/// Positions up to the diagonal of the matrix that the graph is of, by columns in the given order.
fn upper_triangle(graph: &Graph, order: &[u32]) -> (Vec<usize>, Vec<usize>) {
    let mut place = vec![0usize; order.len()];
    for (at, node) in order.iter().enumerate() {
        place[*node as usize] = at;
    }
    let (mut pointers, mut indices) = (vec![0usize], Vec::with_capacity(graph.neighbours.len() / 2 + order.len()));
    for (at, node) in order.iter().enumerate() {
        let list = graph.starts[*node as usize] as usize..graph.starts[*node as usize + 1] as usize;
        let start = indices.len();
        indices.extend(graph.neighbours[list].iter().map(|other| place[*other as usize]).filter(|other| *other < at));
        indices.push(at);
        indices[start..].sort_unstable();
        pointers.push(indices.len());
    }
    (pointers, indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hub with as many spokes as there are other nodes.
    fn star(n: i32) -> Graph {
        let mut starts = vec![0, n - 1];
        let mut neighbours: Vec<i32> = (1..n).collect();
        for _ in 1..n {
            neighbours.push(0);
            starts.push(neighbours.len() as i32);
        }
        Graph { starts, neighbours, weights: vec![1; n as usize] }
    }

    #[test]
    fn star_fills_in_only_where_its_hub_comes_first() {
        let graph = star(10);
        // The hub first couples all others: columns of 10, 9, … 1 entries. Last, each column has two entries but its own.
        let hub_first: Vec<u32> = (0..10).collect();
        let hub_last: Vec<u32> = (0..10).rev().collect();
        assert_eq!(work(&graph, &hub_first).ok(), Some(385.0));
        assert_eq!(work(&graph, &hub_last).ok(), Some(37.0));
        let order = minimum_degree(&graph).expect("memory");
        assert_eq!(work(&graph, &order).ok(), Some(37.0));
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, hub_first);
    }

    #[test]
    fn graph_without_nodes_is_ordered() {
        let empty = Graph { starts: vec![0], neighbours: Vec::new(), weights: Vec::new() };
        assert_eq!(minimum_degree(&empty).ok(), Some(Vec::new()));
        assert_eq!(work(&empty, &[]).ok(), Some(0.0));
    }
}
