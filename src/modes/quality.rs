//! How well modes are known: Rayleigh quotients, backward errors, error bars.

use faer::{Mat, MatRef};

use super::{Equilibrated, ModalProblem};
use crate::dense;
use crate::rigid::absolute_energy;
use crate::sparse::SparseMatrix;
use crate::sparse::product;

/// What is known of the error of one mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModeError {
    /// Normwise backward error of the pair (M-01).
    pub backward: f64,
    /// c = (|x|ᵀ|K||x| + λ|x|ᵀ|M||x|) / (λ xᵀMx): how much larger the cancelling terms are than the modal energy (M-09).
    pub cancellation: f64,
    /// Relative error bar of λ: the digits of the data and of the arithmetic, each times its share of c.
    pub relative_bar: f64,
    /// ε ‖K‖ ‖x‖² / xᵀMx, equilibrated: an eigenvalue of this size is rounding of whoever made K, whatever the terms of
    /// xᵀKx, which may all vanish for a matrix that was itself projected.
    pub rounding_floor: f64,
}

/// Scales every column to xᵀMx = 1, largest component positive.
pub(super) fn normalise(mass: &SparseMatrix, shapes: &mut Mat<f64>) {
    let images = product(mass, shapes.as_ref());
    for j in 0..shapes.ncols() {
        let column = dense::column(shapes.as_ref(), j);
        let length = dense::dot(column, dense::column(images.as_ref(), j)).max(0.0).sqrt();
        // The first of the largest components decides the sign, so that it does not flip from run to run.
        let largest = column.iter().fold(0.0f64, |max, value| if value.abs() > max.abs() { *value } else { max });
        let factor = largest.signum() / length;
        dense::column_mut(shapes.as_mut(), j).iter_mut().for_each(|value| *value *= factor);
    }
}

/// λ = xᵀKx of M-orthonormal shapes, and what is known of their errors.
pub(super) fn rayleigh_quotients(problem: ModalProblem<'_>, shapes: MatRef<'_, f64>) -> (Vec<f64>, Vec<ModeError>) {
    let (forces, momenta) = rayon::join(|| product(problem.stiffness, shapes), || product(problem.mass, shapes));
    let (stiffness_terms, mass_terms) =
        rayon::join(|| absolute_energy(problem.stiffness, shapes), || absolute_energy(problem.mass, shapes));
    let norms = Equilibrated::of(problem.stiffness, problem.mass);
    let rounding = f64::EPSILON;
    (0..shapes.ncols())
        .map(|j| {
            let x = dense::column(shapes, j);
            let (force, momentum) = (dense::column(forces.as_ref(), j), dense::column(momenta.as_ref(), j));
            let modal_mass = dense::dot(x, momentum);
            let lambda = dense::dot(x, force) / modal_mass;
            let residual: Vec<f64> = force.iter().zip(momentum).map(|(f, p)| f - lambda * p).collect();
            let (k_share, m_share) = (stiffness_terms[j] / (lambda.abs() * modal_mass), mass_terms[j] / modal_mass);
            let error = ModeError {
                backward: norms.backward_error(lambda, x, &residual),
                cancellation: k_share + m_share,
                relative_bar: (problem.precision.stiffness + rounding) * k_share
                    + (problem.precision.mass + rounding) * m_share,
                rounding_floor: rounding * norms.stiffness_norm * norms.scaled_norm(x).powi(2) / modal_mass,
            };
            (lambda, error)
        })
        .unzip()
}

/// max |XᵀMX − I| over all pairs, and the pair it is reached at (M-03).
pub fn mass_orthogonality(mass: &SparseMatrix, shapes: MatRef<'_, f64>) -> (f64, (usize, usize)) {
    let products = dense::gram(shapes, product(mass, shapes).as_ref());
    let mut worst = (0.0, (0, 0));
    for j in 0..products.ncols() {
        for i in 0..=j {
            let error = (products[(i, j)] - f64::from(u8::from(i == j))).abs();
            if dense::worse(error, worst.0) {
                worst = (error, (i, j));
            }
        }
    }
    worst
}
