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
    pub(super) labels: Vec<i64>,
    /// For each node the row of each direction.
    pub(super) directions: Vec<[Option<usize>; 6]>,
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
        let (mut labels, mut directions) = (Vec::new(), Vec::new());
        let mut places = BTreeMap::new();
        for (row, dof) in recovery.dofs().iter().enumerate() {
            let place = *places.entry(dof.node).or_insert_with(|| {
                labels.push(dof.node);
                directions.push([None; 6]);
                labels.len() - 1
            });
            directions[place][dof.direction as usize] = Some(row);
        }
        Self { rows, labels, directions }
    }

    /// Displacement and rotation of a node in the floating frame, each `None` unless all three are recovered.
    pub(super) fn deformation(&self, place: usize, e: &[f64]) -> [Option<Vector3>; 2] {
        let value = |row: usize| dense::dot(&self.rows[row * e.len()..(row + 1) * e.len()], e);
        let [x, y, z, rx, ry, rz] = self.directions[place];
        let three = |rows: [Option<usize>; 3]| match rows {
            [Some(x), Some(y), Some(z)] => Some([value(x), value(y), value(z)]),
            _ => None,
        };
        [three([x, y, z]), three([rx, ry, rz])]
    }
}
