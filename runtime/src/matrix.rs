//! Dense matrix of the superelement file, row by row.

use alloc::vec::Vec;

use crate::error::{FileError, Result};

/// A dense matrix in row-major order, the order of the file and of numpy.
///
/// It stores values and returns them. It does no arithmetic.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matrix {
    rows: usize,
    cols: usize,
    data: Vec<f64>,
}

impl Matrix {
    /// A matrix from its rows written one after the other.
    ///
    /// # Errors
    ///
    /// [`FileError::MatrixSize`] if there are not `rows * cols` values.
    pub fn from_row_major(rows: usize, cols: usize, data: Vec<f64>) -> Result<Self> {
        if rows.checked_mul(cols) == Some(data.len()) {
            Ok(Self { rows, cols, data })
        } else {
            Err(FileError::MatrixSize { rows, cols, found: data.len() })
        }
    }

    /// A matrix whose entry (i, j) is `entry(i, j)`; the way to hand over a column-major matrix.
    pub fn from_fn(rows: usize, cols: usize, mut entry: impl FnMut(usize, usize) -> f64) -> Self {
        let data = (0..rows).flat_map(|i| (0..cols).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect();
        Self { rows, cols, data }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn cols(&self) -> usize {
        self.cols
    }

    /// Entry (`row`, `col`), or `None` outside the matrix.
    pub fn get(&self, row: usize, col: usize) -> Option<f64> {
        self.row(row)?.get(col).copied()
    }

    /// Row `row`, or `None` outside the matrix.
    pub fn row(&self, row: usize) -> Option<&[f64]> {
        if row < self.rows { self.data.get(row * self.cols..(row + 1) * self.cols) } else { None }
    }

    /// All values, row by row.
    pub fn as_slice(&self) -> &[f64] {
        &self.data
    }
}

impl core::ops::Index<(usize, usize)> for Matrix {
    type Output = f64;

    /// Entry (i, j).
    ///
    /// # Panics
    ///
    /// Panics outside the matrix.
    fn index(&self, (row, col): (usize, usize)) -> &f64 {
        assert!(row < self.rows && col < self.cols, "({row}, {col}) outside a {} × {} matrix", self.rows, self.cols);
        &self.data[row * self.cols + col]
    }
}
