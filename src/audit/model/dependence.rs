//! How far the named columns depend on each other.
//!
//! ```text
//! N D = Q R    n' × n_N    D scales to unit length in the mass, QᵀMQ = I, R upper triangular
//! ```
//! What a column keeps of its length once others are taken out of it is what its column of R keeps without theirs. Lengths come from
//! orthogonalised columns, not from their Gram matrix, which holds their squares and with them half the digits: of a basis that
//! spans the whole interior it would tell nothing.

use faer::{Mat, MatRef};

use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::mass_qr;
use crate::sparse::{SparseMatrix, panels, product};

/// Passes of orthogonalisation: one leaves ε over the share that a column keeps, a second ε; a third serves columns that are rounding.
const PASSES: usize = 3;
/// Share of its length below which a column of R adds nothing to those before it: far above rounding, far below what is kept.
const ADDS_NOTHING: f64 = 1e-11;

/// R.
pub(super) struct Dependence {
    triangle: Mat<f64>,
}

impl Dependence {
    /// Orthogonalises columns, n' × n_N.
    pub(super) fn of(mass: &SparseMatrix, columns: MatRef<'_, f64>) -> Self {
        let n = columns.ncols();
        let mut block = columns.to_owned();
        for panel in panels(n) {
            let momenta = product(mass, block.as_ref().get(.., panel.clone()));
            for (at, j) in panel.enumerate() {
                let column = dense::column_mut(block.as_mut(), j);
                let length = dense::dot(column, dense::column(momenta.as_ref(), at)).max(0.0).sqrt();
                let factor = if length > 0.0 { 1.0 / length } else { 0.0 };
                column.iter_mut().for_each(|value| *value *= factor);
            }
        }
        let mut triangle = Mat::identity(n, n);
        let mut dependent = vec![false; n];
        for _ in 0..PASSES {
            let mut momenta = product(mass, block.as_ref());
            let step = mass_qr(&mut block, &mut momenta, NOISE_FACTOR * f64::EPSILON, &mut dependent);
            triangle = dense::product(step.as_ref(), triangle.as_ref());
        }
        Self { triangle }
    }

    /// Orthonormal vectors of some columns, each of what it adds to those before it; zero where that is rounding. n_N × as many.
    pub(super) fn span(&self, columns: &[usize]) -> Mat<f64> {
        let mut span = Mat::zeros(self.triangle.nrows(), columns.len());
        for (slot, column) in columns.iter().enumerate() {
            let left = self.without(*column, span.as_ref().subcols(0, slot));
            let length = dense::norm(&left);
            if length > ADDS_NOTHING {
                dense::column_mut(span.as_mut(), slot)
                    .iter_mut()
                    .zip(left)
                    .for_each(|(to, value)| *to = value / length);
            }
        }
        span
    }

    /// The share of its length that a column keeps without such vectors.
    pub(super) fn remaining(&self, column: usize, span: MatRef<'_, f64>) -> f64 {
        dense::norm(&self.without(column, span))
    }

    /// A column of R without its parts along orthonormal vectors, taken out twice for orthogonality to rounding.
    fn without(&self, column: usize, span: MatRef<'_, f64>) -> Vec<f64> {
        let mut left = dense::column(self.triangle.as_ref(), column).to_vec();
        for _ in 0..2 {
            for along in 0..span.ncols() {
                let vector = dense::column(span, along);
                let share = dense::dot(vector, &left);
                dense::add_scaled(&mut left, -share, vector);
            }
        }
        left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The columns e_1, e_1 + δ e_2, e_1 + δ e_2 + δ e_3, … of which each keeps δ without those before it, and at the end a random
    /// one: a basis of all n dimensions.
    #[test]
    fn shares_below_the_root_of_rounding_are_told_and_a_whole_basis_leaves_nothing() {
        let (n, share) = (12, 1e-9);
        let mass = SparseMatrix::new((n, n), (0..=n).collect(), (0..n as u32).collect(), vec![4.0; n]);
        let columns = Mat::from_fn(n, n + 1, |i, j| match (i, j) {
            (_, j) if j == n => ((3 * i + 1) as f64).sin(),
            (0, _) => 1.0,
            (i, j) if i <= j => share,
            _ => 0.0,
        });
        let dependence = Dependence::of(&mass, columns.as_ref());
        let kept: Vec<usize> = (0..n).collect();
        let span = dependence.span(&kept);
        for j in 1..n {
            let remaining = dependence.remaining(j, span.as_ref().subcols(0, j));
            // n roundings of unit columns.
            assert!((remaining - share).abs() <= n as f64 * f64::EPSILON, "{j}: {remaining:e}");
        }
        // Rounding of unit columns over the share that fixes a direction.
        let nothing = dependence.remaining(n, span.as_ref());
        assert!(nothing <= n as f64 * f64::EPSILON / share, "{nothing:e}");
        assert!(dependence.remaining(n, span.as_ref().subcols(0, n - 1)) > 1e-2, "the last dimension is missing");
    }
}
