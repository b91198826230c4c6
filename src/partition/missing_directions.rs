//! Interface nodes that lack a direction: constrained dofs leave no row in the matrices, so that only their absence shows.

use std::collections::{BTreeMap, BTreeSet};

use crate::dofs::Direction;
use crate::job::Coupling;
use crate::model::{Finding, Model};

use super::interface_node::{Interfaces, Resolved};

/// One finding for each interface node, or node of a patch, that is held in a direction.
///
/// A node counts as held where it has one translation and lacks another that most nodes with translations have, and the
/// same for rotations: solids among shells have no rotations at all and are none the worse for it.
pub(super) fn constrained_nodes(model: &Model, interfaces: &Interfaces) -> Vec<Finding> {
    let Some(dofs) = &model.dofs else {
        return Vec::new();
    };
    let mut of_node: BTreeMap<i64, BTreeSet<Direction>> = BTreeMap::new();
    for dof in dofs.iter().flatten() {
        of_node.entry(dof.node).or_default().insert(dof.direction);
    }
    let usual = [&Direction::ALL[..3], &Direction::ALL[3..]].map(|kind| usual_directions(&of_node, kind));
    let mut findings = Vec::new();
    for Resolved { node, rows, .. } in &interfaces.list {
        let labels: BTreeSet<i64> = rows.all().iter().filter_map(|row| dofs[*row]).map(|dof| dof.node).collect();
        for label in labels {
            let has = &of_node[&label];
            let lacking = usual.iter().filter(|usual| usual.iter().any(|direction| has.contains(direction)));
            let lacks: Vec<Direction> = lacking.flatten().filter(|d| !has.contains(d)).copied().collect();
            // A node that couples directly is asked for the directions its job lists and no others.
            let asked = |direction: &Direction| {
                node.coupling == Coupling::Rigid
                    || node.coupling == Coupling::Average && !direction.is_rotation()
                    || node.directions.iter().any(|d| d.is_rotation() == direction.is_rotation())
            };
            let lacks: Vec<Direction> = lacks.into_iter().filter(asked).collect();
            if !lacks.is_empty() {
                findings.push(Finding::ConstrainedInterface { interface: node.name.clone(), node: label, lacks });
            }
        }
    }
    findings
}

/// Those directions of a kind, translations or rotations, that more than half of the nodes with any of them have.
fn usual_directions(of_node: &BTreeMap<i64, BTreeSet<Direction>>, kind: &[Direction]) -> Vec<Direction> {
    let n_nodes = of_node.values().filter(|has| kind.iter().any(|direction| has.contains(direction))).count();
    let n_with = |direction: &Direction| of_node.values().filter(|has| has.contains(direction)).count();
    kind.iter().filter(|direction| 2 * n_with(direction) > n_nodes).copied().collect()
}
