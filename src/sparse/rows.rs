//! Which rows a matrix couples.

use super::SparseMatrix;

/// Whether a matrix couples a row with one of a kind, by an entry that is not zero.
pub(crate) fn couples(matrix: &SparseMatrix, row: usize, is_of_kind: impl Fn(usize) -> bool) -> bool {
    let entries = matrix.outer_view(row);
    entries.iter().flat_map(|view| view.iter()).any(|(other, value)| *value != 0.0 && is_of_kind(other))
}

/// Whether a row has no entry other than zero.
pub(crate) fn is_empty_row(matrix: &SparseMatrix, row: usize) -> bool {
    !couples(matrix, row, |_| true)
}
