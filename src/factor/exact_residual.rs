//! Residuals of linear systems, summed in twice the working precision.
//!
//! ```text
//! A = K − σM     with its border
//! X              n + n_B × k
//! B              n × k
//! R = B − A X    n × k, of the first n rows of A
//! ```
//! What is left of a solution whose residual is rounding of its terms is nothing but rounding where it is summed in working precision.
//! Summed in twice that, it is what a further solve takes away (Higham 2002, section 12.1).

use faer::{Mat, MatRef};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::sparse::Pencil;
use crate::twofold::{Twofold, exact_product};

/// B − (K − σM) X.
pub(super) fn exact_residual(
    (pencil, sigma): (Pencil<'_>, f64),
    x: MatRef<'_, f64>,
    load: MatRef<'_, f64>,
) -> Mat<f64> {
    let of_row = |row: usize| Arch::new().dispatch(OfRow { pencil, sigma, row, x, load });
    let rows: Vec<Vec<f64>> = (0..load.nrows()).into_par_iter().map(of_row).collect();
    Mat::from_fn(load.nrows(), load.ncols(), |i, j| rows[i][j])
}

/// A row of that residual.
struct OfRow<'a> {
    pencil: Pencil<'a>,
    sigma: f64,
    row: usize,
    x: MatRef<'a, f64>,
    load: MatRef<'a, f64>,
}

impl WithSimd for OfRow<'_> {
    type Output = Vec<f64>;

    /// For the processor that is there, which multiplies and adds in one instruction: exact products take that.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<f64> {
        let Self { pencil, sigma, row, x, load } = self;
        let mut residual = Vec::with_capacity(load.ncols());
        for j in 0..load.ncols() {
            let mut sum = Twofold::from(load[(row, j)]);
            for (col, value) in pencil.stiffness.entries(row) {
                sum = sum - exact_product(value, x[(col, j)]);
            }
            if sigma != 0.0 {
                for (col, value) in pencil.mass.entries(row) {
                    sum = sum + exact_product(value, x[(col, j)]) * sigma;
                }
            }
            residual.push(sum.value());
        }
        residual
    }
}
