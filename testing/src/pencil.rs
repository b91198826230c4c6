//! Pencils of models and of superelements by dense algebra that shares nothing with the program.

use faer::{Mat, MatRef, Side};
use supel_models::{Model, dense};
use supel_runtime::{Matrix, Superelement};

/// A matrix of a superelement.
pub fn unpacked(matrix: &Matrix) -> Mat<f64> {
    Mat::from_fn(matrix.rows(), matrix.cols(), |i, j| matrix[(i, j)])
}

/// K and M of a model.
pub fn matrices(model: &Model) -> [Mat<f64>; 2] {
    [&model.stiffness, &model.mass].map(|entries| {
        let rows = dense::dense(model.n, entries);
        Mat::from_fn(model.n, model.n, |i, j| rows[i][j])
    })
}

/// The rows with the numbers given, and the same columns.
pub fn part(a: MatRef<'_, f64>, kept: &[usize]) -> Mat<f64> {
    Mat::from_fn(kept.len(), kept.len(), |i, j| a[(kept[i], kept[j])])
}

/// λ and shapes of K x = λ M x by a Cholesky factor of K + αM with unit diagonal, ascending: θ = 1/(λ + α) is known to rounding of the
/// largest θ, and with it the low end of the spectrum.
pub fn eigen(k: MatRef<'_, f64>, m: MatRef<'_, f64>, alpha: f64) -> (Vec<f64>, Mat<f64>) {
    let n = k.nrows();
    let shifted = |i: usize, j: usize| k[(i, j)] + alpha * m[(i, j)];
    let scale: Vec<f64> = (0..n).map(|i| shifted(i, i).sqrt().recip()).collect();
    let a = Mat::from_fn(n, n, |i, j| shifted(i, j) * scale[i] * scale[j]);
    let mut c = Mat::from_fn(n, n, |i, j| m[(i, j)] * scale[i] * scale[j]);
    let factor = a.llt(Side::Lower).expect("definite");
    let lower = factor.L();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(lower, c.as_mut(), faer::Par::Seq);
    let mut c = c.transpose().to_owned();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(lower, c.as_mut(), faer::Par::Seq);
    let found = c.self_adjoint_eigen(Side::Lower).expect("converges");
    let theta: Vec<f64> = found.S().column_vector().iter().rev().copied().collect();
    let mut shapes = Mat::from_fn(n, n, |i, j| found.U()[(i, n - 1 - j)]);
    faer::linalg::triangular_solve::solve_upper_triangular_in_place(lower.transpose(), shapes.as_mut(), faer::Par::Seq);
    let shapes = Mat::from_fn(n, n, |i, j| shapes[(i, j)] * scale[i] / theta[j].abs().sqrt());
    (theta.into_iter().map(|theta| 1.0 / theta - alpha).collect(), shapes)
}

/// λ of a superelement with these of its coordinates at rest.
pub fn spectrum(file: &Superelement, held: &[usize], alpha: f64) -> Vec<f64> {
    let [k, m] = [&file.tensors().stiffness, &file.tensors().mass].map(unpacked);
    let moving: Vec<usize> = (0..k.nrows()).filter(|at| !held.contains(at)).collect();
    eigen(part(k.as_ref(), &moving).as_ref(), part(m.as_ref(), &moving).as_ref(), alpha).0
}

/// The largest difference of θ = 1/(λ + α) of two spectra of as many eigenvalues, relative to the largest θ.
#[track_caller]
pub fn difference(found: &[f64], expected: &[f64], alpha: f64) -> f64 {
    assert_eq!(found.len(), expected.len(), "as many eigenvalues");
    let theta = |lambda: f64| (expected[0] + alpha) / (lambda + alpha);
    found.iter().zip(expected).fold(0.0, |worst, (a, b)| f64::max(worst, (theta(*a) - theta(*b)).abs()))
}
