//! Patches that tie bodies which K does not connect: nothing but coordinates says where these lie to each other.

use std::collections::BTreeSet;

use super::interface_node::{Interfaces, Resolved};
use crate::model::{Finding, Model};
use crate::sparse::diagonal;

/// A remark for each patch over several bodies that have a stiffness.
pub(super) fn over_bodies(model: &Model, interfaces: &Interfaces) -> Vec<Finding> {
    if model.bodies.n_bodies < 2 {
        return Vec::new();
    }
    let stiffness = diagonal(&model.stiffness);
    let of_patch = |Resolved { node, rows, .. }: &Resolved| {
        let rows = rows.of_patch()?.iter().filter(|row| stiffness[**row] != 0.0);
        let bodies: BTreeSet<u32> = rows.map(|row| model.bodies.of_row[*row]).collect();
        let finding = || Finding::PatchOverBodies { interface: node.name.clone(), n_bodies: bodies.len() };
        (bodies.len() > 1).then(finding)
    };
    interfaces.list.iter().filter_map(of_patch).collect()
}
