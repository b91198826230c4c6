//! Whether K confirms where the nodes of patches are.
//!
//! A patch ties its nodes by their coordinates: u_a = ω_b x_c of the three axes a, b and c. Where K answers a turn about b with no force
//! at a row that it couples with u_a, the coordinate c is confirmed, and where it answers translations with none there, so are the axes of
//! the node. What supports and springs make forces at, or axes that nobody declared, bears no witness; and a chain of such nodes may reach a
//! patch that no support is near. A motion that supports let pass makes no force anywhere, and is witness for all that it moves: `passing`.

use std::collections::{BTreeMap, BTreeSet};

use super::motions::{FIVE_DIGITS, Motions};
use super::nodes::{FIRST_ROTATION, Nodes, makes_force};
use super::passing::Passing;
use crate::dofs::Direction;
use crate::error::Result;
use crate::model::Finding;
use crate::partition::TiedNodes;

/// Share of the terms of a row from which on it feels a displacement that it is coupled with.
const FELT: f64 = 1e-3;
/// Nodes that a message names.
const SHOWN_NODES: usize = 3;

/// What is known of patches, and of the rows that may confirm their nodes.
struct Witnesses<'a> {
    motions: &'a Motions<'a>,
    nodes: &'a Nodes,
    /// Rows of each node.
    rows_of: Vec<Vec<usize>>,
    /// The body of each node, where it is in one.
    body_of: Vec<Option<usize>>,
    /// How far from the plane across each axis the nodes of a body lie that have no displacement along it.
    spread: Vec<[f64; 3]>,
    /// The motions of each body that supports let pass.
    passing: Vec<Passing>,
}

/// Says which nodes of patches nothing confirms, where there are any.
///
/// # Errors
/// A dense eigenproblem of order three that does not converge.
pub(super) fn unconfirmed(motions: &Motions<'_>, nodes: &Nodes, tied: &TiedNodes) -> Result<Option<Finding>> {
    let Some(dofs) = motions.model.dofs.as_ref().filter(|_| !nodes.are_all_whole()) else { return Ok(None) };
    let mut labels: BTreeMap<usize, i64> = BTreeMap::new();
    let dofs = dofs.iter().enumerate().filter_map(|(row, dof)| dof.map(|dof| (row, dof.node)));
    dofs.filter(|(_, node)| tied.contains(*node)).for_each(|(row, node)| {
        labels.insert(nodes.of(row), node);
    });
    if labels.is_empty() {
        return Ok(None);
    }
    let witnesses = Witnesses::of(motions, nodes)?;
    let unconfirmed: Vec<i64> =
        labels.iter().filter(|(node, _)| !witnesses.confirm(**node)).map(|(_, label)| *label).collect();
    let n_more = unconfirmed.len().saturating_sub(SHOWN_NODES);
    let more = if n_more > 0 { format!(" and {n_more} more") } else { String::new() };
    let shown: Vec<String> = unconfirmed.iter().take(SHOWN_NODES).map(i64::to_string).collect();
    let finding = || Finding::PatchNodesUntested {
        n_nodes: unconfirmed.len(),
        n_tied: labels.len(),
        at: format!("{}{more}", shown.join(", ")),
    };
    Ok((!unconfirmed.is_empty()).then(finding))
}

impl<'a> Witnesses<'a> {
    fn of(motions: &'a Motions<'a>, nodes: &'a Nodes) -> Result<Self> {
        let (mut rows_of, mut body_of) = (vec![Vec::new(); nodes.count()], vec![None; nodes.count()]);
        for (number, body) in motions.bodies.iter().enumerate() {
            for row in body.rows.iter().copied().filter(|row| nodes.is_placed(*row)) {
                rows_of[nodes.of(row)].push(row);
                body_of[nodes.of(row)] = Some(number);
            }
        }
        let passing = motions.bodies.iter().map(|body| Passing::of(motions, nodes, body)).collect::<Result<_>>()?;
        let mut extent = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 3]; motions.bodies.len()];
        for (rows, body) in rows_of.iter().zip(&body_of) {
            let (Some(body), Some(site)) = (*body, rows.first().and_then(|first| motions.sites[*first])) else {
                continue;
            };
            for axis in (0..3).filter(|axis| displacement_row(motions, rows, *axis).is_none()) {
                let [least, most] = &mut extent[body][axis];
                (*least, *most) = (least.min(site.position[axis]), most.max(site.position[axis]));
            }
        }
        let spread = extent.into_iter().map(|of_body| of_body.map(|[least, most]| most - least)).collect();
        Ok(Self { motions, nodes, rows_of, body_of, spread, passing })
    }

    /// Whether something confirms the coordinates and the axes by which a node is tied.
    fn confirm(&self, node: usize) -> bool {
        let around: BTreeSet<usize> = self.rows_of[node].iter().flat_map(|row| self.coupled(*row)).collect();
        // A plane of symmetry holds one translation, and axes that are off show along two at least.
        let has_axes = around.is_empty() || around.iter().any(|other| self.nodes.n_felt(*other) <= 1);
        (has_axes || self.passes_along_axes(node))
            && (0..3).all(|axis| self.confirms_coordinate(node, axis) || self.is_in_plane(node, axis))
    }

    /// The nodes that feel the displacement of a row, its own with them.
    fn coupled(&self, row: usize) -> Vec<usize> {
        let entries = self.motions.model.stiffness.outer_view(row);
        let entries = entries.iter().flat_map(|view| view.iter());
        let felt = entries.filter(|(at, value)| value.abs() > FELT * self.motions.scale_of(*at));
        felt.map(|(at, _)| self.nodes.of(at)).collect()
    }

    /// Whether a coordinate moves no row of a node that has a stiffness, or K confirms one such motion.
    fn confirms_coordinate(&self, node: usize, axis: usize) -> bool {
        let [second, third] = [(axis + 1) % 3, (axis + 2) % 3];
        let moved = [(second, third), (third, second)].map(|(along, about)| {
            let coupled = self.row_of(node, along).map_or_else(Vec::new, |row| self.coupled(row));
            (coupled, about)
        });
        let passes = |about: usize| self.body_of[node].is_some_and(|body| self.passing[body].turns[about]);
        let confirms = |(coupled, about): &(Vec<usize>, usize)| {
            !coupled.is_empty() && passes(*about) || coupled.iter().any(|other| self.is_witness(*other, *about))
        };
        moved.iter().all(|(coupled, _)| coupled.is_empty()) || moved.iter().any(confirms)
    }

    /// Whether motions that pass move two displacements of a node, or all that it has: in other axes they would make forces.
    fn passes_along_axes(&self, node: usize) -> bool {
        let rows: Vec<usize> = (0..3).filter_map(|axis| self.row_of(node, axis)).collect();
        let Some(body) = self.body_of[node] else { return false };
        let n_moved = rows.iter().filter(|row| self.passing[body].moves(self.motions, **row)).count();
        n_moved >= rows.len().min(2)
    }

    fn row_of(&self, node: usize, axis: usize) -> Option<usize> {
        displacement_row(self.motions, &self.rows_of[node], axis)
    }

    /// Whether a node shows by the turn about an axis that another around it is out of place: it makes no force, and nothing holds what
    /// the turn moves. A support along the axis itself holds nothing of that.
    fn is_witness(&self, node: usize, about: usize) -> bool {
        let (Some(first), Some(body)) = (self.rows_of[node].first(), self.body_of[node]) else { return false };
        if self.nodes.is_witness(*first, about) {
            return true;
        }
        let lever_rounding = self.motions.bodies[body].lever_rounding;
        let noise = |row: usize| self.motions.rounding_at(row).max(lever_rounding);
        let is_out_of_place = |row: &usize| makes_force(self.motions, *row, FIRST_ROTATION + about, noise(*row));
        self.nodes.is_whole(*first, about)
            && (0..FIRST_ROTATION).all(|axis| axis == about || !self.nodes.feels(node, axis))
            && !self.rows_of[node].iter().any(is_out_of_place)
    }

    /// Whether a node has no displacement along an axis and lies in one plane across it with all others of its body that have none.
    fn is_in_plane(&self, node: usize, axis: usize) -> bool {
        self.row_of(node, axis).is_none()
            && self.body_of[node]
                .is_some_and(|body| self.spread[body][axis] <= FIVE_DIGITS * self.motions.bodies[body].frame.size)
    }
}

/// The row among those of a node that is its displacement along an axis.
fn displacement_row(motions: &Motions<'_>, rows: &[usize], axis: usize) -> Option<usize> {
    let is_it = |row: &usize| motions.sites[*row].is_some_and(|site| site.direction == Direction::ALL[axis]);
    rows.iter().copied().find(is_it)
}
