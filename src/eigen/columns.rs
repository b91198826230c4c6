//! The vectors of a basis, in memory for the largest number that it may have.

use faer::{MatMut, MatRef};

/// A matrix of n rows stored by columns, all zero at first.
///
/// The system gives memory that nothing was written to as zeros, and for nothing: a column costs something when it comes, and then
/// to the thread that writes it. Memory that the program used before is cleared at once.
pub(super) struct Columns {
    n: usize,
    count: usize,
    values: Vec<f64>,
}

impl Columns {
    pub(super) fn zeros(n: usize, count: usize) -> Self {
        Self { n, count, values: vec![0.0; n * count] }
    }

    /// Makes room for more columns.
    pub(super) fn grow(&mut self, count: usize) {
        self.values.resize(self.n * count, 0.0);
        self.count = count;
    }

    pub(super) fn nrows(&self) -> usize {
        self.n
    }

    pub(super) fn as_ref(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.values, self.n, self.count)
    }

    pub(super) fn as_mut(&mut self) -> MatMut<'_, f64> {
        MatMut::from_column_major_slice_mut(&mut self.values, self.n, self.count)
    }
}
