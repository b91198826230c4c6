//! Rows of the basis in the user's units.

use supel_runtime::Matrix;

use super::results::Results;
use crate::reduction::panel_of;
use crate::sparse::panels;

/// Combinations of rows of Ψ, by the dofs of the partition and their factors, m × r' of the coordinates that are kept: displacements in the user's units per unit of each
/// coordinate. Columns of the basis come some at a time, and only the rows asked for are kept.
pub(super) fn combined_rows(results: &Results<'_>, rows: &[Vec<(u32, f64)>]) -> Matrix {
    let (partition, basis) = (results.evidence.partition, results.evidence.basis);
    let (n_b, r, shape) = (partition.n_interface(), basis.n_reduced(), partition.scaling.shape_unit());
    let mut values = vec![0.0; rows.len() * r];
    for columns in panels(r) {
        let panel = panel_of(basis, columns.clone());
        for (row, values) in rows.iter().zip(values.chunks_exact_mut(r)) {
            for (at, column) in columns.clone().enumerate() {
                let unit = if column < n_b { 1.0 } else { shape };
                values[column] = row.iter().map(|(dof, factor)| factor * (unit * panel[(*dof as usize, at)])).sum();
            }
        }
    }
    let kept = results.kept();
    Matrix::from_fn(rows.len(), kept.len(), |i, j| values[i * r + kept[j]])
}
