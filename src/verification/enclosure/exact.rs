//! Products of matrices and vectors to twice the working precision.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::sparse::Leading;
use crate::twofold::{Twofold, exact_product};

/// A x and |A||x|.
pub(super) struct Product {
    pub(super) image: Vec<Twofold>,
    /// What the error of each row is relative to.
    pub(super) terms: Vec<f64>,
}

pub(super) fn product(matrix: Leading<'_>, x: &[f64]) -> Product {
    let row = |row: usize| Arch::new().dispatch(OfRow { matrix, row, x });
    let (image, terms) = (0..matrix.rows()).into_par_iter().map(row).unzip();
    Product { image, terms }
}

/// A row of that product.
struct OfRow<'a> {
    matrix: Leading<'a>,
    row: usize,
    x: &'a [f64],
}

impl WithSimd for OfRow<'_> {
    type Output = (Twofold, f64);

    /// For the processor that is there, which multiplies and adds in one instruction: exact products take that.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> (Twofold, f64) {
        let (mut sum, mut terms) = (Twofold::default(), 0.0);
        for (col, value) in self.matrix.entries(self.row) {
            sum = sum + exact_product(value, self.x[col]);
            terms += (value * self.x[col]).abs();
        }
        (sum, terms)
    }
}

/// xᵀ y.
pub(super) fn dot(x: &[f64], y: &[Twofold]) -> Twofold {
    x.iter().zip(y).map(|(x, y)| *y * *x).sum()
}
