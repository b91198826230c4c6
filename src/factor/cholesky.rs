//! The Cholesky factor of a definite matrix.

mod backward_error;

use faer::{Mat, MatMut, MatRef};

use super::elimination::Kind;
use super::inertia::count_negative;
use super::matrix::Shifted;
use super::multifrontal::{Keep, Numbers, Stop, eliminate};
use super::substitution::Factor;
use super::{Analysis, Pencil, SolveOperator};
use crate::error::{Error, Result};
use crate::model::diagonal;

/// Pivots below this share of their diagonal entry are rounding: a singular matrix leaves 50 to 500 ε, and a healthy one
/// of which less were left would have lost all but three digits.
const SINGULAR: f64 = 1024.0 * f64::EPSILON;

/// L of K − σM = L Lᵀ.
#[derive(Debug)]
pub struct Cholesky<'a> {
    analysis: &'a Analysis,
    numbers: Numbers,
    /// Smallest ratio of a pivot to the diagonal entry it came from: how much of a dof's stiffness elimination left.
    pub smallest_pivot_ratio: f64,
}

impl<'a> Cholesky<'a> {
    /// Factors K − σM; `name` says what a dof of the pencil is called.
    ///
    /// # Errors
    /// [`Error::NotDefinite`] with the dof at which a pivot was not positive beyond rounding, or
    /// [`Error::IndefiniteStiffness`] with the number of negative eigenvalues of K; no memory.
    pub fn new(analysis: &'a Analysis, pencil: Pencil<'_>, sigma: f64, name: &dyn Fn(usize) -> String) -> Result<Self> {
        let matrix = Shifted { pencil, sigma, scale: None, n_border: analysis.n_border() };
        let not_definite = |step: usize| not_definite(analysis, pencil, name(analysis.given()[step] as usize));
        let mut numbers = eliminate(analysis, &matrix, Kind::Definite, Keep::Factor).map_err(|stop| match stop {
            Stop::NotPositive(step) => not_definite(step),
            Stop::NoMemory => Error::OutOfMemory { what: "the factor" },
        })?;
        numbers.schur = Mat::zeros(0, 0);
        let (ratio, step) = smallest_pivot(analysis, pencil, sigma, &numbers);
        // Rounding decides the sign of a pivot that should be zero, so a singular matrix may well get this far.
        if ratio.is_nan() || ratio <= SINGULAR {
            drop(numbers);
            return Err(not_definite(step));
        }
        Ok(Self { analysis, numbers, smallest_pivot_ratio: ratio })
    }
}

impl Cholesky<'_> {
    /// −A_II⁻¹ A_IB X_B, n × k: how the eliminated dofs follow motions of the border, n_B × k, that nothing else loads.
    pub fn follow_border(&self, border: MatRef<'_, f64>) -> Mat<f64> {
        Factor::definite(self.analysis, &self.numbers).follow_border(border)
    }
}

/// The smallest ratio of a pivot to its diagonal entry, and the step of elimination it is met at.
fn smallest_pivot(analysis: &Analysis, pencil: Pencil<'_>, sigma: f64, numbers: &Numbers) -> (f64, usize) {
    let (stiffness, mass) = (diagonal(pencil.stiffness), diagonal(pencil.mass));
    let mut smallest = (1.0f64, 0);
    for ((step, dof), (pivot, _)) in analysis.given().iter().enumerate().zip(numbers.pivots()) {
        let ratio = pivot / (stiffness[*dof as usize] - sigma * mass[*dof as usize]);
        // A ratio that is not a number is kept, and refused.
        if ratio.is_nan() || ratio < smallest.0 {
            smallest = (ratio, step);
        }
    }
    smallest
}

impl SolveOperator for Cholesky<'_> {
    fn n(&self) -> usize {
        self.analysis.n()
    }

    fn solve_in_place(&self, block: MatMut<'_, f64>) {
        Factor::definite(self.analysis, &self.numbers).solve_in_place(block);
    }

    fn bytes(&self) -> u64 {
        self.analysis.factor_bytes()
    }
}

/// Why there is no Cholesky factor: negative eigenvalues of K where a count finds any, otherwise a mechanism at `dof`.
fn not_definite(analysis: &Analysis, pencil: Pencil<'_>, dof: String) -> Error {
    match count_negative(analysis, pencil.stiffness) {
        Ok(count) if count > 0 => Error::IndefiniteStiffness { count, boundary: "held" },
        _ => Error::NotDefinite { dof },
    }
}
