//! Orthogonalisation of narrow blocks in the M-inner product, and changes of basis in place.

use faer::{Mat, MatMut, MatRef, Side};
use rayon::prelude::*;

use crate::dense;

/// Rows from which a column is worth a thread of its own: ten microseconds of work.
const PARALLEL_FROM: usize = 1 << 14;

/// Share of its length that each column must keep beside those before it for the Gram matrix to be used. It squares what is lost: W is
/// orthonormal to about ε/HEALTHY² = 2·10⁻¹², and a second time brings it to rounding.
const HEALTHY: f64 = 1e-2;
/// Rows divided at a time: eight columns of them stay in the fastest cache.
const TILE_ROWS: usize = 512;

/// QR of a narrow block in the M-inner product, MW carried along: block = W R. Done twice, W is orthonormal to rounding.
///
/// A column of length at most `least` is dependent: it becomes zero and its row of R too.
pub fn mass_qr(block: &mut Mat<f64>, mass_block: &mut Mat<f64>, least: f64, dependent: &mut [bool]) -> Mat<f64> {
    by_cholesky(block, mass_block, least).unwrap_or_else(|| by_columns(block, mass_block, least, dependent))
}

/// By the Cholesky factor of WᵀMW = RᵀR, which reads a block of eight columns twice where Gram-Schmidt reads it eight times; none where
/// a column depends on those before it, or nearly.
fn by_cholesky(block: &mut Mat<f64>, mass_block: &mut Mat<f64>, least: f64) -> Option<Mat<f64>> {
    let gram = dense::gram(block.as_ref(), mass_block.as_ref());
    let r = gram.llt(Side::Lower).ok()?.L().transpose().to_owned();
    let is_healthy = (0..r.ncols()).all(|j| r[(j, j)] > least.max(HEALTHY * gram[(j, j)].sqrt()));
    is_healthy.then(|| {
        for side in [block, mass_block] {
            side.as_mut().par_row_chunks_mut(TILE_ROWS).for_each(|tile| divide(tile, r.as_ref()));
        }
        r
    })
}

/// X ← X R⁻¹, column by column.
fn divide(mut x: MatMut<'_, f64>, r: MatRef<'_, f64>) {
    for j in 0..x.ncols() {
        let (done, rest) = x.as_mut().split_at_col_mut(j);
        let column = dense::column_mut(rest, 0);
        for i in 0..j {
            dense::add_scaled(column, -r[(i, j)], dense::column(done.as_ref(), i));
        }
        column.iter_mut().for_each(|value| *value /= r[(j, j)]);
    }
}

/// Modified Gram-Schmidt.
fn by_columns(block: &mut Mat<f64>, mass_block: &mut Mat<f64>, least: f64, dependent: &mut [bool]) -> Mat<f64> {
    let width = block.ncols();
    let for_a_thread = if block.nrows() < PARALLEL_FROM { width } else { 1 };
    let mut r = Mat::zeros(width, width);
    for j in 0..width {
        if dependent[j] {
            continue;
        }
        let square = dense::dot(dense::column(block.as_ref(), j), dense::column(mass_block.as_ref(), j));
        let length = square.max(0.0).sqrt();
        if length.is_nan() || length <= least {
            dependent[j] = true;
            dense::column_mut(block.as_mut(), j).fill(0.0);
            dense::column_mut(mass_block.as_mut(), j).fill(0.0);
            continue;
        }
        r[(j, j)] = length;
        for side in [&mut *block, &mut *mass_block] {
            dense::column_mut(side.as_mut(), j).iter_mut().for_each(|value| *value /= length);
        }
        let unit = dense::column(mass_block.as_ref(), j);
        let later = (j + 1..width).into_par_iter().with_min_len(for_a_thread);
        let shares: Vec<f64> = later.map(|l| dense::dot(unit, dense::column(block.as_ref(), l))).collect();
        for side in [&mut *block, &mut *mass_block] {
            let (unit, rest) = side.as_mut().split_at_col_mut(j + 1);
            let unit = dense::column(unit.as_ref(), j);
            let rest = rest.par_col_chunks_mut(1).with_min_len(for_a_thread).zip(&shares);
            rest.for_each(|(column, share)| dense::add_scaled(dense::column_mut(column, 0), -share, unit));
        }
        for (l, share) in (j + 1..width).zip(shares) {
            r[(j, l)] = share;
        }
    }
    r
}

/// The leading `size` columns of V become V S, row tile by row tile.
pub(super) fn combine_in_place(mut vectors: MatMut<'_, f64>, size: usize, s: MatRef<'_, f64>) {
    const ROWS_PER_TILE: usize = 2048;
    let width = s.ncols();
    vectors.as_mut().subcols_mut(0, size).par_row_chunks_mut(ROWS_PER_TILE).for_each(|mut tile| {
        let mut result = Mat::zeros(tile.nrows(), width);
        faer::linalg::matmul::matmul(result.as_mut(), faer::Accum::Replace, tile.as_ref(), s, 1.0, faer::Par::Seq);
        tile.as_mut().subcols_mut(0, width).copy_from(&result);
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::sparse::{SparseMatrix, product};

    const N: usize = 3000;

    fn mass() -> SparseMatrix {
        let values = (0..N).map(|i| 1.0 + (i % 7) as f64).collect();
        SparseMatrix::new((N, N), (0..=N).collect(), (0..N as u32).collect(), values)
    }

    /// Columns of which each keeps about this share of its length beside those before it, of lengths that differ by powers of ten.
    fn block(share: f64) -> Mat<f64> {
        let wave = |i: usize, j: usize| ((i * (j + 2)) as f64).sin();
        Mat::from_fn(N, 8, |i, j| 10f64.powi(j as i32 - 4) * (wave(i, 0) + share * wave(i, j)))
    }

    /// Orthonormal to rounding after two times, whichever way it went, and the block is W R.
    #[test]
    fn block_is_orthonormal_times_a_triangle() {
        let mass = mass();
        for share in [1.0, 0.1, 0.03, 1e-3, 1e-6] {
            let original = block(share);
            let (mut w, mut r) = (original.clone(), Mat::identity(8, 8));
            let mut is_by_cholesky = true;
            for _ in 0..2 {
                let mut momenta = product(&mass, w.as_ref());
                is_by_cholesky &= by_cholesky(&mut w.clone(), &mut momenta.clone(), 0.0).is_some();
                let step = mass_qr(&mut w, &mut momenta, 0.0, &mut [false; 8]);
                r = dense::product(step.as_ref(), r.as_ref());
            }
            assert_eq!(is_by_cholesky, share > HEALTHY, "share {share}");
            let gram = dense::gram(w.as_ref(), product(&mass, w.as_ref()).as_ref());
            let back = dense::product(w.as_ref(), r.as_ref());
            for j in 0..8 {
                for i in 0..8 {
                    // Sums of N products of unit vectors, rounded at random.
                    let error = (gram[(i, j)] - f64::from(u8::from(i == j))).abs();
                    assert!(error < 4.0 * (N as f64).sqrt() * f64::EPSILON, "share {share}: {i}, {j} {error:e}");
                    assert!(i <= j || r[(i, j)] == 0.0, "R is upper triangular");
                }
                let difference: Vec<f64> = (0..N).map(|i| back[(i, j)] - original[(i, j)]).collect();
                let size = dense::norm(dense::column(original.as_ref(), j));
                // Each of the two products and divisions rounds eight terms no larger than the column over its share.
                assert!(dense::norm(&difference) <= 32.0 * f64::EPSILON * size, "share {share}: column {j}");
            }
        }
    }

    #[test]
    fn dependent_column_becomes_zero_and_is_told() {
        let (mass, mut w) = (mass(), block(1.0));
        let twin: Vec<f64> = dense::column(w.as_ref(), 1).iter().map(|value| 3.0 * value).collect();
        dense::column_mut(w.as_mut(), 4).copy_from_slice(&twin);
        let least = 1e-8 * dense::norm(&twin);
        let (mut momenta, mut dependent) = (product(&mass, w.as_ref()), [false; 8]);
        let r = mass_qr(&mut w, &mut momenta, least, &mut dependent);
        assert_eq!(dependent, [false, false, false, false, true, false, false, false]);
        assert!(dense::column(w.as_ref(), 4).iter().all(|value| *value == 0.0));
        assert!((0..8).all(|j| r[(4, j)] == 0.0));
    }
}
