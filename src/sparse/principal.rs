//! Principal submatrices: some rows of a symmetric matrix and the same columns.

use super::SparseMatrix;

/// Rows and columns `kept` (ascending) of a symmetric matrix, with `load` added to its diagonal by rows of the whole; none where it is
/// shorter.
pub(crate) fn principal(matrix: &SparseMatrix, kept: &[usize], load: &[f64]) -> SparseMatrix {
    const LEFT_OUT: u32 = u32::MAX;
    let mut position = vec![LEFT_OUT; matrix.rows()];
    kept.iter().enumerate().for_each(|(new, old)| position[*old] = new as u32);
    let n_at_most = kept.iter().filter_map(|old| matrix.outer_view(*old)).map(|row| row.nnz()).sum();
    let (mut pointers, mut columns, mut values) =
        (vec![0], Vec::with_capacity(n_at_most), Vec::with_capacity(n_at_most));
    for (new, old) in kept.iter().enumerate() {
        let start = columns.len();
        for (col, value) in matrix.outer_view(*old).iter().flat_map(|row| row.iter()) {
            if position[col] != LEFT_OUT {
                columns.push(position[col]);
                values.push(*value);
            }
        }
        let load = load.get(*old).copied().unwrap_or(0.0);
        if load != 0.0 {
            match columns[start..].binary_search(&(new as u32)) {
                Ok(at) => values[start + at] += load,
                Err(at) => {
                    columns.insert(start + at, new as u32);
                    values.insert(start + at, load);
                }
            }
        }
        pointers.push(columns.len());
    }
    SparseMatrix::new((kept.len(), kept.len()), pointers, columns, values)
}
