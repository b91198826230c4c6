//! The inertia of a whole matrix, and how far its factors can be from it.

use super::Indefinite;
use crate::dense;
use crate::error::Result;
use crate::factor::multifrontal::Keep;
use crate::factor::rounding::{forming_error, gamma, largest_row_sum};
use crate::factor::{Analysis, Pencil};

/// The number of eigenvalues of a pencil below a shift, by one factorisation of all its dofs.
#[derive(Clone, Debug, PartialEq)]
pub struct WholeCount {
    /// The shift.
    pub sigma: f64,
    /// Eigenvalues below it, as many as there are negative pivots.
    pub below: usize,
    /// Largest pivot over largest entry.
    pub growth: f64,
    /// Upper bound of ‖D (K − σM − LBLᵀ) D‖₂.
    pub backward_error: f64,
    /// D, powers of two near 1/√(|K_ii| + |σ| M_ii).
    pub scale: Vec<f64>,
}

/// Roundings of an entry beside those of its sum: solving with a pivot of order two is stable with a constant of some
/// tens (Higham 1997, *Stability of the diagonal pivoting method with partial pivoting*).
const PIVOT: usize = 64;

/// Counts the eigenvalues of a whole pencil below σ.
///
/// # Errors
/// Those of [`crate::factor::count_below`].
pub fn whole_count(analysis: &Analysis, pencil: Pencil<'_>, sigma: f64) -> Result<WholeCount> {
    let factor = Indefinite::new(analysis, pencil, sigma, Keep::Factor)?;
    let signs = factor.signs()?;
    let backward_error = factor.backward_error() + forming_error(pencil, sigma, &factor.scale);
    Ok(WholeCount { sigma, below: signs.negative, growth: signs.growth, backward_error, scale: factor.scale })
}

impl Indefinite<'_> {
    /// An upper bound of ‖A − LBLᵀ‖₂ of the scaled matrix as it was factored: γ (‖A‖ + ‖ |L||B||Lᵀ| ‖) in the largest row sum.
    ///
    /// Rows of a supernode are exchanged among themselves only. The largest row sum from its own columns plus the largest
    /// from earlier ones bounds every row, whatever the exchange.
    fn backward_error(&self) -> f64 {
        let n = self.analysis.n();
        let supernodes = || self.numbers.supernodes(self.analysis);
        let mut lengths = vec![0usize; n];
        // |B| |Lᵀ| 1 by columns.
        let mut images = vec![0.0; n];
        for (node, numbers) in supernodes() {
            let (start, size) = (node.steps.start, node.steps.len());
            let mut sums = vec![1.0; size];
            for (j, sum) in sums.iter_mut().enumerate() {
                for (i, value) in dense::column(numbers.trapezoid, j).iter().enumerate().skip(j + 1) {
                    *sum += value.abs();
                    lengths[if i < size { start + i } else { node.below[i - size] as usize }] += 1;
                }
            }
            for j in 0..size {
                images[start + j] += numbers.diagonal[j].abs() * sums[j];
                let below = numbers.subdiagonal[j].abs();
                if below > 0.0 && j + 1 < size {
                    images[start + j] += below * sums[j + 1];
                    images[start + j + 1] += below * sums[j];
                }
            }
        }
        let mut earlier = vec![0.0; n];
        let mut largest = 0.0f64;
        for (node, numbers) in supernodes() {
            let (start, size) = (node.steps.start, node.steps.len());
            let mut own = images[start..start + size].to_vec();
            for j in 0..size {
                for (i, value) in dense::column(numbers.trapezoid, j).iter().enumerate().skip(j + 1) {
                    let value = value.abs() * images[start + j];
                    if i < size {
                        own[i] += value;
                    } else {
                        earlier[node.below[i - size] as usize] += value;
                    }
                }
            }
            largest = largest.max(largest_row_sum(&own) + largest_row_sum(&earlier[start..start + size]));
        }
        // Of A itself no more is known here than its largest entry; a row has as many as the factor's, twice.
        let longest = lengths.into_iter().max().unwrap_or(0) + 1;
        let matrix = self.largest * 2.0 * longest as f64;
        gamma(2 * longest + PIVOT) * (largest + matrix)
    }
}
