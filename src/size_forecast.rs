//! Whether the answer will be large for what was asked, known before the long work.

use crate::error::Warning;
use crate::job::{Job, ModeSelection};
use crate::number::{count, counted, quantity};
use crate::partition::Partition;

/// Coordinates of one interface with dofs of its own from which on a patch is worth a thought: K̂ and M̂ are full matrices, and a
/// simulation seldom has a joint with more than a dozen dofs.
const MANY_DOFS: usize = 100;
/// Modes from which on they are many for a superelement: beyond them they come in slices, and full matrices of that order take longer
/// to integrate than the sparse ones of many components.
const MANY_MODES: usize = 400;

/// The code of both warnings.
const CODE: &str = "W-LARGE";

/// Interfaces with many dofs of their own.
pub fn of_interfaces(partition: &Partition) -> Vec<Warning> {
    let mut found: Vec<(&str, usize, usize, bool)> = Vec::new();
    for node in partition.interface.iter().filter(|node| !node.coupling.is_patch()) {
        let is_rows = node.directions.is_empty();
        let n_dofs = if is_rows { node.n_nodes } else { node.directions.len() };
        match found.last_mut().filter(|last| last.0 == node.name) {
            Some(last) => (last.1, last.2) = (last.1 + node.n_nodes, last.2 + n_dofs),
            None => found.push((&node.name, node.n_nodes, n_dofs, is_rows)),
        }
    }
    let large = found.into_iter().filter(|(_, _, n_dofs, _)| *n_dofs > MANY_DOFS);
    let message = |(name, n_nodes, n_dofs, is_rows): (&str, usize, usize, bool)| match is_rows {
        true => format!("interface `{name}` has {} rows: as many coordinates; take fewer", count(n_dofs as u64)),
        false => format!(
            "interface `{name}` has {} with dofs of their own: {}; `coupling = \"rigid\"` or `\"average\"` would be 6",
            counted(n_nodes, "node", "nodes"),
            counted(n_dofs, "coordinate", "coordinates")
        ),
    };
    large.map(|interface| Warning { code: CODE, message: message(interface) }).collect()
}

/// Many modes, by how many are going to be found, or were.
pub fn of_modes(n_modes: usize, job: &Job) -> Option<Warning> {
    if n_modes <= MANY_MODES {
        return None;
    }
    let asked = match job.reduction.wanted() {
        ModeSelection::UpTo { up_to_hz } => {
            format!(
                "{} Hz: check its unit; twice the highest frequency that the simulation excites is enough as a rule",
                quantity(up_to_hz, 5)
            )
        }
        ModeSelection::Count { count: asked } => format!("{} of them: ask for fewer", count(asked as u64)),
    };
    let message = format!(
        "{} modes are kept, each a coordinate of full matrices, because the job asks for {}{asked}",
        count(n_modes as u64),
        if matches!(job.reduction.wanted(), ModeSelection::UpTo { .. }) { "those up to " } else { "" }
    );
    Some(Warning { code: CODE, message })
}
