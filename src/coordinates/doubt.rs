//! Bodies whose coordinates K does not confirm at once, and where.

use std::collections::BTreeMap;

use super::motions::{Body, Motions};
use crate::input::Direction;
use crate::model::{Finding, node_of_row};
use crate::rigid::FREE_BELOW_NOISE;

/// A force is worth a look when it exceeds this many times the noise of the data, or that of a translation: what a producer
/// rounds while it assembles K shows in both.
const NOTICEABLE: f64 = 100.0;
/// Force of a translation, relative to the terms of its row, above which a support touches the row: far above what a
/// producer rounds, far below any support.
const TOUCHED: f64 = 1e-9;
/// Displacement, for a body of unit size, that six digits lose: nodes are not told apart below it.
const SIX_DIGITS: f64 = 1e-6;
/// Nodes out of place that a message names.
const SHOWN_NODES: usize = 3;
/// Share of the rows of a held body that supports may touch before the others are too few to be a witness: rows in an order
/// that the map does not say make forces at all of them.
const NEARLY_ALL: f64 = 0.9;
/// The first of the rotations among the six motions.
const FIRST_ROTATION: usize = 3;

/// A body that supports touch, or whose rotations make forces where no support is.
pub(super) struct Doubt {
    /// Its number.
    pub(super) body: usize,
    /// Rows of nodes that no support touches, ascending.
    pub(super) untouched: Vec<usize>,
    /// Rotations (3 to 5) that make forces on those rows, the worst first.
    pub(super) costly: Vec<usize>,
}

impl Doubt {
    /// Rows of the body that supports touch.
    pub(super) fn n_touched(&self, motions: &Motions<'_>) -> usize {
        motions.bodies[self.body].rows.len() - self.untouched.len()
    }
}

/// The bodies that need a second look.
pub(super) fn doubts(motions: &Motions<'_>, nodes: &Nodes, held: &[Direction]) -> Vec<Doubt> {
    let of_body = |(number, body): (usize, &Body)| {
        let untouched = nodes.untouched_rows(body);
        let costly = costly_rotations(motions, body, &untouched, held);
        let is_in_doubt = !costly.is_empty() || untouched.len() < body.rows.len();
        is_in_doubt.then_some(Doubt { body: number, untouched, costly })
    };
    motions.bodies.iter().enumerate().filter_map(of_body).collect()
}

/// The nodes of the model and where supports may be.
pub(super) struct Nodes {
    pub(super) of_row: Vec<u32>,
    /// Nodes with a row on which a translation does not vanish.
    is_touched: Vec<bool>,
    /// Nodes that lack a direction which most nodes have, and their neighbours in K. A held dof leaves no row in the matrices; a
    /// held rotation need not show under translation, nor a held displacement in rows across it.
    pub(super) is_near_lack: Vec<bool>,
}

impl Nodes {
    pub(super) fn of(motions: &Motions<'_>) -> Self {
        let of_row = node_of_row(motions.sites.len(), motions.model.dofs.as_deref());
        let n_nodes = of_row.iter().max().map_or(0, |max| *max as usize + 1);
        let share = TOUCHED.max(NOTICEABLE * motions.rounding());
        let force = |row: usize| (0..FIRST_ROTATION).fold(0.0, |max: f64, j| max.max(motions.forces[(row, j)].abs()));
        let mut is_touched = vec![false; n_nodes];
        let mut has = vec![[false; 6]; n_nodes];
        for (row, node) in of_row.iter().enumerate() {
            is_touched[*node as usize] |= force(row) > share * motions.scale_of(row);
            has[*node as usize][motions.sites[row].direction as usize] = true;
        }
        let n_with = |direction: usize| has.iter().filter(|has| has[direction]).count();
        let usual: [bool; 6] = std::array::from_fn(|direction| 2 * n_with(direction) > n_nodes);
        let lacks = |node: u32| (0..6).any(|direction| usual[direction] && !has[node as usize][direction]);
        let mut is_near_lack = vec![false; n_nodes];
        for (row, entries) in motions.model.stiffness.outer_iterator().enumerate() {
            let is_near = entries.iter().any(|(col, value)| *value != 0.0 && lacks(of_row[col]));
            is_near_lack[of_row[row] as usize] |= is_near;
        }
        Self { of_row, is_touched, is_near_lack }
    }

    /// Rows of a body that are no part of a support; all of them where no translation makes a force.
    fn untouched_rows(&self, body: &Body) -> Vec<usize> {
        let node = |row: &usize| self.of_row[*row] as usize;
        if body.rows.iter().all(|row| !self.is_touched[node(row)]) {
            return body.rows.clone();
        }
        let is_free = |row: &usize| !self.is_touched[node(row)] && !self.is_near_lack[node(row)];
        body.rows.iter().copied().filter(is_free).collect()
    }
}

/// Rotations that do not vanish on the untouched rows, the worst first.
///
/// An energy within its noise says little, for it is the square of the force; and in a thin body little force is much energy.
fn costly_rotations(motions: &Motions<'_>, body: &Body, untouched: &[usize], held: &[Direction]) -> Vec<usize> {
    let residual = |motion: usize| motions.residual(body, untouched, motion);
    let noise = (0..FIRST_ROTATION).map(residual).fold(motions.rounding(), f64::max);
    let is_free = untouched.len() == body.rows.len();
    let has_energy = |motion: usize| {
        let (energy, terms) = motions.energy(body, motion);
        is_free && energy > FREE_BELOW_NOISE * motions.rounding() * terms
    };
    let mut costly: Vec<(usize, f64)> = (FIRST_ROTATION..6)
        .filter(|motion| !held.contains(&Direction::ALL[*motion]))
        .map(|motion| (motion, residual(motion)))
        .filter(|(motion, residual)| *residual > NOTICEABLE * noise || has_energy(*motion))
        .collect();
    costly.sort_by(|a, b| b.1.total_cmp(&a.1));
    costly.into_iter().map(|(motion, _)| motion).collect()
}

/// What is to be said where supports touch nearly all rows of the bodies that they hold.
pub(super) fn untested(motions: &Motions<'_>, doubts: &[Doubt]) -> Option<Finding> {
    let held = || doubts.iter().filter(|doubt| doubt.n_touched(motions) > 0);
    let n_rows: usize = held().map(|doubt| motions.bodies[doubt.body].rows.len()).sum();
    let n_touched: usize = held().map(|doubt| doubt.n_touched(motions)).sum();
    let is_untested = n_touched as f64 > NEARLY_ALL * n_rows as f64;
    is_untested.then_some(Finding::CoordinatesUntested { n_touched, n_rows })
}

/// The rotations that the job says to be held and that no row answers with a force.
pub(super) fn not_held(motions: &Motions<'_>, held: &[Direction]) -> Option<Finding> {
    let is_free = |direction: &Direction| {
        motions
            .bodies
            .iter()
            .all(|body| motions.residual(body, &body.rows, *direction as usize) <= NOTICEABLE * motions.rounding())
    };
    let rotations: Vec<Direction> = held.iter().copied().filter(is_free).collect();
    (!rotations.is_empty()).then_some(Finding::RotationsFree { rotations })
}

/// Where the forces of some motions are largest, relative to the terms of their rows: as displacements, which tell nodes out of
/// place from the stiffness around them.
pub(super) struct Place {
    /// The dofs, one for each of the worst nodes.
    pub(super) at: String,
    /// The largest displacement over that of the median node, or over what six digits lose.
    pub(super) concentration: f64,
}

impl Place {
    /// Over some rows.
    pub(super) fn of(motions: &Motions<'_>, rows: &[usize], columns: &[usize]) -> Self {
        let mut of_node: BTreeMap<i64, (f64, usize)> = BTreeMap::new();
        for row in rows.iter().copied() {
            let force = columns.iter().map(|j| motions.forces[(row, *j)].abs()).fold(0.0, f64::max);
            let terms = motions.scale_of(row);
            let displacement = if terms > 0.0 { force / terms } else { 0.0 };
            let label = motions.model.dofs.as_ref().map_or(row as i64, |dofs| dofs[row].node);
            let node = of_node.entry(label).or_insert((displacement, row));
            if displacement > node.0 {
                *node = (displacement, row);
            }
        }
        let mut nodes: Vec<(f64, usize)> = of_node.into_values().collect();
        nodes.sort_by(|a, b| b.0.total_cmp(&a.0));
        let median = nodes.get(nodes.len() / 2).map_or(0.0, |node| node.0);
        let at: Vec<String> = nodes.iter().take(SHOWN_NODES).map(|(_, row)| motions.name_of(*row)).collect();
        let concentration = nodes.first().map_or(1.0, |node| node.0 / median.max(SIX_DIGITS));
        Self { at: at.join(", "), concentration }
    }
}
