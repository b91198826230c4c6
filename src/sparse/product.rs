//! Sparse matrix times a block of columns.
//!
//! The matrix is the traffic: it is read once for eight columns. The block is packed row by row first, because then
//! the eight numbers an entry needs share one cache line. For a leading block it goes on with zeros as far as the rows that
//! store the block do: to add them costs less than to find where each row leaves the block, and changes no bit of a sum.
//!
//! Shapes: matrix n × n, whole or leading block, x and y n × k.

use std::ops::Range;

use faer::prelude::ReborrowMut;
use faer::{Mat, MatMut, MatRef};
use pulp::{Arch, Scalar, Simd, WithSimd};
use rayon::prelude::*;

use super::Leading;

/// Rows of a tile, the unit of parallel work. Fixed: what a thread computes never depends on how many there are.
const TILE_ROWS: usize = 512;
/// Columns that one reading of the matrix serves.
const WIDEST: usize = 8;

/// y = A x for an n × k block x. The sum of a row runs over its entries in order, so that every element of y has the
/// same bits whatever the number of threads and whatever the other columns.
///
/// # Panics
/// Where the shapes differ.
pub fn multiply<'a>(matrix: impl Into<Leading<'a>>, x: MatRef<'_, f64>, y: MatMut<'_, f64>) {
    sums(matrix.into(), x, [y], Products);
}

/// A X as a new matrix, n × k.
pub fn product<'a>(matrix: impl Into<Leading<'a>>, x: MatRef<'_, f64>) -> Mat<f64> {
    let matrix = matrix.into();
    let mut y = Mat::zeros(matrix.rows(), x.ncols());
    multiply(matrix, x, y.as_mut());
    y
}

/// |A| |X| as a new matrix, n × k: how large the terms of A X are.
pub fn absolute_product<'a>(matrix: impl Into<Leading<'a>>, x: MatRef<'_, f64>) -> Mat<f64> {
    let matrix = matrix.into();
    let mut y = Mat::zeros(matrix.rows(), x.ncols());
    sums(matrix, x, [y.as_mut()], Sizes);
    y
}

/// A X and |A| |X|, n × k each, for one reading of A.
pub fn product_and_terms<'a>(matrix: impl Into<Leading<'a>>, x: MatRef<'_, f64>) -> (Mat<f64>, Mat<f64>) {
    let matrix = matrix.into();
    let zeros = || Mat::zeros(matrix.rows(), x.ncols());
    let (mut y, mut terms) = (zeros(), zeros());
    sums(matrix, x, [y.as_mut(), terms.as_mut()], ProductsAndSizes);
    (y, terms)
}

/// Some columns as ranges of those to be multiplied together: an eighth of all, so that what is held of a product is small compared with the
/// columns themselves, rounded up to whole groups of eight and 32 at most, as many as save time.
pub fn panels(n_columns: usize) -> impl Iterator<Item = Range<usize>> {
    const PANELS: usize = 8;
    let width = WIDEST * n_columns.div_ceil(PANELS * WIDEST).clamp(1, 4);
    (0..n_columns).step_by(width).map(move |start| start..n_columns.min(start + width))
}

/// What is summed of the products of the entries of A with those of x: N terms of each.
trait Terms<const N: usize>: Copy + Sync {
    fn of<S: Simd>(self, simd: S, products: S::f64s) -> [S::f64s; N];
}

#[derive(Clone, Copy)]
struct Products;

impl Terms<1> for Products {
    #[inline(always)]
    fn of<S: Simd>(self, _: S, products: S::f64s) -> [S::f64s; 1] {
        [products]
    }
}

#[derive(Clone, Copy)]
struct Sizes;

impl Terms<1> for Sizes {
    #[inline(always)]
    fn of<S: Simd>(self, simd: S, products: S::f64s) -> [S::f64s; 1] {
        [absolute(simd, products)]
    }
}

#[derive(Clone, Copy)]
struct ProductsAndSizes;

impl Terms<2> for ProductsAndSizes {
    #[inline(always)]
    fn of<S: Simd>(self, simd: S, products: S::f64s) -> [S::f64s; 2] {
        [products, absolute(simd, products)]
    }
}

/// N sums over each row: those of what `of` makes of the products of the entries of A with those of x.
fn sums<const N: usize>(matrix: Leading<'_>, x: MatRef<'_, f64>, mut y: [MatMut<'_, f64>; N], of: impl Terms<N>) {
    let n = matrix.rows();
    assert!(x.nrows() == n, "matrix of {n} columns times block of {} rows", x.nrows());
    for y in &y {
        assert!(y.nrows() == n && y.ncols() == x.ncols(), "product {n} x {}, block {:?}", x.ncols(), y.shape());
    }
    let mut packed: Vec<Group<WIDEST>> = Vec::new();
    for col in (0..x.ncols()).step_by(WIDEST) {
        let width = (x.ncols() - col).min(WIDEST);
        let (x, y) = (x.subcols(col, width), y.each_mut().map(|y| y.rb_mut().subcols_mut(col, width)));
        match width {
            1 => group_sums::<1, N>(matrix, x, y, &mut Vec::new(), of),
            2 => group_sums::<2, N>(matrix, x, y, &mut Vec::new(), of),
            3 | 4 => group_sums::<4, N>(matrix, x, y, &mut Vec::new(), of),
            _ => group_sums::<WIDEST, N>(matrix, x, y, &mut packed, of),
        }
    }
}

/// One row of a packed group of W columns.
type Group<const W: usize> = [f64; W];

fn group_sums<const W: usize, const N: usize>(
    matrix: Leading<'_>,
    x: MatRef<'_, f64>,
    y: [MatMut<'_, f64>; N],
    packed: &mut Vec<Group<W>>,
    of: impl Terms<N>,
) {
    let stored = matrix.whole;
    pack(x, stored.rows(), packed);
    let packed = packed.as_slice();
    let (indptr, indices, data) = (stored.indptr(), stored.indices(), stored.data());
    let pointers = indptr.raw_storage();
    let n_rows = matrix.rows();
    let mut tiles = y.map(|y| y.par_row_chunks_mut(TILE_ROWS).collect::<Vec<_>>().into_iter());
    let tiles: Vec<[MatMut<'_, f64>; N]> = (0..n_rows.div_ceil(TILE_ROWS))
        .map(|_| tiles.each_mut().map(|tiles| tiles.next().expect("as many tiles of each sum")))
        .collect();
    tiles.into_par_iter().enumerate().for_each(|(tile, y)| {
        let first = tile * TILE_ROWS;
        let mut sums = [[[0.0; W]; N]; TILE_ROWS];
        let n_rows = TILE_ROWS.min(n_rows - first);
        Arch::new().dispatch(RowSums {
            pointers: &pointers[first..],
            indices,
            data,
            packed,
            of,
            sums: &mut sums[..n_rows],
        });
        for (kind, mut y) in y.into_iter().enumerate() {
            for (col, y) in y.as_mut().col_iter_mut().enumerate() {
                for (y, sums) in y.iter_mut().zip(&sums) {
                    *y = sums[kind][col];
                }
            }
        }
    });
}

/// Sizes by one mask. What the crate offers makes the mask anew for each vector by a function that a build with little optimisation calls.
#[inline(always)]
fn absolute<S: Simd>(simd: S, x: S::f64s) -> S::f64s {
    simd.and_f64s(x, simd.splat_f64s(f64::from_bits(!(1 << 63))))
}

/// The sums of a tile of rows.
struct RowSums<'a, const W: usize, const N: usize, F> {
    /// Of the first row on.
    pointers: &'a [usize],
    indices: &'a [u32],
    data: &'a [f64],
    packed: &'a [Group<W>],
    of: F,
    sums: &'a mut [[Group<W>; N]],
}

impl<const W: usize, const N: usize, F: Terms<N>> WithSimd for RowSums<'_, W, N, F> {
    type Output = ();

    /// In the widest vectors that the processor has and that a group fills; a product and a sum are rounded one by one all the same.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match const { W / S::F64_LANES } {
            1 => self.in_vectors::<S, 1>(simd),
            2 => self.in_vectors::<S, 2>(simd),
            _ => self.in_vectors::<Scalar, W>(Scalar),
        }
    }
}

impl<const W: usize, const N: usize, F: Terms<N>> RowSums<'_, W, N, F> {
    /// With V vectors for a group. Loops count, because a build with little optimisation calls what zips iterators.
    #[inline(always)]
    fn in_vectors<S: Simd, const V: usize>(self, simd: S) {
        let packed = S::as_simd_f64s(self.packed.as_flattened()).0;
        for (bounds, sums) in self.pointers.windows(2).zip(self.sums) {
            // Summed in a local, which stays in registers.
            let mut row_sums = [[simd.splat_f64s(0.0); N]; V];
            let (indices, data) = (&self.indices[bounds[0]..bounds[1]], &self.data[bounds[0]..bounds[1]]);
            for at in 0..indices.len() {
                let value = simd.splat_f64s(data[at]);
                let first = indices[at] as usize * V;
                let x = &packed[first..first + V];
                for v in 0..V {
                    let terms = self.of.of(simd, simd.mul_f64s(value, x[v]));
                    for n in 0..N {
                        row_sums[v][n] = simd.add_f64s(row_sums[v][n], terms[n]);
                    }
                }
            }
            for (kind, sums) in sums.iter_mut().enumerate() {
                for (to, sums) in S::as_mut_simd_f64s(sums).0.iter_mut().zip(&row_sums) {
                    *to = sums[kind];
                }
            }
        }
    }
}

/// Copies a block of at most W columns into `n_rows` rows of W, zeros on the right and below.
fn pack<const W: usize>(x: MatRef<'_, f64>, n_rows: usize, packed: &mut Vec<Group<W>>) {
    packed.clear();
    packed.resize(n_rows, [0.0; W]);
    packed[..x.nrows()].par_chunks_mut(TILE_ROWS).enumerate().for_each(|(tile, rows)| {
        let x = x.subrows(tile * TILE_ROWS, rows.len());
        for (col, x) in x.col_iter().enumerate() {
            for (row, x) in rows.iter_mut().zip(x.iter()) {
                row[col] = *x;
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;
    use crate::sparse::{Declared, SparseMatrix, Triplets};

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

    /// Sums of integers are exact.
    #[test]
    fn terms_are_the_sums_of_sizes() {
        let matrix = banded(1300);
        let sizes = matrix.map(|value| value.abs());
        for k in [1, 3, 11] {
            let x = block(1300, k);
            let absolute = Mat::from_fn(1300, k, |i, j| x[(i, j)].abs());
            let expected = product(&sizes, absolute.as_ref());
            assert!(absolute_product(&matrix, x.as_ref()) == expected, "{k} columns");
            assert!(product_and_terms(&matrix, x.as_ref()) == (product(&matrix, x.as_ref()), expected), "{k} columns");
        }
    }

    #[test]
    fn panels_are_all_columns_in_order() {
        for (n_columns, width) in [(0, 0), (1, 1), (8, 8), (62, 8), (65, 16), (800, 32)] {
            let panels: Vec<Range<usize>> = panels(n_columns).collect();
            assert!(panels.iter().cloned().flatten().eq(0..n_columns), "{n_columns} columns");
            assert_eq!(panels.first().map_or(0, Range::len), width, "{n_columns} columns");
        }
    }

    #[test]
    #[should_panic(expected = "times block of")]
    fn shapes_must_fit() {
        multiply(&banded(20), block(19, 2).as_ref(), Mat::zeros(20, 2).as_mut());
    }
}
