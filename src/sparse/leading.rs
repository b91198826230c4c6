//! The leading principal submatrix of order n, read where the whole matrix stores it.
//!
//! A partition numbers its internal dofs first, so that K_II and M_II are the leading blocks of K and M and need no storage of
//! their own. The order may be that of the whole: what takes a block takes a matrix, too.

use super::SparseMatrix;

/// The leading n × n block of a symmetric sparse matrix.
#[derive(Clone, Copy, Debug)]
pub struct Leading<'a> {
    /// The matrix that stores it.
    pub(super) whole: &'a SparseMatrix,
    n: usize,
}

impl<'a> Leading<'a> {
    /// The block of order `n` of a matrix.
    ///
    /// # Panics
    /// Where the matrix has fewer rows.
    pub fn new(whole: &'a SparseMatrix, n: usize) -> Self {
        assert!(n <= whole.rows(), "block of order {n} in a matrix of {} rows", whole.rows());
        Self { whole, n }
    }

    /// n.
    pub fn rows(self) -> usize {
        self.n
    }

    /// Whether nothing of a row is in other columns.
    pub(crate) fn is_diagonal_row(self, row: usize) -> bool {
        self.entries(row).all(|(column, value)| column == row || value == 0.0)
    }

    /// Whether the block is all of the matrix.
    pub fn is_whole(self) -> bool {
        self.n == self.whole.rows()
    }

    /// Stored entries of the block.
    pub fn nnz(self) -> usize {
        (0..self.n).map(|row| self.row(row).0.len()).sum()
    }

    /// Columns and values of the entries of a row that lie in the block, columns ascending.
    pub fn row(self, row: usize) -> (&'a [u32], &'a [f64]) {
        let pointers = self.whole.indptr().into_raw_storage();
        let stored = pointers[row]..pointers[row + 1];
        let (columns, values) = (&self.whole.indices()[stored.clone()], &self.whole.data()[stored]);
        // Most rows end before the block does, which their last column tells without a search.
        let is_inside = |col: &u32| (*col as usize) < self.n;
        if columns.last().is_none_or(is_inside) {
            return (columns, values);
        }
        let n_inside = columns.partition_point(is_inside);
        (&columns[..n_inside], &values[..n_inside])
    }

    /// The entries of a row with their columns, ascending.
    pub fn entries(self, row: usize) -> impl Iterator<Item = (usize, f64)> + 'a {
        let (columns, values) = self.row(row);
        columns.iter().zip(values).map(|(col, value)| (*col as usize, *value))
    }

    /// The diagonal, zero where no entry is stored.
    pub fn diagonal(self) -> Vec<f64> {
        let of_row = |row: usize| {
            let (columns, values) = self.row(row);
            columns.binary_search(&(row as u32)).map_or(0.0, |at| values[at])
        };
        (0..self.n).map(of_row).collect()
    }

    /// The block as a matrix of its own, to be changed.
    pub fn to_owned(self) -> SparseMatrix {
        let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for row in 0..self.n {
            columns.extend_from_slice(self.row(row).0);
            values.extend_from_slice(self.row(row).1);
            pointers.push(columns.len());
        }
        SparseMatrix::new((self.n, self.n), pointers, columns, values)
    }
}

/// The whole matrix.
impl<'a> From<&'a SparseMatrix> for Leading<'a> {
    fn from(matrix: &'a SparseMatrix) -> Self {
        Self::new(matrix, matrix.rows())
    }
}

/// The diagonal of a matrix, zero where no entry is stored.
pub fn diagonal<'a>(matrix: impl Into<Leading<'a>>) -> Vec<f64> {
    matrix.into().diagonal()
}

/// √(A_ii A_jj).
pub(crate) fn ends(diagonal: &[f64], row: usize, col: usize) -> f64 {
    (diagonal[row].abs() * diagonal[col].abs()).sqrt()
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;
    use crate::random::SplitMix64;
    use crate::sparse::{Declared, Triplets, absolute_product, product, product_and_terms};

    const ORDER: usize = 30;

    /// A random symmetric matrix, some rows of which have no diagonal.
    fn random() -> (SparseMatrix, Mat<f64>) {
        let mut numbers = Mat::zeros(ORDER, ORDER);
        SplitMix64::new(7).fill(numbers.as_mut());
        let mut full = Mat::zeros(ORDER, ORDER);
        let mut triplets = Triplets::default();
        for row in 0..ORDER {
            for col in (0..=row).filter(|col| (row + col) % 3 != 0) {
                let value = numbers[(row, col)];
                (full[(row, col)], full[(col, row)]) = (value, value);
                triplets.push(row as u32, col as u32, value);
            }
        }
        (triplets.assemble(ORDER, Declared::Symmetric, "random".as_ref()).expect("a matrix").0, full)
    }

    /// None of the block, some of it and all of the matrix.
    #[test]
    fn block_is_what_its_copy_is() {
        let (matrix, full) = random();
        for n in [0, 1, 17, ORDER - 1, ORDER] {
            let block = Leading::new(&matrix, n);
            let copy = block.to_owned();
            assert_eq!((block.rows(), block.nnz()), (n, copy.nnz()));
            assert_eq!(block.diagonal(), (0..n).map(|i| full[(i, i)]).collect::<Vec<_>>());
            assert!((0..n).all(|i| (0..n).all(|j| copy.get(i, j).copied().unwrap_or(0.0) == full[(i, j)])), "{n}");
            for k in [1, 2, 4, 11] {
                let x = Mat::from_fn(n, k, |row, col| 1.0 / (1 + row + 3 * col) as f64 - 0.1);
                let x = x.as_ref();
                assert!(product(block, x) == product(&copy, x), "product of order {n}, {k} columns");
                assert!(absolute_product(block, x) == absolute_product(&copy, x), "terms of order {n}, {k} columns");
                assert!(product_and_terms(block, x) == product_and_terms(&copy, x), "both of order {n}, {k} columns");
            }
        }
    }

    #[test]
    #[should_panic(expected = "block of order 31 in a matrix of 30 rows")]
    fn block_is_no_larger_than_its_matrix() {
        Leading::new(&random().0, ORDER + 1);
    }
}
