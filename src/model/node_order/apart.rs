//! Nodes whose neighbours are others by one account of a model than by another.
//!
//! ```text
//! a_i    nodes that the first couples with node i
//! b_i    nodes that the second couples with it, of those that the first couples with anything
//! s_i    nodes in both
//! ```
//! A node is apart where s_i is less than half of a_i and less than half of b_i. Either alone is sound, for each account may have couplings
//! that the other has not.
//!
//! One mesh in two orders has as many nodes with one, two, three … neighbours by both, and other pairs of them. What couples more by
//! either changes these counts. So equal counts over other pairs prove another order, of two nodes already. An order that maps the mesh onto
//! itself, all nodes of a row of elements backwards for instance, changes no pair.

use rayon::prelude::*;

/// Fewer nodes with one neighbour each are no mesh, whose counts could say something.
const LEAST_NODES: usize = 4;

/// What two accounts of the neighbours of nodes say of each other.
pub(super) struct Apart {
    /// The nodes that share less than half of their neighbours, ascending.
    pub(super) nodes: Vec<u32>,
    /// All nodes with other neighbours, where the counts of neighbours prove that one account is the other in another order; ascending.
    pub(super) moved: Vec<u32>,
    /// The nodes that the second account lacks neighbours of, which the first has, ascending.
    pub(super) lacking: Vec<u32>,
    /// How many nodes the first account couples with anything.
    pub(super) n_known: usize,
    /// Pairs of nodes by each account, each counted twice.
    pub(super) n_pairs: [usize; 2],
}

/// What the two accounts say of one node.
struct Compared {
    counts: [usize; 2],
    n_shared: usize,
}

impl Apart {
    /// Compares the neighbours of nodes, which each account gives in ascending order without the node itself; the second is not asked
    /// of nodes that the first couples with nothing.
    pub(super) fn of(
        n_nodes: usize,
        first: impl Fn(u32) -> Vec<u32> + Sync,
        second: impl Fn(u32) -> Vec<u32> + Sync,
    ) -> Self {
        let nodes = 0..n_nodes as u32;
        let is_known: Vec<bool> = nodes.clone().into_par_iter().map(|node| !first(node).is_empty()).collect();
        let compared = |node: u32| {
            let by_first = first(node);
            let mut by_second = if by_first.is_empty() { Vec::new() } else { second(node) };
            by_second.retain(|other| is_known[*other as usize]);
            let n_shared = n_shared(&by_first, &by_second);
            Compared { counts: [by_first.len(), by_second.len()], n_shared }
        };
        let compared: Vec<Compared> = nodes.clone().into_par_iter().map(compared).collect();
        let which = |is_one: &dyn Fn(&Compared) -> bool| -> Vec<u32> {
            nodes.clone().filter(|node| is_one(&compared[*node as usize])).collect()
        };
        let is_moved = is_reordered(&compared);
        Self {
            nodes: which(&|node| node.counts.iter().all(|count| 2 * node.n_shared < *count)),
            moved: which(&|node| is_moved && node.counts != [node.n_shared; 2]),
            lacking: which(&|node| node.n_shared < node.counts[0]),
            n_known: is_known.iter().filter(|is_known| **is_known).count(),
            n_pairs: [0, 1].map(|account| compared.iter().map(|node| node.counts[account]).sum()),
        }
    }
}

/// Whether both accounts have as many nodes with each number of neighbours.
fn is_reordered(compared: &[Compared]) -> bool {
    let [first, second] = [0, 1].map(|account| {
        let mut counts: Vec<usize> = compared.iter().map(|node| node.counts[account]).collect();
        counts.sort_unstable();
        counts
    });
    let is_mesh = first.iter().filter(|count| **count > 1).count() >= LEAST_NODES;
    is_mesh && first == second
}

/// How many numbers two ascending lists have in common.
pub(super) fn n_shared(first: &[u32], second: &[u32]) -> usize {
    second.iter().filter(|other| first.binary_search(other).is_ok()).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: usize = 8;

    /// Neighbours by some pairs of eight nodes.
    fn coupling(pairs: &[(usize, usize)]) -> Vec<Vec<u32>> {
        let is_coupled = |node: usize, other: usize| pairs.contains(&(node, other)) || pairs.contains(&(other, node));
        let of_node = |node: usize| (0..N).filter(|other| is_coupled(node, *other)).map(|other| other as u32).collect();
        (0..N).map(of_node).collect()
    }

    /// Nodes in a line, in a given order.
    fn chain(order: [usize; N]) -> Vec<Vec<u32>> {
        let pairs: Vec<(usize, usize)> = order.windows(2).map(|pair| (pair[0], pair[1])).collect();
        coupling(&pairs)
    }

    fn apart(mass: &[Vec<u32>], stiffness: &[Vec<u32>]) -> Apart {
        Apart::of(N, |node| mass[node as usize].clone(), |node| stiffness[node as usize].clone())
    }

    #[test]
    fn nodes_are_apart_where_neighbours_are_others() {
        let natural = chain([0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(apart(&natural, &natural).nodes.len(), 0);
        assert_eq!(apart(&chain([0, 4, 1, 5, 2, 6, 3, 7]), &natural).nodes.len(), N);
        // A diagonal mass, a mass element over distant nodes, and the added mass of a fluid at all nodes are sound.
        let every: Vec<(usize, usize)> = (0..N).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
        for sound in [coupling(&[]), coupling(&[(0, 7)]), coupling(&every)] {
            assert_eq!(apart(&sound, &natural).nodes.len(), 0);
        }
    }

    #[test]
    fn two_nodes_exchanged_change_pairs_and_no_count() {
        let natural = chain([0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(apart(&chain([0, 2, 1, 3, 4, 5, 6, 7]), &natural).moved, [0, 1, 2, 3]);
        // Backwards is the same mesh, and a spring or a mass element more is another one.
        let [mut spring, mut instrument] = [(0..N - 1).map(|i| (i, i + 1)).collect::<Vec<_>>(), vec![]];
        instrument.extend_from_slice(&spring);
        spring.push((0, 5));
        instrument.push((2, 6));
        assert_eq!(apart(&chain([7, 6, 5, 4, 3, 2, 1, 0]), &natural).moved, [0; 0]);
        assert_eq!(apart(&natural, &coupling(&spring)).moved, [0; 0]);
        assert_eq!(apart(&coupling(&instrument), &natural).moved, [0; 0]);
    }
}
