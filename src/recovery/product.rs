//! Products of rows and states.

use supel_runtime::Matrix;

/// A row of a matrix times a vector.
pub(super) fn times(matrix: &Matrix, row: usize, vector: &[f64]) -> f64 {
    matrix.row(row).unwrap_or_default().iter().zip(vector).map(|(a, b)| a * b).sum()
}
