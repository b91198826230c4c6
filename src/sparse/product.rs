//! Sparse matrix times a block of columns.
//!
//! The matrix is the traffic: it is read once for eight columns. The block is packed row by row first, because then
//! the eight numbers an entry needs share one cache line.
//!
//! Shapes: matrix n × n, x and y n × k.

use faer::prelude::ReborrowMut;
use faer::{Mat, MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::SparseMatrix;

/// Rows of a tile, the unit of parallel work. Fixed: what a thread computes never depends on how many there are.
const TILE_ROWS: usize = 512;

/// y = A x for an n × k block x. The sum of a row runs over its entries in order, so that every element of y has the
/// same bits whatever the number of threads and whatever the other columns.
///
/// # Panics
/// Where the shapes differ.
pub fn multiply(matrix: &SparseMatrix, x: MatRef<'_, f64>, y: MatMut<'_, f64>) {
    multiply_entries(matrix, x, y, |entry| entry);
}

/// |A| |X| as a new matrix, n × k: how large the terms of A X are.
pub fn absolute_product(matrix: &SparseMatrix, x: MatRef<'_, f64>) -> Mat<f64> {
    let mut y = Mat::zeros(matrix.rows(), x.ncols());
    multiply_entries(matrix, x, y.as_mut(), f64::abs);
    y
}

/// The product of what `entry` makes of the entries of both.
fn multiply_entries(
    matrix: &SparseMatrix,
    x: MatRef<'_, f64>,
    mut y: MatMut<'_, f64>,
    entry: impl Fn(f64) -> f64 + Sync + Copy,
) {
    let n = matrix.rows();
    assert!(x.nrows() == matrix.cols(), "matrix of {} columns times block of {} rows", matrix.cols(), x.nrows());
    assert!(y.nrows() == n && y.ncols() == x.ncols(), "product {n} x {}, block {:?}", x.ncols(), y.shape());
    let mut packed: Vec<Group<8>> = Vec::new();
    let mut col = 0;
    while col < x.ncols() {
        let left = x.ncols() - col;
        let width = left.min(8);
        let (x, y) = (x.subcols(col, width), y.rb_mut().subcols_mut(col, width));
        match width {
            1 => multiply_group::<1>(matrix, x, y, &mut Vec::new(), entry),
            2 => multiply_group::<2>(matrix, x, y, &mut Vec::new(), entry),
            3 | 4 => multiply_group::<4>(matrix, x, y, &mut Vec::new(), entry),
            _ => multiply_group::<8>(matrix, x, y, &mut packed, entry),
        }
        col += width;
    }
}

/// A X as a new matrix, n × k.
pub fn product(matrix: &SparseMatrix, x: MatRef<'_, f64>) -> Mat<f64> {
    let mut y = Mat::zeros(matrix.rows(), x.ncols());
    multiply(matrix, x, y.as_mut());
    y
}

/// One row of a packed group of W columns.
type Group<const W: usize> = [f64; W];

fn multiply_group<const W: usize>(
    matrix: &SparseMatrix,
    x: MatRef<'_, f64>,
    y: MatMut<'_, f64>,
    packed: &mut Vec<Group<W>>,
    entry: impl Fn(f64) -> f64 + Sync + Copy,
) {
    pack(x, packed, entry);
    let packed = packed.as_slice();
    let (indptr, indices, data) = (matrix.indptr(), matrix.indices(), matrix.data());
    let pointers = indptr.raw_storage();
    y.par_row_chunks_mut(TILE_ROWS).enumerate().for_each(|(tile, mut y)| {
        let first = tile * TILE_ROWS;
        let mut sums = [[0.0; W]; TILE_ROWS];
        Arch::new().dispatch(RowSums {
            pointers: &pointers[first..],
            indices,
            data,
            packed,
            entry,
            sums: &mut sums[..y.nrows()],
        });
        for (col, y) in y.as_mut().col_iter_mut().enumerate() {
            for (y, sum) in y.iter_mut().zip(&sums) {
                *y = sum[col];
            }
        }
    });
}

/// The sums of a tile of rows.
struct RowSums<'a, const W: usize, E> {
    /// Of the first row on.
    pointers: &'a [usize],
    indices: &'a [u32],
    data: &'a [f64],
    packed: &'a [Group<W>],
    entry: E,
    sums: &'a mut [Group<W>],
}

impl<const W: usize, E: Fn(f64) -> f64> WithSimd for RowSums<'_, W, E> {
    type Output = ();

    /// In the widest vectors that the processor has; a product and a sum are rounded one by one all the same.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (bounds, sum) in self.pointers.windows(2).zip(self.sums) {
            let row = bounds[0]..bounds[1];
            // Summed in a local, which stays in registers.
            let mut row_sum = [0.0; W];
            for (&col, &value) in self.indices[row.clone()].iter().zip(&self.data[row]) {
                let value = (self.entry)(value);
                for (sum, x) in row_sum.iter_mut().zip(&self.packed[col as usize]) {
                    *sum += value * x;
                }
            }
            *sum = row_sum;
        }
    }
}

/// Copies what `entry` makes of a block of at most W columns into rows of W, zeros on the right.
fn pack<const W: usize>(x: MatRef<'_, f64>, packed: &mut Vec<Group<W>>, entry: impl Fn(f64) -> f64 + Sync + Copy) {
    packed.clear();
    packed.resize(x.nrows(), [0.0; W]);
    packed.par_chunks_mut(TILE_ROWS).enumerate().for_each(|(tile, rows)| {
        let x = x.subrows(tile * TILE_ROWS, rows.len());
        for (col, x) in x.col_iter().enumerate() {
            for (row, x) in rows.iter_mut().zip(x.iter()) {
                row[col] = entry(*x);
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;
    use crate::sparse::{Declared, Triplets};

    /// A banded matrix of integers, more rows than a tile, with a row left empty.
    fn banded(n: u32) -> SparseMatrix {
        let mut triplets = Triplets::default();
        for row in 0..n {
            for step in [0, 1, 7, 100] {
                if row >= step && row != 5 && row - step != 5 {
                    triplets.push(row, row - step, f64::from((row * 13 + step) % 17) - 8.0);
                }
            }
        }
        triplets.assemble(n as usize, Declared::Symmetric, "banded".as_ref()).expect("a matrix").0
    }

    fn block(n: usize, k: usize) -> Mat<f64> {
        Mat::from_fn(n, k, |row, col| ((row * 31 + col * 7) % 23) as f64 - 11.0)
    }

    /// Integers make every order of summation exact, so that equality needs no tolerance.
    #[test]
    fn columns_are_products_of_rows_whatever_their_number() {
        let matrix = banded(2500);
        let n = matrix.rows();
        for k in [0, 1, 2, 3, 4, 5, 7, 8, 9, 16, 21, 64] {
            let x = block(n, k);
            let mut y = Mat::from_fn(n, k, |_, _| f64::NAN);
            multiply(&matrix, x.as_ref(), y.as_mut());
            for col in 0..k {
                for (row, entries) in matrix.outer_iterator().enumerate() {
                    let expected: f64 = entries.iter().map(|(at, value)| value * x[(at, col)]).sum();
                    assert!(y[(row, col)] == expected, "row {row} of column {col} of {k}");
                }
            }
        }
    }

    #[test]
    fn bits_do_not_depend_on_threads_or_neighbours() {
        let matrix = banded(3000).map(|value| value / 3.0);
        let x = Mat::from_fn(3000, 11, |row, col| 1.0 / (row + 2 * col + 1) as f64);
        let product = |threads: usize, x: MatRef<'_, f64>| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let mut y = Mat::zeros(x.nrows(), x.ncols());
            pool.install(|| multiply(&matrix, x, y.as_mut()));
            y
        };
        let reference = product(1, x.as_ref());
        for threads in [2, 3, 8] {
            assert!(product(threads, x.as_ref()) == reference, "{threads} threads");
        }
        for col in 0..11 {
            assert!(product(2, x.as_ref().subcols(col, 1)).col(0) == reference.col(col), "column {col} alone");
        }
    }

    #[test]
    #[should_panic(expected = "times block of")]
    fn shapes_must_fit() {
        multiply(&banded(20), block(19, 2).as_ref(), Mat::zeros(20, 2).as_mut());
    }
}
