//! Bodies whose coordinates the forces of rigid-body motion do not confirm, and the nodes where they do not.

use std::collections::BTreeMap;

use super::free::FREE_BELOW_NOISE;
use super::motions::{Body, Motions, SIX_DIGITS};
use super::nodes::{FIRST_ROTATION, NOTICEABLE, Nodes, makes_force};
use crate::dofs::Direction;
use crate::model::Finding;

/// Nodes out of place that a message names.
const SHOWN_NODES: usize = 3;
/// Share of the rows of a held body that supports may touch before the others are too few to be a witness: rows in an order
/// that the map does not say make forces at all of them.
const NEARLY_ALL: f64 = 0.9;

/// A body that supports touch, or whose rotations make forces where no support is.
pub(super) struct Doubt {
    /// Its number.
    pub(super) body: usize,
    /// Its rows that belong to nodes.
    pub(super) n_rows: usize,
    /// Rows of nodes on which a translation does not vanish.
    pub(super) n_touched: usize,
    /// Rows of nodes that no support touches, ascending.
    pub(super) untouched: Vec<usize>,
    /// Rotations that make forces where they should not, the worst first.
    pub(super) costly: Vec<Costly>,
}

/// A rotation of a body that does not vanish on rows where it should.
pub(super) struct Costly {
    /// Its number among the six motions, 3 to 5.
    pub(super) rotation: usize,
    /// ‖F‖ on the witnesses over ‖T‖.
    residual: f64,
    /// The rows where it should vanish, ascending.
    pub(super) witnesses: Vec<usize>,
    /// Whether no support holds a displacement that it makes.
    pub(super) is_free: bool,
}

/// The bodies that need a second look.
pub(super) fn doubts(motions: &Motions<'_>, nodes: &Nodes, held: &[Direction]) -> Vec<Doubt> {
    let of_body = |(number, body): (usize, &Body)| {
        let costly = costly_rotations(motions, nodes, body, held);
        let n_touched = body.rows.iter().filter(|row| nodes.is_touched(**row)).count();
        let is_in_doubt = n_touched > 0 || !costly.is_empty() || is_blind(motions, nodes, body, held);
        let untouched = || body.rows.iter().copied().filter(|row| nodes.is_untouched(*row)).collect();
        let n_rows = body.rows.iter().filter(|row| nodes.is_placed(**row)).count();
        is_in_doubt.then(|| Doubt { body: number, n_rows, n_touched, untouched: untouched(), costly })
    };
    motions.bodies.iter().enumerate().filter_map(of_body).collect()
}

/// Whether a rotation costs energy and no row may be asked for it, because every node lacks a displacement that it makes: of a plate
/// without in-plane displacements right coordinates make none of those, and wrong ones do.
fn is_blind(motions: &Motions<'_>, nodes: &Nodes, body: &Body, held: &[Direction]) -> bool {
    (0..3).filter(|axis| !held.contains(&Direction::ALL[FIRST_ROTATION + axis])).any(|axis| {
        body.rows.iter().all(|row| !nodes.is_witness(*row, axis)) && turning_costs(motions, body, FIRST_ROTATION + axis)
    })
}

/// Rotations that do not vanish where they should, the worst first.
///
/// An energy within its noise says little, for it is the square of the force; and in a thin body little force is much energy.
fn costly_rotations(motions: &Motions<'_>, nodes: &Nodes, body: &Body, held: &[Direction]) -> Vec<Costly> {
    let is_touched = body.rows.iter().any(|row| nodes.is_touched(*row));
    let look = |axis: usize| {
        let rotation = FIRST_ROTATION + axis;
        let is_free = !is_touched && body.rows.iter().all(|row| !nodes.lacks_displacement(*row, axis));
        let is_witness = |row: &usize| is_free && nodes.is_placed(*row) || nodes.is_witness(*row, axis);
        let witnesses: Vec<usize> = body.rows.iter().copied().filter(is_witness).collect();
        let residual = |motion: usize| motions.residual(body, &witnesses, motion);
        let noise = (0..FIRST_ROTATION).map(residual).fold(motions.rounding().max(body.lever_rounding), f64::max);
        let has_energy = is_free && turning_costs(motions, body, rotation);
        let residual = residual(rotation);
        let is_out_of_place = |row: &usize| is_out_of_place(motions, *row, (rotation, body.lever_rounding));
        let is_costly = residual > NOTICEABLE * noise || has_energy || witnesses.iter().any(is_out_of_place);
        is_costly.then_some(Costly { rotation, residual, witnesses, is_free })
    };
    let is_said = |axis: &usize| held.contains(&Direction::ALL[FIRST_ROTATION + axis]);
    let mut costly: Vec<Costly> = (0..3).filter(|axis| !is_said(axis)).filter_map(look).collect();
    costly.sort_by(|a, b| b.residual.total_cmp(&a.residual));
    costly
}

/// Whether a rotation makes a force at a row that is noticeable among the terms of this row alone: forces of a soft part are nothing among
/// those of a stiff one, and its frequencies depend on them all the same.
fn is_out_of_place(motions: &Motions<'_>, row: usize, (rotation, lever_rounding): (usize, f64)) -> bool {
    let of_translations = (0..FIRST_ROTATION).map(|motion| motions.displacement(row, motion));
    let noise = of_translations.fold(motions.rounding_at(row).max(lever_rounding), f64::max);
    makes_force(motions, row, rotation, noise)
}

/// Whether a rotation costs more than rounding, and more than soft springs to ground can hold of it. Those hold displacements by unit
/// rotation, which are one at most, no stiffer than they hold the translations all together.
fn turning_costs(motions: &Motions<'_>, body: &Body, rotation: usize) -> bool {
    let (energy, terms) = motions.energy(body, rotation);
    let moving: f64 = (0..FIRST_ROTATION).map(|translation| motions.energy(body, translation).0.max(0.0)).sum();
    energy > FREE_BELOW_NOISE * motions.rounding() * terms + NOTICEABLE * moving
}

/// What is to be said where supports touch nearly all rows of the bodies that they hold.
pub(super) fn untested(motions: &Motions<'_>, doubts: &[Doubt]) -> Option<Finding> {
    let held = || doubts.iter().filter(|doubt| doubt.n_touched > 0);
    let n_rows: usize = held().map(|doubt| doubt.n_rows).sum();
    let n_touched: usize = held().map(|doubt| doubt.n_touched).sum();
    let is_untested = n_touched as f64 > NEARLY_ALL * n_rows as f64;
    let of_body = |doubt: &Doubt| {
        let body = &motions.bodies[doubt.body];
        (0..FIRST_ROTATION).map(|motion| motions.residual(body, &body.rows, motion)).fold(0.0, f64::max)
    };
    let largest = held().map(of_body).fold(0.0, f64::max);
    is_untested.then_some(Finding::CoordinatesUntested { n_touched, n_rows, largest })
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
    /// The largest displacement, in units of the size of the body.
    pub(super) largest: f64,
}

impl Place {
    /// Over some rows.
    pub(super) fn of(motions: &Motions<'_>, rows: &[usize], columns: &[usize]) -> Self {
        let mut of_node: BTreeMap<i64, (f64, usize)> = BTreeMap::new();
        for row in rows.iter().copied() {
            let displacement = columns.iter().map(|j| motions.displacement(row, *j)).fold(0.0, f64::max);
            let dof = motions.model.dofs.as_ref().and_then(|dofs| dofs[row]);
            let label = dof.map_or(row as i64, |dof| dof.node);
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
        Self { at: at.join(", "), concentration, largest: nodes.first().map_or(0.0, |node| node.0) }
    }
}
