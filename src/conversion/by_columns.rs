//! A matrix column by column.

use std::borrow::Cow;

use super::content::{Content, Shape};
use crate::sparse::SparseMatrix;

/// Compressed columns.
pub(super) struct ByColumns<'a> {
    /// Rows of the matrix whose columns are meant: that of a symmetric one is its own.
    columns: Cow<'a, SparseMatrix>,
    pub(super) shape: Shape,
}

impl<'a> ByColumns<'a> {
    pub(super) fn of(content: Content<'a>) -> Self {
        let Content { matrix, shape, .. } = content;
        let columns = match shape {
            Shape::Symmetric => Cow::Borrowed(matrix),
            // The rows of the transpose are the columns.
            Shape::Skew | Shape::General => Cow::Owned(matrix.to_other_storage().transpose_into()),
        };
        Self { columns, shape }
    }

    pub(super) fn order(&self) -> usize {
        self.columns.rows()
    }

    /// Entries in all columns before each, and in all.
    #[cfg(feature = "hdf5")]
    pub(super) fn pointers(&self) -> Vec<u64> {
        self.columns.indptr().raw_storage().iter().map(|pointer| *pointer as u64).collect()
    }

    /// Row of every entry.
    pub(super) fn rows(&self) -> &[u32] {
        self.columns.indices()
    }

    pub(super) fn values(&self) -> &[f64] {
        self.columns.data()
    }

    /// Strings of consecutive rows of a column: the first row, from zero, and the values, of which there are so many at most.
    pub(super) fn strings(&self, column: usize, longest: usize) -> Vec<(usize, &[f64])> {
        let pointers = self.columns.indptr();
        let place = pointers.raw_storage()[column]..pointers.raw_storage()[column + 1];
        let (rows, values) = (&self.rows()[place.clone()], &self.values()[place]);
        let mut strings = Vec::new();
        let mut at = 0;
        for run in rows.chunk_by(|a, b| a + 1 == *b) {
            for (part, start) in run.chunks(longest).zip((at..).step_by(longest)) {
                strings.push((part[0] as usize, &values[start..start + part.len()]));
            }
            at += run.len();
        }
        strings
    }
}
