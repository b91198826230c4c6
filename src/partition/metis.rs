//! METIS nested dissection: the one call into the vendored C library.
//!
//! METIS keeps the state of its random numbers in the C library (`rand`), so calls are serialised and each one is
//! seeded: the same graph gives the same order whatever ran before.
//!
//! Safety: METIS reads `xadj` (n + 1 entries), `adjncy` (xadj\[n\] entries, each below n) and `vwgt` (n entries) and writes
//! `perm` and `iperm` (n entries each). The wrapper owns all five and checks the graph before the call.
#![allow(unsafe_code)]

use std::sync::Mutex;

use metis_sys as sys;

use crate::error::{Error, Result};

static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
const SEED: i32 = 1;

/// A graph in compressed adjacency lists, without loops, each edge stored from both ends.
pub(super) struct Graph {
    /// Where each node's list starts; n + 1 entries.
    pub(super) starts: Vec<i32>,
    /// The neighbours.
    pub(super) neighbours: Vec<i32>,
    /// Weight of each node.
    pub(super) weights: Vec<i32>,
}

impl Graph {
    /// The graph of some nodes, ascending, that have no neighbours but each other; `place` is memory for a number of each node of the whole.
    pub(super) fn induced(&self, members: &[u32], place: &mut [u32]) -> Self {
        members.iter().zip(0..).for_each(|(node, at)| place[*node as usize] = at);
        let mut part = Self { starts: vec![0], neighbours: Vec::new(), weights: Vec::new() };
        for node in members.iter().map(|node| *node as usize) {
            let own = &self.neighbours[self.starts[node] as usize..self.starts[node + 1] as usize];
            part.neighbours.extend(own.iter().map(|other| place[*other as usize] as i32));
            part.starts.push(part.neighbours.len() as i32);
            part.weights.push(self.weights[node]);
        }
        part
    }
}

/// The nested-dissection order: `order[k]` is the node eliminated at step k. None where METIS refuses the graph.
///
/// # Errors
/// [`Error::OutOfMemory`] where METIS has no memory: another order would do, but give other bytes.
pub(super) fn nested_dissection(graph: &Graph) -> Result<Option<Vec<u32>>> {
    let n = graph.weights.len();
    let is_sound = graph.starts.len() == n + 1
        && graph.starts.last().copied() == i32::try_from(graph.neighbours.len()).ok()
        && graph.starts.windows(2).all(|pair| pair[0] <= pair[1])
        && graph.neighbours.iter().all(|node| usize::try_from(*node).is_ok_and(|node| node < n));
    assert!(is_sound, "the graph given to METIS is not well formed");
    if n == 0 {
        return Ok(Some(Vec::new()));
    }
    let Ok(mut nodes) = i32::try_from(n) else { return Ok(None) };
    let (mut starts, mut neighbours, mut weights) =
        (graph.starts.clone(), graph.neighbours.clone(), graph.weights.clone());
    let (mut order, mut place) = (vec![0i32; n], vec![0i32; n]);
    let mut options = [0i32; sys::METIS_NOPTIONS as usize];
    let guard = ONE_AT_A_TIME.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    // SAFETY: every pointer is to a live vector of the length METIS expects, checked above; the lock keeps METIS alone.
    let status = unsafe {
        sys::METIS_SetDefaultOptions(options.as_mut_ptr());
        options[sys::moptions_et_METIS_OPTION_SEED as usize] = SEED;
        sys::METIS_NodeND(
            &mut nodes,
            starts.as_mut_ptr(),
            neighbours.as_mut_ptr(),
            weights.as_mut_ptr(),
            options.as_mut_ptr(),
            order.as_mut_ptr(),
            place.as_mut_ptr(),
        )
    };
    drop(guard);
    if status == sys::rstatus_et_METIS_ERROR_MEMORY {
        return Err(Error::OutOfMemory { what: "the order of elimination" });
    }
    Ok((status == sys::rstatus_et_METIS_OK).then(|| order.into_iter().map(|node| node as u32).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(n: i32) -> Graph {
        let (mut starts, mut neighbours) = (vec![0], Vec::new());
        for node in 0..n {
            neighbours.extend([node - 1, node + 1].into_iter().filter(|other| (0..n).contains(other)));
            starts.push(neighbours.len() as i32);
        }
        Graph { starts, neighbours, weights: vec![1; n as usize] }
    }

    #[test]
    fn every_node_appears_once_and_the_order_repeats() {
        let order = nested_dissection(&path(500)).unwrap().unwrap();
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(index, node)| index == *node as usize));
        let _ = nested_dissection(&path(300));
        assert_eq!(order, nested_dissection(&path(500)).unwrap().unwrap());
    }

    #[test]
    fn graph_without_edges_or_nodes_is_ordered() {
        let lonely = Graph { starts: vec![0, 0, 0], neighbours: Vec::new(), weights: vec![1, 1] };
        assert_eq!(nested_dissection(&lonely).unwrap().unwrap().len(), 2);
        let empty = Graph { starts: vec![0], neighbours: Vec::new(), weights: Vec::new() };
        assert!(nested_dissection(&empty).unwrap().unwrap().is_empty());
    }

    #[test]
    #[should_panic(expected = "not well formed")]
    fn neighbour_out_of_range_never_reaches_the_library() {
        let _ = nested_dissection(&Graph { starts: vec![0, 1], neighbours: vec![7], weights: vec![1] });
    }
}
