//! Entries of a symmetric matrix of which some have their mirror image and others stand for both.

use super::{SparseMatrix, diagonal};

/// Two values of one entry that differ by more of the larger one than this are not one value in different digits,
const MAX_DIFFERENCE: f64 = 1e-5;
/// and neither is what cancellation left of entries this many times as large, by √(A_ii A_jj).
const MAX_REMAINDER: f64 = 1e-9;

/// What [`completed`] made.
pub(crate) struct Completed {
    pub(crate) matrix: SparseMatrix,
    /// Pairs of a row and a column that had an entry at one place only.
    pub(crate) n_once: usize,
    /// Row and column, zero-based, of the first entry whose mirror image is another value.
    pub(crate) conflict: Option<(usize, usize)>,
}

/// The matrix with the mirror image of each entry that has none. What stands at both places stays.
pub(crate) fn completed(matrix: &SparseMatrix) -> Completed {
    let transposed = matrix.transpose_view().to_csr();
    let n = matrix.rows();
    let diagonal = diagonal(matrix);
    let (mut pointers, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
    let (mut n_once, mut conflict) = (0, None);
    for (row, (own, mirrored)) in matrix.outer_iterator().zip(transposed.outer_iterator()).enumerate() {
        let (mut own, mut mirrored) = (own.iter().peekable(), mirrored.iter().peekable());
        while let Some(col) = own.peek().into_iter().chain(mirrored.peek()).map(|(col, _)| *col).min() {
            let at_col = |entries: &mut Entries<'_>| entries.next_if(|(at, _)| *at == col).map(|(_, value)| *value);
            let (here, there) = (at_col(&mut own), at_col(&mut mirrored));
            if let Some((here, there)) = here.zip(there) {
                let size = (diagonal[row] * diagonal[col]).abs().sqrt();
                if conflict.is_none() && are_different(here, there, size) {
                    conflict = Some((row, col));
                }
            } else if here.is_some_and(|value| value != 0.0) {
                n_once += 1;
            }
            indices.push(col as u32);
            data.push(here.or(there).unwrap_or(0.0));
        }
        pointers.push(indices.len());
    }
    Completed { matrix: SparseMatrix::new((n, n), pointers, indices, data), n_once, conflict }
}

type Entries<'a> = std::iter::Peekable<sprs::vec::VectorIterator<'a, f64, u32>>;

/// Whether an entry and its mirror image are two values, where √(A_ii A_jj) is of that size.
fn are_different(here: f64, there: f64, size: f64) -> bool {
    let apart = (here - there).abs();
    apart > MAX_DIFFERENCE * here.abs().max(there.abs()) && apart > MAX_REMAINDER * size
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(entries: &[(usize, usize, f64)]) -> Completed {
        let mut triplets = sprs::TriMatI::<f64, u32>::new((3, 3));
        entries.iter().for_each(|(row, col, value)| triplets.add_triplet(*row, *col, *value));
        completed(&triplets.to_csr())
    }

    #[test]
    fn what_stands_once_stands_for_both_and_two_values_are_told() {
        let given = of(&[(0, 0, 4.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 5.0), (2, 1, -2.0), (2, 2, 6.0)]);
        assert_eq!((given.n_once, given.conflict), (1, None));
        assert_eq!((given.matrix.get(1, 2), given.matrix.get(2, 1)), (Some(&-2.0), Some(&-2.0)));
        let given = of(&[(0, 0, 4.0), (0, 1, -1.0), (1, 0, -2.0), (1, 1, 5.0)]);
        assert_eq!((given.n_once, given.conflict), (0, Some((0, 1))));
        // Roundings of the last digit, and what cancellation leaves.
        let given = of(&[
            (0, 0, 4.0),
            (0, 1, -1.000001),
            (1, 0, -1.0),
            (1, 1, 5.0),
            (2, 1, 1e-16),
            (1, 2, -1e-16),
            (2, 2, 6.0),
        ]);
        assert_eq!((given.n_once, given.conflict), (0, None));
    }
}
