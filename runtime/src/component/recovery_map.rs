//! Recovery rows of a file in the coordinates of the deformation.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use super::dense;
use crate::motion::Vector3;
use crate::tensors::Recovery;

/// Recovery rows in the coordinates of the deformation, node by node.
#[derive(Clone, Debug)]
pub(super) struct RecoveryMap {
    /// rows × r.
    rows: Vec<f64>,
    /// Nodes that can be turned with the floating frame: all three translations, and all rotations or none.
    pub(super) labels: Vec<i64>,
    /// For each of them the row of each direction.
    directions: Vec<[Option<usize>; 6]>,
    /// Where each of them is, as far as the file says it.
    pub(super) positions: Option<Vec<Vector3>>,
    /// The other nodes of the file.
    pub(super) incomplete: Vec<i64>,
}

impl RecoveryMap {
    /// Ψ A, and which rows belong to which node, in the order of their first rows.
    pub(super) fn new(recovery: &Recovery, change: &[f64]) -> Self {
        let r = recovery.rows().cols();
        let mut rows = vec![0.0; recovery.rows().as_slice().len()];
        for (row, target) in recovery.rows().as_slice().chunks_exact(r).zip(rows.chunks_exact_mut(r)) {
            for (factor, change_row) in row.iter().zip(change.chunks_exact(r)) {
                dense::add_scaled(target, *factor, change_row);
            }
        }
        let mut of_node: BTreeMap<i64, [Option<usize>; 6]> = BTreeMap::new();
        for (row, dof) in recovery.dofs().iter().enumerate() {
            of_node.entry(dof.node).or_default()[dof.direction as usize] = Some(row);
        }
        let (mut labels, mut directions, mut incomplete) = (Vec::new(), Vec::new(), Vec::new());
        let mut positions = recovery.positions().map(|_| Vec::new());
        for (place, label) in recovery.labels().into_iter().enumerate() {
            if !is_complete(&of_node[&label]) {
                incomplete.push(label);
                continue;
            }
            labels.push(label);
            directions.push(of_node[&label]);
            if let (Some(kept), Some(all)) = (&mut positions, recovery.positions()) {
                kept.push(all[place]);
            }
        }
        Self { rows, labels, directions, positions, incomplete }
    }

    /// Displacement and rotation of a node in the floating frame; no rotation where none is recovered.
    pub(super) fn deformation(&self, place: usize, e: &[f64]) -> (Vector3, Option<Vector3>) {
        let value = |row: Option<usize>| row.map(|row| dense::dot(&self.rows[row * e.len()..(row + 1) * e.len()], e));
        let [x, y, z, rx, ry, rz] = self.directions[place].map(value);
        let rotation = rx.zip(ry).zip(rz).map(|((x, y), z)| [x, y, z]);
        ([x, y, z].map(Option::unwrap_or_default), rotation)
    }
}

/// Whether the directions of a node can be turned into others.
fn is_complete(directions: &[Option<usize>; 6]) -> bool {
    let n_rotations = directions[3..].iter().flatten().count();
    directions[..3].iter().all(Option::is_some) && (n_rotations == 0 || n_rotations == 3)
}
