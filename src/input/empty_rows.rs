//! Rows that neither matrix uses: constrained or unused degrees of freedom that were exported all the same.

use super::{InputNote, MatrixInput};
use crate::dofs::{DofMap, FileRows};
use crate::sparse::{SparseMatrix, is_empty_row};

/// Drops the rows and columns without stiffness and mass from both matrices and from the dof map, but for those that constraints tie to
/// others (`tied`, ascending); says which are left.
pub(super) fn drop_empty(
    (stiffness, mass): (&mut MatrixInput, &mut MatrixInput),
    dofs: &mut Option<DofMap>,
    tied: &[u32],
) -> Option<(FileRows, InputNote)> {
    let n = stiffness.matrix.rows();
    let is_tied = |row: usize| tied.binary_search(&(row as u32)).is_ok();
    let has_entries = |row: usize| !is_empty_row(&stiffness.matrix, row) || !is_empty_row(&mass.matrix, row);
    let is_kept: Vec<bool> = (0..n).map(|row| has_entries(row) || is_tied(row)).collect();
    let count = is_kept.iter().filter(|kept| !**kept).count();
    // A pencil without any row is left as it is, to be refused by name.
    let first = is_kept.iter().position(|kept| !kept).filter(|_| count < n)?;
    let dof = dofs.as_ref().and_then(|dofs| dofs[first]);
    for matrix in [stiffness, mass] {
        matrix.matrix = without(&matrix.matrix, &is_kept);
    }
    if let Some(dofs) = dofs {
        let mut kept = is_kept.iter();
        dofs.retain(|_| kept.next().copied().unwrap_or(true));
    }
    Some((FileRows::kept(&is_kept), InputNote::EmptyRowsDropped { count, row: first + 1, dof }))
}

/// The rows and columns that are kept. Zeros stored in a column that goes go with it.
fn without(matrix: &SparseMatrix, is_kept: &[bool]) -> SparseMatrix {
    let mut new_number = Vec::with_capacity(is_kept.len());
    let mut n = 0u32;
    for kept in is_kept {
        new_number.push(n);
        n += u32::from(*kept);
    }
    let (mut pointers, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
    for (row, view) in matrix.outer_iterator().enumerate() {
        if !is_kept[row] {
            continue;
        }
        for (col, value) in view.iter().filter(|(col, _)| is_kept[*col]) {
            indices.push(new_number[col]);
            data.push(*value);
        }
        pointers.push(indices.len());
    }
    SparseMatrix::new((n as usize, n as usize), pointers, indices, data)
}
