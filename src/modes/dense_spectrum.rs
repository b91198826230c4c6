//! The whole spectrum of a small model by a dense decomposition, where most of it is wanted.
//!
//! ```text
//! M = L Lᵀ    C = L⁻¹ K L⁻ᵀ    C V = V Λ    X = L⁻ᵀ V
//! ```
//! Rounding is relative to the largest eigenvalue, which is what the backward error of a mode is relative to as well; the
//! Rayleigh quotients bring the low frequencies back to full precision.

use faer::linalg::solvers::Llt;
use faer::{Mat, Side};

use super::boundary_problem::BoundaryProblem;
use crate::dense;
use crate::eigen::{EigenWork, Eigenpairs, Problem};
use crate::eigen::{Modes, judged};
use crate::error::Result;
use crate::sparse::Leading;

/// Largest order: the decomposition takes some 10 n³ operations, half a minute here.
const MAX_ORDER: usize = 3000;
/// The share of the spectrum from which it is faster than slices.
const MIN_SHARE_WANTED: f64 = 0.5;
/// Smallest pivot of the scaled M: above it the eigenvalues keep all but three digits of what rounding leaves.
const DEFINITE: f64 = 1e-6;

/// All elastic modes, where the model is small, most of the `wanted` part of its spectrum is asked for and M is definite.
///
/// # Errors
/// The decomposition does not converge.
pub(super) fn all_modes(problem: &BoundaryProblem<'_>, wanted: usize) -> Result<Option<Modes>> {
    let modal = problem.modal();
    let n = modal.mass.rows();
    if n > MAX_ORDER || (wanted as f64) < MIN_SHARE_WANTED * n as f64 {
        return Ok(None);
    }
    // Powers of two bring the diagonal of M near one, so that the pivots can be compared.
    let diagonal = modal.mass.diagonal();
    let scale: Vec<f64> = diagonal.into_iter().map(dense::power_of_two_root).collect();
    let Some(factor) = definite(scaled(modal.mass, &scale)) else {
        return Ok(None);
    };
    let lower = factor.L();
    let mut c = dense::standard_form(lower, scaled(modal.stiffness, &scale));
    dense::symmetrise(&mut c);
    let (values, mut vectors) = dense::symmetric_eigen(c.as_ref())?;
    lower.transpose().solve_upper_triangular_in_place(&mut vectors);
    let n_rigid = problem.n_rigid();
    let mut shapes = Mat::from_fn(n, n - n_rigid, |i, j| vectors[(i, n_rigid + j)] * scale[i]);
    let deflated = modal.deflated;
    let along = dense::gram(deflated[1], shapes.as_ref());
    dense::add_product(shapes.as_mut(), -1.0, deflated[0], along.as_ref());
    let (mut modes, n_factorisations) = problem.with_lowest_operator(|operator| {
        let pairs = Eigenpairs { values, vectors: shapes, next: None, work: EigenWork::default() };
        Ok(judged(modal, Problem { operator, mass: modal.mass, deflated }, pairs, [None, None]).ascending())
    })?;
    modes.work.factorisations += n_factorisations;
    Ok(Some(modes))
}

/// L of a matrix that is definite beyond doubt.
fn definite(mass: Mat<f64>) -> Option<Llt<f64>> {
    let factor = mass.llt(Side::Lower).ok()?;
    let is_definite = (0..mass.nrows()).all(|i| factor.L()[(i, i)].powi(2) > DEFINITE);
    is_definite.then_some(factor)
}

fn scaled(matrix: Leading<'_>, scale: &[f64]) -> Mat<f64> {
    let mut full = Mat::zeros(matrix.rows(), matrix.rows());
    for row in 0..matrix.rows() {
        matrix.entries(row).for_each(|(col, value)| full[(row, col)] = value * scale[row] * scale[col]);
    }
    full
}
