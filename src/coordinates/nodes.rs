//! The nodes of a model, and which of them supports may hold.
//!
//! A held dof leaves no row in the matrices. Its absence shows in two ways: rows that were coupled to it make a force under the
//! translation along it, and its node lacks a direction. Where a node lacks a displacement that a rotation makes, its
//! neighbours in K make forces under that rotation even if the coordinates are right.

use super::motions::{FIVE_DIGITS, Motions};
use crate::model::{Site, node_of_row};

/// A force is worth a look when it exceeds this many times the noise of the data, or that of a translation: what a producer
/// rounds while it assembles K shows in both.
pub(super) const NOTICEABLE: f64 = 100.0;
/// The first of the rotations among the six motions.
pub(super) const FIRST_ROTATION: usize = 3;
/// Force of a translation, relative to the terms of its row, above which a support touches the row: far above what a
/// producer rounds, far below any support.
pub(super) const TOUCHED: f64 = 1e-9;
/// Displacement by a unit rotation, relative to the size of the body, below which it is none.
const NO_LEVER: f64 = 1e-9;
/// Bits of the three axes: displacements, and rotations.
const DISPLACEMENT: u8 = 1;
const ROTATION: u8 = 1 << 3;

/// What is known of each node.
pub(super) struct Nodes {
    of_row: Vec<u32>,
    /// Rows of nodes that have a place; amplitudes of modes have none.
    is_placed: Vec<bool>,
    /// Translations that do not vanish on some row of a node.
    felt: Vec<u8>,
    /// Rotations of which a node lacks a part: a displacement that they make, or the rotation itself where most nodes have it.
    lacks: Vec<u8>,
    /// Rotations of which a node or a neighbour in K lacks a part.
    near: Vec<u8>,
}

impl Nodes {
    /// Of a model.
    pub(super) fn of_model(motions: &Motions<'_>) -> Self {
        let of_row = node_of_row(motions.sites.len(), motions.model.dofs.as_deref());
        let n_nodes = of_row.iter().max().map_or(0, |max| *max as usize + 1);
        let mut felt = vec![0u8; n_nodes];
        // Nothing holds amplitudes of modes: what K couples them with motions of the whole is rounding of zero, all terms of it.
        let is_placed: Vec<bool> = motions.sites.iter().map(Option::is_some).collect();
        for (row, node) in of_row.iter().enumerate().filter(|(row, _)| is_placed[*row]) {
            let noticeable = noticeable_force(motions, row);
            let is_felt = |translation: &usize| motions.forces[(row, *translation)].abs() > noticeable;
            (0..FIRST_ROTATION).filter(is_felt).for_each(|translation| felt[*node as usize] |= 1 << translation);
        }
        let lacks = lacking(motions, &of_row, n_nodes);
        let mut near = lacks.clone();
        if lacks.iter().any(|lacks| *lacks > 0) {
            for (row, entries) in motions.model.stiffness.outer_iterator().enumerate() {
                let coupled = entries.iter().filter(|(_, value)| **value != 0.0);
                near[of_row[row] as usize] |= coupled.fold(0, |bits, (col, _)| bits | lacks[of_row[col] as usize]);
            }
        }
        Self { of_row, is_placed, felt, lacks, near }
    }

    /// The node of a row.
    pub(super) fn of(&self, row: usize) -> usize {
        self.of_row[row] as usize
    }

    /// Whether a row belongs to a node that has a place.
    pub(super) fn is_placed(&self, row: usize) -> bool {
        self.is_placed[row]
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.felt.len()
    }

    /// Whether a translation does not vanish on the node of a row.
    pub(super) fn is_touched(&self, row: usize) -> bool {
        self.felt[self.of(row)] != 0
    }

    /// Whether the translation along an axis does not vanish on a node.
    pub(super) fn feels(&self, node: usize, axis: usize) -> bool {
        self.felt[node] & 1 << axis != 0
    }

    /// How many translations do not vanish on a node.
    pub(super) fn n_felt(&self, node: usize) -> u32 {
        self.felt[node].count_ones()
    }

    /// Nodes on which a translation does not vanish.
    pub(super) fn n_touched(&self) -> usize {
        self.felt.iter().filter(|felt| **felt != 0).count()
    }

    /// Whether the node of a row lacks a displacement that a unit rotation about an axis makes.
    pub(super) fn lacks_displacement(&self, row: usize, axis: usize) -> bool {
        self.lacks[self.of(row)] & DISPLACEMENT << axis != 0
    }

    /// Whether all of a rotation about an axis is there around a row.
    pub(super) fn is_whole(&self, row: usize, axis: usize) -> bool {
        self.near[self.of(row)] & (DISPLACEMENT | ROTATION) << axis == 0
    }

    /// Whether all of a rotation about an axis is there around a row, and no support touches it.
    pub(super) fn is_witness(&self, row: usize, axis: usize) -> bool {
        self.is_placed[row] && !self.is_touched(row) && self.is_whole(row, axis)
    }

    /// Whether no support touches any node, and none lacks a direction.
    pub(super) fn are_all_whole(&self) -> bool {
        self.n_touched() == 0 && self.lacks.iter().all(|lacks| *lacks == 0)
    }

    /// Whether no support touches a row or may hold what is coupled to it.
    pub(super) fn is_untouched(&self, row: usize) -> bool {
        !self.is_touched(row) && !self.is_near_lack(self.of(row))
    }

    /// Whether a node or a neighbour of it lacks a direction.
    pub(super) fn is_near_lack(&self, node: usize) -> bool {
        self.near[node] != 0
    }
}

/// Whether a motion makes a force at a row that neither noise nor coordinates of five digits make.
pub(super) fn makes_force(motions: &Motions<'_>, row: usize, motion: usize, noise: f64) -> bool {
    motions.displacement(row, motion) > FIVE_DIGITS.max(NOTICEABLE * noise)
}

/// A force of a translation at a row above which something holds it, or above which its axes are off by more than their digits.
pub(super) fn noticeable_force(motions: &Motions<'_>, row: usize) -> f64 {
    TOUCHED.max(NOTICEABLE * motions.rounding_at(row)) * motions.scale_of(row) + motions.of_axes_at(row)
}

/// The rotations of which each node lacks a part.
fn lacking(motions: &Motions<'_>, of_row: &[u32], n_nodes: usize) -> Vec<u8> {
    let mut has = vec![[false; 6]; n_nodes];
    for (row, node) in of_row.iter().enumerate() {
        motions.sites[row].iter().for_each(|site| has[*node as usize][site.direction as usize] = true);
    }
    let n_places = has.iter().filter(|has| has.contains(&true)).count();
    let n_with = |direction: usize| has.iter().filter(|has| has[direction]).count();
    let turns = |has: &[bool; 6]| has[FIRST_ROTATION..].contains(&true);
    let n_turning = has.iter().filter(|has| turns(has)).count();
    let usual: [bool; 6] = std::array::from_fn(|direction| 2 * n_with(direction) > n_places);
    // A node of a solid lacks no rotation, and a node that has two may lack the third, though it be one of two nodes of a condensed stiffness.
    let usual_of_turning: [bool; 6] = std::array::from_fn(|direction| 2 * n_with(direction) >= n_turning);
    let mut lacks = vec![0u8; n_nodes];
    for body in &motions.bodies {
        for row in &body.rows {
            let (has, node) = (has[of_row[*row] as usize], of_row[*row] as usize);
            let Some(Site { position, .. }) = motions.sites[*row] else { continue };
            let lever = |axis: usize| (position[axis] - body.frame.centre[axis]).abs() > NO_LEVER * body.frame.size;
            for axis in 0..3 {
                // A rotation about an axis moves each of the two directions across it by the lever along the other.
                let across = [(axis + 1) % 3, (axis + 2) % 3];
                let lacks_displacement = !has[across[0]] && lever(across[1]) || !has[across[1]] && lever(across[0]);
                let rotation = FIRST_ROTATION + axis;
                let lacks_rotation = !has[rotation] && (usual[rotation] || turns(&has) && usual_of_turning[rotation]);
                lacks[node] |= u8::from(lacks_displacement) * (DISPLACEMENT << axis);
                lacks[node] |= u8::from(lacks_rotation) * (ROTATION << axis);
            }
        }
    }
    lacks
}
