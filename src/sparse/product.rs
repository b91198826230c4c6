//! Sparse matrix times a block of columns.
//!
//! The matrix is the traffic: it is read once for eight columns. The block is packed row by row first, because then
//! the eight numbers an entry needs share one cache line.
//!
//! Shapes: matrix n × n, x and y n × k.

use faer::prelude::ReborrowMut;
use faer::{MatMut, MatRef};
use rayon::prelude::*;

use super::SparseMatrix;

/// Rows of a tile, the unit of parallel work. Fixed: what a thread computes never depends on how many there are.
const TILE_ROWS: usize = 1024;

/// y = A x for an n × k block x. The sum of a row runs over its entries in order, so that every element of y has the
/// same bits whatever the number of threads and whatever the other columns.
///
/// # Panics
/// Where the shapes differ.
pub fn multiply(matrix: &SparseMatrix, x: MatRef<'_, f64>, mut y: MatMut<'_, f64>) {
    let n = matrix.rows();
    assert!(
        x.nrows() == matrix.cols(),
        "matrix of {} columns times block of {} rows",
        matrix.cols(),
        x.nrows()
    );
    assert!(
        y.nrows() == n && y.ncols() == x.ncols(),
        "product {n} x {}, block {:?}",
        x.ncols(),
        y.shape()
    );
    let mut packed: Vec<Group<8>> = Vec::new();
    let mut col = 0;
    while col < x.ncols() {
        let left = x.ncols() - col;
        let width = left.min(8);
        let (x, y) = (x.subcols(col, width), y.rb_mut().subcols_mut(col, width));
        match width {
            1 => multiply_group::<1>(matrix, x, y, &mut Vec::new()),
            2 => multiply_group::<2>(matrix, x, y, &mut Vec::new()),
            3 | 4 => multiply_group::<4>(matrix, x, y, &mut Vec::new()),
            _ => multiply_group::<8>(matrix, x, y, &mut packed),
        }
        col += width;
    }
}

/// One row of a packed group of W columns.
type Group<const W: usize> = [f64; W];

fn multiply_group<const W: usize>(
    matrix: &SparseMatrix,
    x: MatRef<'_, f64>,
    y: MatMut<'_, f64>,
    packed: &mut Vec<Group<W>>,
) {
    pack(x, packed);
    let packed = packed.as_slice();
    let (indptr, indices, data) = (matrix.indptr(), matrix.indices(), matrix.data());
    let pointers = indptr.raw_storage();
    y.par_row_chunks_mut(TILE_ROWS).enumerate().for_each(|(tile, mut y)| {
        let first = tile * TILE_ROWS;
        let n_cols = y.ncols();
        for local in 0..y.nrows() {
            let (start, end) = (pointers[first + local], pointers[first + local + 1]);
            let mut sum = [0.0; W];
            for (&col, &value) in indices[start..end].iter().zip(&data[start..end]) {
                let row_of_x = &packed[col as usize];
                for (sum, x) in sum.iter_mut().zip(row_of_x) {
                    *sum += value * x;
                }
            }
            for (col, &sum) in sum[..n_cols].iter().enumerate() {
                y[(local, col)] = sum;
            }
        }
    });
}

/// Copies a block of at most W columns into rows of W, zeros on the right.
fn pack<const W: usize>(x: MatRef<'_, f64>, packed: &mut Vec<Group<W>>) {
    packed.resize(x.nrows(), [0.0; W]);
    let n_cols = x.ncols();
    packed.par_chunks_mut(TILE_ROWS).enumerate().for_each(|(tile, rows)| {
        let first = tile * TILE_ROWS;
        for (local, row) in rows.iter_mut().enumerate() {
            for (col, value) in row.iter_mut().enumerate() {
                *value = if col < n_cols { x[(first + local, col)] } else { 0.0 };
            }
        }
    });
}
