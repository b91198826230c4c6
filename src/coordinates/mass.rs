//! Nodes whose mass depends on the direction: rows in frames that the map does not know, or in another order.
//!
//! A unit translation of all nodes gives every node a momentum along it, the same for every direction: the blocks of M that
//! couple translations are multiples of the identity. In another frame at some nodes the blocks are turned, and K alone could
//! not tell the frames from supports. A lumped mass, whose blocks couple no two nodes, is the same in every frame. The mass
//! of nodes with rotations is left out, because a beam's mass differs along it and across it.

use super::motions::Motions;
use super::nodes::Nodes;
use crate::model::{Finding, Site};
use crate::sparse::product_and_terms;

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
    // The momenta of a node: row by row its three directions, column by column the three translations.
    let (mut rows_of, mut turns) = (vec![[usize::MAX; 3]; nodes.count()], vec![false; nodes.count()]);
    for row in motions.bodies.iter().flat_map(|body| &body.rows) {
        let Some(Site { direction, .. }) = motions.sites[*row] else { continue };
        match direction.is_rotation() {
            true => turns[nodes.of(*row)] = true,
            false => rows_of[nodes.of(*row)][direction.axis()] = *row,
        }
    }
    // Axes that are off by so much turn a block from both sides, each axis by twice that.
    let axes = motions.model.axes.iter().flat_map(|axes| axes.of_node.values());
    let of_axes = AXES_TURN * axes.fold(0.0, |max: f64, digits| max.max(digits.off()));
    let is_turned = |rows: &[usize; 3]| {
        let size = (0..9).fold(0.0f64, |max, k| max.max(terms[(rows[k / 3], k % 3)]));
        let mass = momenta[(rows[0], 0)];
        let expected = |k: usize| if k / 3 == k % 3 { mass } else { 0.0 };
        let digits = (0..9).fold(0.0f64, |max, k| max.max(of_digits[(rows[k / 3], k % 3)]));
        let rounding = (DIFFERENT.max(of_axes) * size).max(DIGITS * digits);
        (0..9).any(|k| (momenta[(rows[k / 3], k % 3)] - expected(k)).abs() > rounding)
    };
    // So is that which condensation leaves, which rows without a place show that are amplitudes of modes.
    let couples_amplitudes = |row: &usize| {
        let entries = motions.model.mass.outer_view(*row);
        entries.iter().flat_map(|view| view.iter()).any(|(col, value)| *value != 0.0 && !nodes.is_placed(col))
    };
    // The consistent mass of a beam or shell is another along it than across, and its part at a removed node is missing.
    let is_whole = |node: usize, rows: &[usize; 3]| {
        !turns[node] && !nodes.is_near_lack(node) && !rows.contains(&usize::MAX) && !rows.iter().any(couples_amplitudes)
    };
    let whole = rows_of.iter().enumerate().filter(|(node, rows)| is_whole(*node, rows));
    let turned: Vec<usize> = whole.filter(|(_, rows)| is_turned(rows)).map(|(_, rows)| rows[0]).collect();
    let label = |row: &usize| {
        let dof = motions.model.dofs.as_ref().and_then(|dofs| dofs[*row]);
        dof.map_or_else(String::new, |dof| dof.node.to_string())
    };
    (!turned.is_empty()).then(|| Finding::MassByDirection {
        n_nodes: turned.len(),
        at: turned.iter().take(SHOWN_NODES).map(label).collect::<Vec<_>>().join(", "),
    })
}
