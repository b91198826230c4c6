//! Products of matrices and vectors to twice the working precision.

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
    let row = |row: usize| {
        let (mut sum, mut terms) = (Twofold::default(), 0.0);
        for (col, value) in matrix.entries(row) {
            sum = sum + exact_product(value, x[col]);
            terms += (value * x[col]).abs();
        }
        (sum, terms)
    };
    let (image, terms) = (0..matrix.rows()).into_par_iter().map(row).unzip();
    Product { image, terms }
}

/// xᵀ y.
pub(super) fn dot(x: &[f64], y: &[Twofold]) -> Twofold {
    x.iter().zip(y).map(|(x, y)| *y * *x).sum()
}
