//! Nodes whose mass depends on the direction: rows in frames that the map does not know, or in another order.
//!
//! A unit translation of all nodes gives every node a momentum along it, the same for every direction: the blocks of M that
//! couple translations are multiples of the identity. In another frame at some nodes the blocks are turned, and K alone could
//! not tell the frames from supports. A lumped mass, whose blocks couple no two nodes, is the same in every frame. The mass
//! of nodes with rotations is left out, because a beam's mass differs along it and across it.

use faer::Mat;

use super::motions::Motions;
use super::nodes::Nodes;
use crate::model::{Finding, Site};
use crate::sparse::{couples, product_and_terms};

/// Difference of momenta, relative to their terms, above which it is none of rounding by a producer.
const DIFFERENT: f64 = 1e-6;
/// Units of the last digit of M that a sum of its entries may be off by.
const DIGITS: f64 = 100.0;
/// Turns of a block from both sides, about two axes each, of twice what components of an axis are off by.
const AXES_TURN: f64 = 8.0;
/// Nodes that a message names.
const SHOWN_NODES: usize = 3;

/// The nodes that have another mass in one direction than in another.
pub(super) fn by_direction(motions: &Motions<'_>, nodes: &Nodes) -> Option<Finding> {
    let translations = motions.centred.as_ref().subcols(0, 3);
    let (momenta, terms) = product_and_terms(&motions.model.mass, translations);
    let of_digits = motions.model.precision.mass.terms((&motions.model.mass).into(), translations);
    let (rows_of, turns) = translations_of_nodes(motions, nodes);
    // A model in a plane has two, and one has no other to be compared with.
    let axes: Vec<usize> = (0..3).filter(|axis| rows_of.iter().any(|rows| rows[*axis] != usize::MAX)).collect();
    if axes.len() < 2 {
        return None;
    }
    // Axes that are off by so much turn a block from both sides, each axis by twice that.
    let given = motions.model.axes.iter().flat_map(|axes| axes.of_node.values());
    let of_axes = AXES_TURN * given.fold(0.0, |max: f64, digits| max.max(digits.off()));
    let pairs: Vec<(usize, usize)> = axes.iter().flat_map(|i| axes.iter().map(move |j| (*i, *j))).collect();
    // The momenta of a node: row by row its directions, column by column the translations.
    let is_turned = |rows: &[usize; 3]| {
        let largest_of = |of: &Mat<f64>| pairs.iter().fold(0.0f64, |max, (i, j)| max.max(of[(rows[*i], *j)]));
        let first = axes[0];
        let mass = momenta[(rows[first], first)];
        let rounding = (DIFFERENT.max(of_axes) * largest_of(&terms)).max(DIGITS * largest_of(&of_digits));
        let is_off = |(i, j): &(usize, usize)| {
            let expected = if i == j { mass } else { 0.0 };
            (momenta[(rows[*i], *j)] - expected).abs() > rounding
        };
        pairs.iter().any(is_off)
    };
    // So is that which condensation leaves, which rows without a place show that are amplitudes of modes.
    let couples_amplitudes = |row: &usize| couples(&motions.model.mass, *row, |col| !nodes.is_placed(col));
    let has_all = |rows: &[usize; 3]| axes.iter().all(|axis| rows[*axis] != usize::MAX);
    // Every node of a model in a plane lacks what moves across it, and none of its mass is missing for that.
    let is_near_lack = |node: usize, rows: &[usize; 3]| match axes.len() {
        3 => nodes.is_near_lack(node),
        _ => couples(&motions.model.stiffness, rows[axes[0]], |row| !has_all(&rows_of[nodes.of(row)])),
    };
    // The consistent mass of a beam or shell is another along it than across, and its part at a removed node is missing.
    let is_whole = |node: usize, rows: &[usize; 3]| {
        let mut of_axes = axes.iter().map(|axis| &rows[*axis]);
        !turns[node] && has_all(rows) && !is_near_lack(node, rows) && !of_axes.any(couples_amplitudes)
    };
    let whole = rows_of.iter().enumerate().filter(|(node, rows)| is_whole(*node, rows));
    let turned: Vec<usize> = whole.filter(|(_, rows)| is_turned(rows)).map(|(_, rows)| rows[axes[0]]).collect();
    let label = |row: &usize| {
        let dof = motions.model.dofs.as_ref().and_then(|dofs| dofs[*row]);
        dof.map_or_else(String::new, |dof| dof.node.to_string())
    };
    (!turned.is_empty()).then(|| Finding::MassByDirection {
        n_nodes: turned.len(),
        at: turned.iter().take(SHOWN_NODES).map(label).collect::<Vec<_>>().join(", "),
    })
}

/// The rows of the translations of each node, `usize::MAX` where it has none, and whether it has rotations.
fn translations_of_nodes(motions: &Motions<'_>, nodes: &Nodes) -> (Vec<[usize; 3]>, Vec<bool>) {
    let (mut rows_of, mut turns) = (vec![[usize::MAX; 3]; nodes.count()], vec![false; nodes.count()]);
    for row in motions.bodies.iter().flat_map(|body| &body.rows) {
        let Some(Site { direction, .. }) = motions.sites[*row] else { continue };
        match direction.is_rotation() {
            true => turns[nodes.of(*row)] = true,
            false => rows_of[nodes.of(*row)][direction.axis()] = *row,
        }
    }
    (rows_of, turns)
}
