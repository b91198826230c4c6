//! How far L Lᵀ can be from the matrix that was factored.

use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;

use super::Cholesky;
use crate::factor::rounding::{gamma, largest_row_sum};

/// Roundings of an entry beside those of its sum: the root or the division of the pivot, and the product with its
/// reciprocal.
const PIVOT: usize = 3;

impl Cholesky<'_> {
    /// An upper bound of ‖S (A − LLᵀ) S‖₂ with powers of two S, where A is the matrix as it was handed to the factorisation.
    ///
    /// |A − LLᵀ| ≤ γ_{m+3} |L||Lᵀ| with m the longest row of L, in whatever order sums are taken (Higham 2002, theorem
    /// 10.3), and ‖ |L||Lᵀ| ‖₂ is at most its largest row sum. Underflow adds less than the last bit of the bound.
    pub fn backward_error(&self, scale: &[f64]) -> f64 {
        let n = self.analysis.n;
        let factor = SupernodalLltRef::new(&self.analysis.symbolic, &self.values);
        let (mut columns, mut rows, mut lengths) = (vec![0.0; n], vec![0.0; n], vec![0usize; n]);
        let visit = |with: &mut dyn FnMut(usize, usize, f64)| {
            for s in 0..self.analysis.symbolic.n_supernodes() {
                let node = factor.supernode(s);
                let (start, size, pattern) = (node.start(), node.val().ncols(), node.pattern());
                for j in 0..size {
                    for i in j..node.val().nrows() {
                        let row = if i < size { start + i } else { pattern[i - size] };
                        with(row, start + j, node.val()[(i, j)].abs() * scale[row]);
                    }
                }
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
