//! Principal submatrices: some rows of a symmetric matrix and the same columns.

use super::SparseMatrix;

/// Rows and columns `kept` (ascending) of a symmetric matrix, with `load` added to its diagonal by rows of the whole; none where it is
/// shorter.
pub(crate) fn principal(matrix: &SparseMatrix, kept: &[usize], load: &[f64]) -> SparseMatrix {
    let mut position = vec![None; matrix.rows()];
    kept.iter().enumerate().for_each(|(new, old)| position[*old] = Some(new as u32));
    let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for (new, old) in kept.iter().enumerate() {
        let mut entries: Vec<(u32, f64)> = matrix
            .outer_view(*old)
            .into_iter()
            .flat_map(|row| row.iter().map(|(col, value)| (col, *value)).collect::<Vec<_>>())
            .filter_map(|(col, value)| position[col].map(|col| (col, value)))
            .collect();
        let load = load.get(*old).copied().unwrap_or(0.0);
        if load != 0.0 {
            match entries.binary_search_by_key(&(new as u32), |entry| entry.0) {
                Ok(at) => entries[at].1 += load,
                Err(at) => entries.insert(at, (new as u32, load)),
            }
        }
        columns.extend(entries.iter().map(|entry| entry.0));
        values.extend(entries.iter().map(|entry| entry.1));
        pointers.push(columns.len());
    }
    SparseMatrix::new((kept.len(), kept.len()), pointers, columns, values)
}
