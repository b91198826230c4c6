//! Sizes of the terms that energies are summed from.

use faer::MatRef;

use super::leading::Leading;
use super::product::absolute_product;
use crate::dense;

/// |x|ᵀ|A||x| for each column.
pub(crate) fn absolute_energy<'a>(matrix: impl Into<Leading<'a>>, x: MatRef<'_, f64>) -> Vec<f64> {
    energies_of_terms(x, absolute_product(matrix, x).as_ref())
}

/// |x|ᵀ t for each column of x and of its terms |A||x|.
pub(crate) fn energies_of_terms(x: MatRef<'_, f64>, terms: MatRef<'_, f64>) -> Vec<f64> {
    let energy = |j: usize| dense::column(x, j).iter().zip(dense::column(terms, j)).map(|(x, t)| x.abs() * t).sum();
    (0..x.ncols()).map(energy).collect()
}
