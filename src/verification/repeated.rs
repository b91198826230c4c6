//! Modes of one frequency, judged as the space that they span.
//!
//! Modes whose Rayleigh quotients rounding cannot tell apart have the mean of them as λ, and one basis of their space is taken. A row of a
//! soft motion sees the distance from that mean all the same, as nothing cancels in it that cancels in the quotient.
//!
//! ```text
//! R = K X − λ M X                              of the modes X of one λ
//! R − M X E    E = arg min ‖D (R − M X E)‖_F   the residual of their space, |E_ij| ≤ bar_j λ
//! ```
//! The bar is what M-09 judges. What is farther from the mean than it says stays in the residual.

use std::ops::Range;

use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, MatRef};

use super::residual::{Residuals, Rows};
use crate::dense;
use crate::eigen::Modes;

/// Runs of modes that have one λ.
pub(super) fn runs(lambda: &[f64]) -> Vec<Range<usize>> {
    let mut end = 0;
    let range = |alike: &[f64]| {
        end += alike.len();
        end - alike.len()..end
    };
    lambda.chunk_by(|a, b| a == b).map(range).filter(|run| run.len() > 1).collect()
}

/// What the space of the modes of a run leaves of the pencil, by its columns.
pub(super) fn residuals(rows: &Rows<'_>, modes: &Modes, run: Range<usize>, shapes: MatRef<'_, f64>) -> Residuals {
    let lambda = &modes.lambda[run.clone()];
    let mut found = rows.residuals(shapes, lambda);
    let Some(momenta) = &found.momenta else { return found };
    let scaled = |a: MatRef<'_, f64>| Mat::from_fn(a.nrows(), a.ncols(), |i, j| rows.norms.scale[i] * a[(i, j)]);
    let mut shares = scaled(momenta.as_ref()).qr().solve_lstsq(scaled(found.residual.as_ref()));
    for (column, j) in shares.as_mut().col_iter_mut().zip(run) {
        let bar = modes.errors[j].data_bar * modes.lambda[j].abs();
        column.iter_mut().for_each(|share| *share = share.clamp(-bar, bar));
    }
    let of_shares = dense::product(momenta.as_ref(), shares.as_ref());
    found.residual = &found.residual - of_shares;
    found
}
