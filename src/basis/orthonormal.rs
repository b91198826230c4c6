//! Orthonormal columns of a basis all at once, where they are far from dependent: Cholesky of their Gram matrix, twice
//! (Yamamoto et al. 2015).
//!
//! ```text
//! G = XᵀMX = RᵀR    X ← X R⁻¹    n × k, k × k
//! ```
//! The first pass leaves ε κ(G) of orthogonality, the second ε. A column that keeps little of its length without the columns before
//! it is for the panels of [`super::dynamic`], which tell dependent ones.

use faer::{Mat, MatRef, Side};

use crate::dense;
use crate::sparse::{Leading, panels, product};

/// Share of its length that a column must keep: the square, what Cholesky works with, has half its digits then.
const HEALTHY: f64 = 1e-4;
/// Distance of G from the identity, in its row sums, at which a pass leaves no more than rounding: κ(G) is 1.1/0.9 at most.
const NEARLY: f64 = 0.1;

/// Q and upper triangular R with X = Q R and QᵀMQ = I; none where a column is not healthy.
pub(super) fn orthonormalised(columns: MatRef<'_, f64>, mass: Leading<'_>) -> Option<(Mat<f64>, Mat<f64>)> {
    let k = columns.ncols();
    let mut q = columns.to_owned();
    let mut triangle: Mat<f64> = Mat::identity(k, k);
    for _ in 0..2 {
        let gram = mass_gram(q.as_ref(), mass);
        let lower = gram.llt(Side::Lower).ok()?;
        let lower = lower.L();
        let is_healthy = (0..k).all(|j| lower[(j, j)] > HEALTHY * gram[(j, j)].sqrt());
        if !is_healthy {
            return None;
        }
        dense::divide(q.as_mut(), lower);
        triangle = dense::product(lower.transpose(), triangle.as_ref());
        let distance = |j: usize| (0..k).map(|i| (gram[(i, j)] - f64::from(u8::from(i == j))).abs()).sum::<f64>();
        if (0..k).all(|j| distance(j) <= NEARLY) {
            return Some((q, triangle));
        }
    }
    None
}

/// XᵀMX.
fn mass_gram(x: MatRef<'_, f64>, mass: Leading<'_>) -> Mat<f64> {
    let k = x.ncols();
    let mut gram = Mat::zeros(k, k);
    for columns in panels(k) {
        let (below, panel) = (x.get(.., columns.start..), x.get(.., columns.clone()));
        let products = dense::gram(below, product(mass, panel).as_ref());
        gram.as_mut().get_mut(columns.start.., columns).copy_from(&products);
    }
    for j in 0..k {
        for i in 0..j {
            gram[(i, j)] = gram[(j, i)];
        }
    }
    gram
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::sparse::SparseMatrix;

    fn diagonal(n: usize) -> SparseMatrix {
        let values = (0..n).map(|i| 1.0 + (i % 7) as f64).collect();
        SparseMatrix::new((n, n), (0..=n).collect(), (0..n as u32).collect(), values)
    }

    fn columns(n: usize, k: usize) -> Mat<f64> {
        Mat::from_fn(n, k, |i, j| ((i * (j + 2)) as f64).sin() + 1.0 / (1 + i + j) as f64)
    }

    #[test]
    fn columns_are_orthonormal_and_come_back() {
        let (n, k) = (3000, 40);
        let (x, mass) = (columns(n, k), diagonal(n));
        let (q, r) = orthonormalised(x.as_ref(), Leading::from(&mass)).expect("healthy columns");
        let gram = mass_gram(q.as_ref(), Leading::from(&mass));
        let back = dense::product(q.as_ref(), r.as_ref());
        for j in 0..k {
            for i in 0..k {
                // Sums of n products of unit vectors, rounded at random, and those of the solve with k terms.
                let expected = f64::from(u8::from(i == j));
                assert!((gram[(i, j)] - expected).abs() < 4.0 * (n as f64).sqrt() * f64::EPSILON, "{i}, {j}");
                assert!(i <= j || r[(i, j)] == 0.0, "R is upper triangular");
            }
            let difference: Vec<f64> = (0..n).map(|i| back[(i, j)] - x[(i, j)]).collect();
            let size = dense::norm(dense::column(x.as_ref(), j));
            assert!(dense::norm(&difference) <= k as f64 * f64::EPSILON * size, "column {j}");
        }
    }

    /// Each entry of G is within a tenth of the identity's, and the columns together are far from it.
    #[test]
    fn nearly_dependent_columns_take_a_second_pass() {
        let k = 11;
        let share = 0.1 * (1.0 - 1e-6);
        let g = Mat::from_fn(k, k, |i, j| if i == j { 1.0 } else { -share });
        let lower = g.llt(Side::Lower).expect("definite").L().to_owned();
        let unit = SparseMatrix::new((k, k), (0..=k).collect(), (0..k as u32).collect(), vec![1.0; k]);
        let (q, _) = orthonormalised(lower.transpose(), Leading::from(&unit)).expect("healthy columns");
        let gram = mass_gram(q.as_ref(), Leading::from(&unit));
        let error = Mat::from_fn(k, k, |i, j| (gram[(i, j)] - f64::from(u8::from(i == j))).abs()).norm_max();
        assert!(error <= 4.0 * k as f64 * f64::EPSILON, "{error:e}");
    }

    #[test]
    fn dependent_and_empty_columns_are_for_others() {
        let mass = diagonal(500);
        let mut x = columns(500, 5);
        let twin: Vec<f64> = dense::column(x.as_ref(), 1).iter().map(|value| 3.0 * value).collect();
        dense::column_mut(x.as_mut(), 4).copy_from_slice(&twin);
        assert!(orthonormalised(x.as_ref(), Leading::from(&mass)).is_none());
        dense::column_mut(x.as_mut(), 4).fill(0.0);
        assert!(orthonormalised(x.as_ref(), Leading::from(&mass)).is_none());
    }

    #[test]
    fn no_columns_are_orthonormal() {
        let (q, r) = orthonormalised(Mat::zeros(9, 0).as_ref(), Leading::from(&diagonal(9))).expect("nothing to do");
        assert_eq!((q.shape(), r.shape()), ((9, 0), (0, 0)));
    }
}
