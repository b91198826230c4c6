//! Rotations of interface nodes that are nearly without stiffness, as that about the normal of a shell.
//!
//! ```text
//! K_θθ    rows of K of the rotations of a node, all other dofs held: 3 × 3 at most
//! ```
//! Its least eigenvalue bounds the stiffness that the interface has about that axis, K̂_BB being a Schur complement: a joint that
//! takes a moment there turns the node and little else.

use faer::Mat;

use super::results::Results;
use crate::dense;
use crate::error::Warning;
use crate::job::Coupling;
use crate::number::{counted, quantity};
use crate::partition::InterfaceNode;

/// Share of the largest rotational stiffness of a node at which another one is hardly any. A strip a hundred times as wide as thick
/// resists twisting with 4e-5 of what it resists bending in its plane with; what programs add about the normal of a shell, to keep K
/// regular, is 1e-5 of bending and less.
const HARDLY_ANY: f64 = 2e-5;

/// The first node with such a rotation, and how many more there are.
pub(super) fn soft_rotation(results: &Results<'_>) -> Option<Warning> {
    let partition = results.evidence.partition;
    let mut first = partition.n_internal;
    let mut soft: Vec<(&InterfaceNode, f64, [f64; 3])> = Vec::new();
    for node in &partition.interface {
        let rotations = || node.directions.iter().enumerate().filter(|(_, direction)| direction.is_rotation());
        let dofs: Vec<usize> = rotations().map(|(at, _)| first + at).collect();
        first += if node.directions.is_empty() { node.n_nodes } else { node.directions.len() };
        if node.coupling != Coupling::Direct || dofs.len() < 2 {
            continue;
        }
        let entry = |i: usize, j: usize| partition.stiffness.get(dofs[i], dofs[j]).copied().unwrap_or(0.0);
        let block = Mat::from_fn(dofs.len(), dofs.len(), entry);
        let Ok((values, vectors)) = dense::symmetric_eigen(block.as_ref()) else { continue };
        let share = values[0].max(0.0) / values[values.len() - 1];
        if share <= HARDLY_ANY {
            let mut axis = [0.0; 3];
            rotations().enumerate().for_each(|(i, (_, direction))| axis[direction.axis()] = vectors[(i, 0)]);
            soft.push((node, share, axis));
        }
    }
    let (node, share, axis) = soft.first()?;
    let label = node.label.map(|label| format!("node {label} of ")).unwrap_or_default();
    let others = match soft.len() - 1 {
        0 => String::new(),
        more => format!(", and {} like it", counted(more, "node", "nodes")),
    };
    Some(Warning {
        code: "W-SOFT-ROTATION",
        message: format!(
            "{label}interface {:?}{others}: the rotation about ({}) has {share:.0e} of the stiffness of another one, as that about the \
             normal of a shell has, and a moment there turns the node alone; couple a patch of nodes around it, by \
             coupling = \"rigid\" or \"average\"",
            node.name,
            axis.map(|x| quantity(if x.abs() < 1e-3 { 0.0 } else { x * sign(*axis) }, 3)).join(", ")
        ),
    })
}

/// Makes the largest component of an axis positive.
fn sign(axis: [f64; 3]) -> f64 {
    axis.into_iter().fold(0.0f64, |max, x| if x.abs() > max.abs() { x } else { max }).signum()
}
