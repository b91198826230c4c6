//! Orthogonalisation of narrow blocks in the M-inner product, and changes of basis in place.

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatMut, MatRef, Par, Side};
use rayon::prelude::*;

use crate::dense;

/// Rows from which a column is worth a thread of its own: ten microseconds of work.
const PARALLEL_FROM: usize = 1 << 14;

/// ‖R⁻¹‖ of a block of unit columns up to which its Gram matrix is used. That squares what is lost: W is orthonormal to about
/// ε‖R⁻¹‖² = 2·10⁻¹², and a second time brings it to rounding.
const WELL_CONDITIONED: f64 = 1e2;

/// QR of a narrow block in the M-inner product, MX carried along: X = W R. Done twice, W is orthonormal to rounding.
///
/// A column is dependent when at most `least` of it is left without those before it: it becomes zero and its row of R too. One that is told to be
/// on entry is left as it is, and its row of R is zero.
pub fn mass_qr(block: &mut Mat<f64>, mass_block: &mut Mat<f64>, least: f64, dependent: &mut [bool]) -> Mat<f64> {
    let by_cholesky = if dependent.contains(&true) { None } else { by_cholesky(block, mass_block, least) };
    by_cholesky.unwrap_or_else(|| by_columns(block, mass_block, least, dependent))
}

/// By the Cholesky factor of XᵀMX = RᵀR, which reads a block of eight columns twice where Gram-Schmidt reads it eight times; none where
/// columns depend on each other, or nearly.
fn by_cholesky(block: &mut Mat<f64>, mass_block: &mut Mat<f64>, least: f64) -> Option<Mat<f64>> {
    let gram = dense::gram(block.as_ref(), mass_block.as_ref());
    let lower = gram.llt(Side::Lower).ok()?.L().to_owned();
    let width = lower.ncols();
    let mut inverse = Mat::from_fn(width, width, |i, j| if i == j { gram[(j, j)].sqrt() } else { 0.0 });
    solve_lower_triangular_in_place(lower.as_ref(), inverse.as_mut(), Par::Seq);
    let is_healthy = inverse.norm_l2() <= WELL_CONDITIONED && (0..width).all(|j| lower[(j, j)] > least);
    is_healthy.then(|| {
        dense::divide(block.as_mut(), lower.as_ref());
        dense::divide(mass_block.as_mut(), lower.as_ref());
        lower.transpose().to_owned()
    })
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

    /// Columns of which each keeps about this share of its length without the one before it, and less without all, of lengths that
    /// differ by powers of ten.
    fn chain(share: f64) -> Mat<f64> {
        let wave = |i: usize, j: usize| ((i * (2 * j + 3)) as f64).sin();
        let column = |i: usize, j: usize| if j == 0 { wave(i, 0) } else { wave(i, j - 1) + share * wave(i, j) };
        Mat::from_fn(N, 8, |i, j| 10f64.powi(j as i32 - 4) * column(i, j))
    }

    /// Largest difference of two blocks, relative to the columns of the second.
    fn difference(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> f64 {
        let of = |j: usize| {
            let gap: Vec<f64> = dense::column(a, j).iter().zip(dense::column(b, j)).map(|(a, b)| a - b).collect();
            dense::norm(&gap) / dense::norm(dense::column(b, j))
        };
        dense::worst((0..b.ncols()).map(of))
    }

    /// Orthonormal to rounding after two times, whichever way it went; the block is W R, and what was carried along M W.
    #[test]
    fn block_is_orthonormal_times_a_triangle() {
        let mass = mass();
        for (share, is_healthy) in [(1.0, true), (0.7, true), (0.3, false), (0.02, false), (1e-4, false)] {
            let original = chain(share);
            let (mut w, mut r) = (original.clone(), Mat::identity(8, 8));
            for pass in 0..2 {
                let mut momenta = product(&mass, w.as_ref());
                let is_by_cholesky = by_cholesky(&mut w.clone(), &mut momenta.clone(), 0.0).is_some();
                assert!(pass > 0 || is_by_cholesky == is_healthy, "share {share}");
                let step = mass_qr(&mut w, &mut momenta, 0.0, &mut [false; 8]);
                // Both sides are divided by R, and round like a solve with it: by ε times its condition, eight terms each.
                let allowed =
                    if is_healthy || pass > 0 { 8.0 * WELL_CONDITIONED * f64::EPSILON } else { f64::INFINITY };
                assert!(difference(momenta.as_ref(), product(&mass, w.as_ref()).as_ref()) <= allowed, "share {share}");
                r = dense::product(step.as_ref(), r.as_ref());
            }
            let gram = dense::gram(w.as_ref(), product(&mass, w.as_ref()).as_ref());
            for j in 0..8 {
                for i in 0..8 {
                    // Sums of N products of unit vectors, rounded at random.
                    let error = (gram[(i, j)] - f64::from(u8::from(i == j))).abs();
                    assert!(error < 4.0 * (N as f64).sqrt() * f64::EPSILON, "share {share}: {i}, {j} {error:e}");
                    assert!(i <= j || r[(i, j)] == 0.0, "R is upper triangular");
                }
            }
            // Two divisions and the product W R round eight terms each, no larger than a column in the mass, whose entries are 1 to 7.
            let back = difference(dense::product(w.as_ref(), r.as_ref()).as_ref(), original.as_ref());
            assert!(back <= 24.0 * 7f64.sqrt() * f64::EPSILON, "share {share}: {back:e}");
        }
    }

    /// A column that is told to be, one that is a multiple of another, one of no length and one that is not a number.
    #[test]
    fn dependent_columns_become_zero_and_are_told() {
        let told = |change: &dyn Fn(&mut Mat<f64>, &mut [bool; 8]), least: f64| {
            let (mut w, mut dependent) = (chain(1.0), [false; 8]);
            change(&mut w, &mut dependent);
            let mut momenta = product(&mass(), w.as_ref());
            let r = mass_qr(&mut w, &mut momenta, least, &mut dependent);
            for j in (0..8).filter(|j| dependent[*j]) {
                assert!((0..8).all(|k| r[(j, k)] == 0.0), "row {j} of R");
            }
            dependent.map(u8::from)
        };
        let twin = |w: &mut Mat<f64>, _: &mut [bool; 8]| {
            let twin: Vec<f64> = dense::column(w.as_ref(), 1).iter().map(|value| 3.0 * value).collect();
            dense::column_mut(w.as_mut(), 4).copy_from_slice(&twin);
        };
        let of_no_length = |w: &mut Mat<f64>, _: &mut [bool; 8]| dense::column_mut(w.as_mut(), 2).fill(0.0);
        let no_number = |w: &mut Mat<f64>, _: &mut [bool; 8]| w[(7, 7)] = f64::NAN;
        assert_eq!(told(&|_, _| (), 0.0), [0; 8]);
        assert_eq!(told(&|_, dependent| dependent[3] = true, 0.0), [0, 0, 0, 1, 0, 0, 0, 0]);
        assert_eq!(told(&twin, 1e-9), [0, 0, 0, 0, 1, 0, 0, 0]);
        assert_eq!(told(&of_no_length, 0.0), [0, 0, 1, 0, 0, 0, 0, 0]);
        assert_eq!(told(&no_number, 0.0), [0, 0, 0, 0, 0, 0, 0, 1]);
        // Short, and independent of the others all the same.
        let first = dense::dots(chain(1.0).as_ref(), product(&mass(), chain(1.0).as_ref()).as_ref())[0].sqrt();
        assert_eq!(told(&|_, _| (), 1.001 * first), [1, 0, 0, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn no_columns_are_orthonormal() {
        let (mut w, mut momenta) = (Mat::zeros(N, 0), Mat::zeros(N, 0));
        assert_eq!(mass_qr(&mut w, &mut momenta, 0.0, &mut []).shape(), (0, 0));
    }
}
