//! Projected forms on combinations of their columns.

use faer::{Mat, MatRef};

use super::alignment::Combination;
use super::bilinear::Bilinear;
use super::projection::{Form, Rows};
use crate::dense::{self, summed_sizes};

impl Form {
    /// BᵀAB: the form on combinations of its columns.
    pub(super) fn combined(&self, combination: &Combination) -> Self {
        let b = combination.columns.as_ref();
        let mut matrix = dense::product(b.transpose(), dense::product(self.matrix.as_ref(), b).as_ref());
        dense::symmetrise(&mut matrix);
        let norms: Vec<f64> = (0..self.matrix.nrows()).map(|j| self.matrix[(j, j)].max(0.0).sqrt()).collect();
        Self { matrix, errors: with_rounding(&self.errors, &norms, combination), terms: summed_sizes(&self.terms, b) }
    }
}

impl Rows {
    /// The rows of combinations of the columns.
    pub(super) fn combined(&self, combination: &Combination) -> Self {
        let b = combination.columns.as_ref();
        let errors = with_rounding(&self.errors, &self.sizes, combination);
        Self { rows: dense::product(self.rows.as_ref(), b), errors, sizes: summed_sizes(&self.sizes, b) }
    }
}

impl Bilinear {
    /// BᵀWᵀAWB: the form on combinations of the columns.
    pub(super) fn combined(&self, combination: &Combination) -> Self {
        let b = combination.columns.as_ref();
        let both = |a: &Mat<f64>, left: MatRef<'_, f64>, right: MatRef<'_, f64>| {
            dense::product(left.transpose(), dense::product(a.as_ref(), right).as_ref())
        };
        let size = dense::absolute(b);
        let (size, amplified) = (size.as_ref(), combination.amplified.as_ref());
        let of_rounding = both(&self.terms, amplified, size) + both(&self.terms, size, amplified);
        Self {
            matrix: both(&self.matrix, b, b),
            errors: both(&self.errors, size, size) + of_rounding * faer::Scale(f64::EPSILON),
            terms: both(&self.terms, size, size),
        }
    }
}

/// Errors of combinations: those of the columns, and of the combination itself on columns of these sizes.
fn with_rounding(errors: &[f64], sizes: &[f64], combination: &Combination) -> Vec<f64> {
    let (errors, rounding) =
        (summed_sizes(errors, combination.columns.as_ref()), summed_sizes(sizes, combination.amplified.as_ref()));
    errors.iter().zip(rounding).map(|(error, rounding)| error + f64::EPSILON * rounding).collect()
}
