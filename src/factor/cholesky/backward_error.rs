//! How far L Lᵀ can be from the matrix that was factored.

use super::{Cholesky, Kept};
use crate::factor::rounding::{gamma, largest_row_sum};

/// Roundings of an entry in addition to those of its sum: the root or the division of the pivot, and the product with its
/// reciprocal.
const PIVOT: usize = 3;

impl Cholesky<'_> {
    /// An upper bound of ‖S (A − LLᵀ) S‖₂ with powers of two S, where A is the matrix as it was handed to the factorisation.
    ///
    /// |A − LLᵀ| ≤ γ_{m+3} |L||Lᵀ| with m the longest row of L, in whatever order sums are taken (Higham 2002, theorem
    /// 10.3), and ‖ |L||Lᵀ| ‖₂ is at most its largest row sum. Underflow adds less than the last bit of the bound.
    ///
    /// # Panics
    /// The factor has a border, or is kept in single precision.
    pub fn backward_error(&self, scale: &[f64]) -> f64 {
        assert_eq!(self.analysis.n_border(), 0, "the bound is that of a whole matrix");
        let Kept::Double(numbers) = &self.kept else { panic!("the bound is that of a factor in double precision") };
        let n = self.analysis.n();
        let given = self.analysis.given();
        let (mut columns, mut rows, mut lengths) = (vec![0.0; n], vec![0.0; n], vec![0usize; n]);
        let visit = |with: &mut dyn FnMut(usize, usize, f64)| {
            for (node, numbers) in numbers.supernodes(self.analysis) {
                let size = node.steps.len();
                numbers.panels.visit(|i, j, value| {
                    let row = if i < size { node.steps.start + i } else { node.below[i - size] as usize };
                    with(row, node.steps.start + j, value.abs() * scale[given[row] as usize]);
                });
            }
        };
        visit(&mut |row, col, value| {
            columns[col] += value;
            lengths[row] += 1;
        });
        visit(&mut |row, col, value| rows[row] += value * columns[col]);
        let longest = lengths.into_iter().max().unwrap_or(0);
        gamma(longest + PIVOT) * largest_row_sum(&rows)
    }
}
