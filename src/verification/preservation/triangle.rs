//! The triangle of a tall matrix that is never whole in memory.

use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::qr::no_pivoting::factor::{qr_in_place, qr_in_place_scratch, recommended_block_size};
use faer::{Mat, Par};
use rayon::prelude::*;

/// Rows of a panel: at least so many, and so many for each column, so that putting the triangles together takes a fraction of the whole.
/// Fixed, so that the bits never depend on the number of threads.
const PANEL_ROWS: usize = 512;
const PANEL_ROWS_OF_A_COLUMN: usize = 3;

/// R of X = Q R, for a tall X with so many rows and columns of which no more is in memory than the panels of rows being worked on.
///
/// R has as many rows as columns, or as X where that has fewer, and each of its columns is as accurate as by one decomposition of X: relative
/// to the length of the column.
pub(super) fn triangle_of_panels(
    (n_rows, n_columns): (usize, usize),
    panel: impl Fn(Range<usize>) -> Mat<f64> + Sync,
) -> Mat<f64> {
    let rows = PANEL_ROWS.max(PANEL_ROWS_OF_A_COLUMN * n_columns);
    let of_panel = |at: usize| triangle_in_place(panel(at * rows..n_rows.min((at + 1) * rows)));
    let mut triangles: Vec<Mat<f64>> = (0..n_rows.div_ceil(rows)).into_par_iter().map(of_panel).collect();
    if triangles.len() == 1 {
        return triangles.remove(0);
    }
    let mut stacked = Mat::zeros(triangles.iter().map(Mat::nrows).sum(), n_columns);
    let mut first = 0;
    for triangle in triangles {
        stacked.as_mut().subrows_mut(first, triangle.nrows()).copy_from(&triangle);
        first += triangle.nrows();
    }
    triangle_in_place(stacked)
}

/// R of X = Q R, in the memory of X.
fn triangle_in_place(mut x: Mat<f64>) -> Mat<f64> {
    let (m, n) = (x.nrows(), x.ncols());
    let block = recommended_block_size::<f64>(m, n);
    let mut reflectors = Mat::zeros(block, m.min(n));
    let mut scratch = MemBuffer::new(qr_in_place_scratch::<f64>(m, n, block, Par::Seq, Default::default()));
    qr_in_place(x.as_mut(), reflectors.as_mut(), Par::Seq, MemStack::new(&mut scratch), Default::default());
    Mat::from_fn(m.min(n), n, |i, j| if i <= j { x[(i, j)] } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::gram;
    use crate::random::SplitMix64;

    /// RᵀR = XᵀX up to rounding whatever the number of panels, one that has fewer rows than columns among them, and columns of any lengths.
    #[test]
    fn a_triangle_of_panels_is_that_of_the_whole() {
        for (n_rows, n_columns) in [(7, 9), (500, 20), (1100, 20), (1025, 40), (0, 3)] {
            let mut x = Mat::zeros(n_rows, n_columns);
            SplitMix64::new(2).fill(x.as_mut());
            let sizes: Vec<f64> = (0..n_columns).map(|j| 10f64.powi(-(j as i32 % 9))).collect();
            let x = Mat::from_fn(n_rows, n_columns, |i, j| x[(i, j)] * sizes[j]);
            let rows = |rows: Range<usize>| x.as_ref().subrows(rows.start, rows.len()).to_owned();
            let r = triangle_of_panels((n_rows, n_columns), rows);
            assert_eq!((r.nrows(), r.ncols()), (n_rows.min(n_columns), n_columns));
            assert!((0..r.ncols()).all(|j| (j + 1..r.nrows()).all(|i| r[(i, j)] == 0.0)), "upper");
            let (found, whole) = (gram(r.as_ref(), r.as_ref()), gram(x.as_ref(), x.as_ref()));
            // Each column of R is off by a few n ε of its own length; so are the products.
            let limit = 4.0 * n_rows as f64 * f64::EPSILON;
            for (i, j) in (0..n_columns).flat_map(|j| (0..n_columns).map(move |i| (i, j))) {
                let error = (found[(i, j)] - whole[(i, j)]).abs();
                let lengths = (whole[(i, i)] * whole[(j, j)]).sqrt();
                assert!(error <= limit * lengths, "{n_rows} rows, {i} {j}: {:.1e}", error / lengths);
            }
        }
    }
}
