//! Whether file and job speak of the same component: M-26.

use supel_runtime::{Coordinate, Superelement};

use crate::input::Direction;
use crate::output::InputFacts;
use crate::partition::{DofOrigin, InterfaceNode, Partition, ReducedDof};
use crate::verification::check::{Check, Limits};

/// M-26: digests of the inputs. Other files may hold the same matrices, which the other checks tell.
pub(super) fn digests(superelement: &Superelement, facts: &InputFacts) -> Check {
    let recorded = &superelement.metadata().inputs;
    let is_matrix = |role: &str| matches!(role, "stiffness" | "mass");
    // Files of earlier versions record the matrices alone.
    let differs = |role: &str, digest: &str| match recorded.get(role) {
        Some(recorded) => recorded != digest,
        None => is_matrix(role),
    };
    let found = facts.digests();
    let others: Vec<&str> =
        found.into_iter().filter(|(role, digest)| differs(role, digest)).map(|(role, _)| role).collect();
    Check {
        id: "M-26",
        name: "it was made from the files of the job",
        equation: "number of input files with another digest",
        value: others.len() as f64,
        limits: Limits::default(),
        fail_above: Check::NEVER,
        worst: (!others.is_empty()).then(|| others.join(", ")),
    }
}

/// M-26: interface coordinates, one by one.
pub(super) fn interface(superelement: &Superelement, partition: &Partition) -> Check {
    let stored = stored(superelement);
    let has_nodes = !superelement.metadata().interface_nodes.is_empty();
    let asked = if has_nodes { nodes_asked(partition) } else { rows_asked(partition) };
    let first = stored.iter().zip(&asked).find(|(a, b)| a != b);
    let n_different = stored.iter().zip(&asked).filter(|(a, b)| a != b).count() + stored.len().abs_diff(asked.len());
    let worst = match first {
        Some((a, b)) => Some(format!("{a} in the file, {b} by the job")),
        None if n_different > 0 => {
            Some(format!("{} coordinates in the file, {} by the job", stored.len(), asked.len()))
        }
        None => None,
    };
    Check {
        id: "M-26",
        name: "interface is that of the job",
        equation: "number of interface coordinates at another node, position or direction",
        value: n_different as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst,
    }
}

fn stored(superelement: &Superelement) -> Vec<String> {
    let metadata = superelement.metadata();
    let of = |coordinate: &Coordinate| match *coordinate {
        Coordinate::Interface { node, direction } => {
            let node = &metadata.interface_nodes[node];
            let direction = format!("{direction:?}").to_lowercase();
            Some(described(&node.name, node.label, &direction, node.position))
        }
        Coordinate::InterfaceRow { row } => Some(format!("row {}", row + 1)),
        _ => None,
    };
    metadata.coordinates.iter().filter_map(of).collect()
}

/// The same of the job, for a file that names no nodes.
fn rows_asked(partition: &Partition) -> Vec<String> {
    let of = |dof: &ReducedDof| match dof.origin {
        DofOrigin::Row(row) => format!("row {}", partition.model.rows.of(row) + 1),
        DofOrigin::RigidNode(node, _) => format!("row {}", node + 1),
    };
    partition.dofs[partition.n_internal..].iter().map(of).collect()
}

/// The same of the job, for a file that names nodes.
fn nodes_asked(partition: &Partition) -> Vec<String> {
    let of = |node: &InterfaceNode| -> Vec<String> {
        let position = node.position.unwrap_or_default();
        let name = |direction: &Direction| described(&node.name, node.label, &direction.to_string(), position);
        node.directions.iter().map(name).collect()
    };
    partition.interface.iter().flat_map(of).collect()
}

fn described(name: &str, label: Option<i64>, direction: &str, position: [f64; 3]) -> String {
    let label = label.map(|label| format!(" node {label}")).unwrap_or_default();
    let [x, y, z] = position;
    format!("{name}{label} {direction} at ({x}, {y}, {z})")
}
