//! Orthogonalisation of narrow blocks in the M-inner product, and changes of basis in place.

use faer::{Mat, MatMut, MatRef};
use rayon::prelude::*;

use crate::dense;

/// Rows from which a column is worth a thread of its own: ten microseconds of work.
const PARALLEL_FROM: usize = 1 << 14;

/// Modified Gram-Schmidt of a narrow block in the M-inner product, MW carried along: block = W R.
///
/// A column of length at most `least` is dependent: it becomes zero and its row of R too.
pub fn gram_schmidt(block: &mut Mat<f64>, mass_block: &mut Mat<f64>, least: f64, dependent: &mut [bool]) -> Mat<f64> {
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
