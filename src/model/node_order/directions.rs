//! Whether the rows of one direction belong to the nodes that the map gives them.
//!
//! ```text
//! C_a    nodes that the rows of some directions at node a are coupled with by columns of all other directions
//! S_a    nodes that the rows of all other directions at node a are coupled with by columns of these
//! ```
//! An element couples all directions of its nodes, so that C_a lies in S_a. Rigid-body motion does not see rows of one rotation at other nodes,
//! nor those of one displacement at nodes with two coordinates in common: their labels may change places with no force at all. What such
//! rows are coupled with are the neighbours of another node b then: C_a lies in S_b. A spring or a lever that only one direction of a
//! node takes part in adds to C_a a node that is in no S_b together with the others.
//!
//! Directions that no element couples with others, as the stretching of straight bars along an axis, tell nothing.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::couplings::{Couplings, bits};
use crate::dofs::RowNames;
use crate::error::{Error, Result};
use crate::model::finding::Finding;

/// Fewer neighbours tell no node from others.
const LEAST_COUPLED: usize = 2;
/// Nodes that a warning names.
const SHOWN_NODES: usize = 3;
/// The directions that are asked together, as bits: each by itself, and all rotations.
const ASKED: [u8; 7] = [1, 2, 4, 8, 16, 32, 0b11_1000];

/// Compares the neighbours of the rows of each direction with those of all others.
///
/// # Errors
/// [`Error::DirectionInAnotherOrder`] where the rows of a direction are those of other nodes at more than half of all nodes; fewer are a
/// finding.
pub(super) fn compared((what, couplings): (&'static str, &Couplings), names: RowNames<'_>) -> Result<Option<Finding>> {
    let Some(dofs) = names.dofs else { return Ok(None) };
    let strayed = |asked: &u8| (*asked, Asked::about(*asked, couplings).strayed());
    let Some((asked, nodes)) = ASKED.iter().map(strayed).find(|(_, nodes)| nodes.len() > 1) else { return Ok(None) };
    let is_asked = |row: &usize| dofs[*row].is_some_and(|dof| asked >> dof.direction as u8 & 1 == 1);
    let rows = nodes.iter().filter_map(|node| couplings.rows(*node).find(is_asked));
    let n_nodes = couplings.n_nodes();
    if 2 * nodes.len() > n_nodes {
        let first = rows.map(|row| names.full(row)).next().unwrap_or_default();
        return Err(Error::DirectionInAnotherOrder { what, n_strayed: nodes.len(), n_nodes, first });
    }
    let at = rows.take(SHOWN_NODES).map(|row| names.full(row)).collect::<Vec<_>>().join(", ");
    Ok(Some(Finding::DirectionOfOthers { what, n_strayed: nodes.len(), n_nodes, at }))
}

/// What a matrix couples, asked about some directions.
struct Asked<'a> {
    couplings: &'a Couplings,
    /// Their rows by columns of all others.
    across: u64,
    /// The rows of all others by these columns.
    of_others: u64,
}

impl<'a> Asked<'a> {
    /// The directions are bits.
    fn about(directions: u8, couplings: &'a Couplings) -> Self {
        Self { couplings, across: bits(directions, !directions), of_others: bits(!directions, !directions) }
    }

    /// The nodes whose rows of these directions are coupled as those of another node, ascending.
    fn strayed(&self) -> Vec<u32> {
        let is_doubtful = |node: &u32| {
            let is_alone = |(other, coupled): &(u32, u64)| {
                other != node && coupled & self.across != 0 && coupled & self.of_others == 0
            };
            self.couplings.at(*node).iter().any(is_alone)
        };
        let doubtful: Vec<u32> = (0..self.couplings.n_nodes() as u32).into_par_iter().filter(is_doubtful).collect();
        let (mut strayed, mut taken) = (BTreeSet::new(), BTreeSet::new());
        for node in doubtful {
            let of_node = self.seen(node);
            let found = self.fits(&of_node).into_iter().find(|other| !taken.contains(&other.node));
            let Some(other) = found else { continue };
            taken.insert(other.node);
            strayed.insert(node);
            strayed.extend(other.fits(&of_node).then_some(other.node));
        }
        strayed.into_iter().collect()
    }

    /// The neighbours of a node by the rows asked and by all others.
    fn seen(&self, node: u32) -> Seen {
        let [across, own] = [self.across, self.of_others].map(|directions| self.couplings.by(node, directions));
        Seen { node, across, own }
    }

    /// Other nodes whose neighbours are those of the rows asked of a node. What a spring or a lever adds to a node comes with the neighbours of
    /// the node itself, and is none, unless the rows of the other node are coupled as those of this one: the two were exchanged.
    fn fits(&self, of_node: &Seen) -> Vec<Seen> {
        let Some(first) = of_node.across.first().filter(|_| of_node.across.len() >= LEAST_COUPLED) else {
            return Vec::new();
        };
        let near = self.couplings.by(*first, self.of_others).into_iter();
        let others = near.filter(|other| *other != of_node.node).map(|other| self.seen(other));
        let is_exchanged = |other: &Seen| other.fits(of_node) && !other.has_own();
        others.filter(|other| of_node.fits(other) && (!of_node.has_own() || is_exchanged(other))).collect()
    }
}

/// What a matrix couples a node with.
struct Seen {
    node: u32,
    /// C_a.
    across: Vec<u32>,
    /// S_a.
    own: Vec<u32>,
}

impl Seen {
    /// Whether the rows asked of this node are coupled with neighbours of another one alone.
    fn fits(&self, other: &Self) -> bool {
        let is_near = |node: &u32| *node == other.node || other.own.binary_search(node).is_ok();
        self.across.len() >= LEAST_COUPLED && self.across.iter().all(is_near)
    }

    /// Whether they are coupled with all neighbours of this node.
    fn has_own(&self) -> bool {
        self.own.iter().all(|node| *node == self.node || self.across.binary_search(node).is_ok())
    }
}
