//! Bounds of rounding errors, themselves rounded up.

use crate::sparse::Pencil;

/// Half the distance of one to the next double: the largest relative error of one operation.
const UNIT: f64 = f64::EPSILON / 2.0;
/// What rounding of a bound's own sums of numbers of one sign is covered by: n u stays below it for n up to 10¹³.
const OUTWARD: f64 = 1.01;

/// γ_k = k u / (1 − k u), rounded up.
pub(super) fn gamma(k: usize) -> f64 {
    let ku = k as f64 * UNIT;
    OUTWARD * ku / (1.0 - ku)
}

/// The largest of sums of numbers that are not negative, rounded up.
pub(super) fn largest_row_sum(sums: &[f64]) -> f64 {
    // A sum that is not a number stays one.
    OUTWARD * sums.iter().fold(0.0, |max: f64, sum| if sum.is_nan() || max.is_nan() { f64::NAN } else { max.max(*sum) })
}

/// An upper bound of ‖S (fl(K − σM) − (K − σM)) S‖₂: product, difference, and one more operation on the diagonal.
pub fn forming_error(pencil: Pencil<'_>, sigma: f64, scale: &[f64]) -> f64 {
    let n = pencil.stiffness.rows();
    let mut sums = vec![0.0; n];
    for (matrix, factor) in [(pencil.stiffness, 1.0), (pencil.mass, sigma.abs())] {
        for (row, sum) in sums.iter_mut().enumerate() {
            let of_row: f64 = matrix.entries(row).map(|(col, value)| value.abs() * scale[col]).sum();
            *sum += factor * scale[row] * of_row;
        }
    }
    gamma(3) * largest_row_sum(&sums)
}
