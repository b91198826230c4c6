//! The Cholesky factor of a definite matrix.

mod backward_error;
mod recalled;

use faer::{Mat, MatMut, MatRef};

use super::elimination::Kind;
use super::entry::Entry;
use super::matrix::Shifted;
use super::multifrontal::{Keep, Numbers, Stop, eliminate};
use super::refined::{Refined, Refinement};
use super::solve::by_solutions;
use super::sturm_count::{boundary_of, count_negative};
use super::substitution::Factor;
use super::{Analysis, SolveOperator, Storage};
use crate::dense;
use crate::error::{Error, Result};
use crate::sparse::Pencil;
use crate::sparse::diagonal;

/// Pivots below this share of their diagonal entry are rounding: a singular matrix leaves 50 to 500 ε, and a healthy one
/// of which less were left would have lost all but three digits.
const SINGULAR: f64 = 1024.0 * f64::EPSILON;

/// L of K − σM = L Lᵀ.
#[derive(Debug)]
pub struct Cholesky<'a> {
    analysis: &'a Analysis,
    kept: Kept<'a>,
    /// Smallest ratio of a pivot to the diagonal entry it came from: how much of a dof's stiffness elimination left.
    pub smallest_pivot_ratio: f64,
}

/// How L is kept.
#[derive(Debug)]
enum Kept<'a> {
    Double(Numbers<f64>),
    Single(Refined<'a>),
}

impl<'a> Cholesky<'a> {
    /// Factors K − σM; `name` says what a dof of the pencil is called.
    ///
    /// # Errors
    /// [`Error::NotDefinite`] with the dof at which a pivot was not positive beyond rounding, or
    /// [`Error::IndefiniteStiffness`] with the number of negative eigenvalues of K; no memory.
    pub fn new(analysis: &'a Analysis, pencil: Pencil<'_>, sigma: f64, name: &dyn Fn(usize) -> String) -> Result<Self> {
        let matrix = Shifted { pencil, sigma, scale: None, n_border: analysis.n_border() };
        let (numbers, smallest_pivot_ratio) = factored(analysis, &matrix, name)?;
        Ok(Self { analysis, kept: Kept::Double(numbers), smallest_pivot_ratio })
    }

    /// Factors K − σM and keeps the entries of L as `storage` says. In single precision they take half the memory: elimination still
    /// computes in double precision and refuses what [`Cholesky::new`] refuses, and solves take some steps of conjugate gradients
    /// with the matrix itself, which bring their residuals to rounding of double precision.
    ///
    /// # Errors
    /// As [`Cholesky::new`].
    pub fn kept(
        analysis: &'a Analysis,
        (pencil, sigma): (Pencil<'a>, f64),
        storage: Storage,
        name: &dyn Fn(usize) -> String,
    ) -> Result<Self> {
        if storage == Storage::Double {
            return Self::new(analysis, pencil, sigma, name);
        }
        let scale = scale_of(pencil, sigma);
        let matrix = Shifted { pencil, sigma, scale: Some(&scale), n_border: analysis.n_border() };
        let (numbers, smallest_pivot_ratio) = factored(analysis, &matrix, name)?;
        let kept = Kept::Single(Refined::new(analysis, (pencil, sigma), scale, numbers));
        Ok(Self { analysis, kept, smallest_pivot_ratio })
    }
}

impl Cholesky<'_> {
    /// −A_II⁻¹ A_IB X_B, n × k: how the eliminated dofs follow motions of the border, n_B × k, that nothing else loads.
    pub fn follow_border(&self, border: MatRef<'_, f64>) -> Mat<f64> {
        match &self.kept {
            Kept::Double(numbers) => Factor::definite(self.analysis, numbers).follow_border(border),
            Kept::Single(refined) => refined.follow_border(border),
        }
    }

    /// −A_BI A_II⁻¹ F of loads on the eliminated dofs, n_B × k: what the border takes of them. The transpose of [`Self::follow_border`].
    pub fn load_border(&self, loads: MatRef<'_, f64>) -> Mat<f64> {
        match &self.kept {
            Kept::Double(numbers) => Factor::definite(self.analysis, numbers).load_border(loads),
            Kept::Single(refined) => refined.load_border(loads),
        }
    }

    /// What elimination has left of the border, n_B × n_B: A_BB − A_BI A_II⁻¹ A_IB, symmetric to the bit.
    pub fn condensed(&self) -> Mat<f64> {
        match &self.kept {
            Kept::Double(numbers) => numbers.schur.clone(),
            Kept::Single(refined) => refined.condensed(),
        }
    }

    /// How L is kept.
    pub fn storage(&self) -> Storage {
        match self.kept {
            Kept::Double(_) => Storage::Double,
            Kept::Single(_) => Storage::Single,
        }
    }

    /// A result of solves with this factor.
    ///
    /// # Errors
    /// [`Error::NotRefined`] where a solve did not come down to rounding, which explains whatever else went wrong.
    pub fn vouched<T>(&self, result: Result<T>) -> Result<T> {
        self.refinement()?;
        result
    }

    /// What refinement took where L is kept in single precision; to be asked after the last solve.
    ///
    /// # Errors
    /// [`Error::NotRefined`] where a solve did not come down to rounding: no result of this factor can be used.
    pub fn refinement(&self) -> Result<Option<Refinement>> {
        match &self.kept {
            Kept::Double(_) => Ok(None),
            Kept::Single(refined) => refined.work().map(Some),
        }
    }
}

/// D of D (K − σM) D. Entries of L are then at most one or two, and pivots at least a root of what is refused: far from the ends of the range
/// of single precision.
fn scale_of(pencil: Pencil<'_>, sigma: f64) -> Vec<f64> {
    let diagonals = diagonal(pencil.stiffness).into_iter().zip(diagonal(pencil.mass));
    diagonals.map(|(k, m)| dense::power_of_two_root((k - sigma * m).abs())).collect()
}

/// L of D (K − σM) D, and the smallest ratio of a pivot to its diagonal entry.
fn factored<T: Entry>(
    analysis: &Analysis,
    matrix: &Shifted<'_>,
    name: &dyn Fn(usize) -> String,
) -> Result<(Numbers<T>, f64)> {
    let not_definite = |step: usize| not_definite(analysis, matrix.pencil, name(analysis.given()[step] as usize));
    let numbers = eliminate(analysis, matrix, Kind::Definite, Keep::Factor).map_err(|stop| match stop {
        Stop::NotPositive(step) => not_definite(step),
        Stop::NoMemory => Error::OutOfMemory { what: "the factor" },
    })?;
    let (ratio, step) = smallest_pivot(analysis, matrix, &numbers);
    // Rounding decides the sign of a pivot that should be zero, so a singular matrix may well get this far.
    if ratio.is_nan() || ratio <= SINGULAR {
        drop(numbers);
        return Err(not_definite(step));
    }
    Ok((numbers, ratio))
}

/// The smallest ratio of a pivot to its diagonal entry, and the step of elimination it is met at.
fn smallest_pivot<T: Entry>(analysis: &Analysis, matrix: &Shifted<'_>, numbers: &Numbers<T>) -> (f64, usize) {
    let (stiffness, mass) = (diagonal(matrix.pencil.stiffness), diagonal(matrix.pencil.mass));
    let mut smallest = (1.0f64, 0);
    for ((step, dof), (pivot, _)) in analysis.given().iter().enumerate().zip(numbers.pivots()) {
        let dof = *dof as usize;
        let scale = matrix.scale.map_or(1.0, |scale| scale[dof] * scale[dof]);
        let ratio = pivot / (scale * (stiffness[dof] - matrix.sigma * mass[dof]));
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
        match &self.kept {
            Kept::Double(numbers) => Factor::definite(self.analysis, numbers).solve_in_place(block),
            Kept::Single(refined) => refined.solve_in_place(block),
        }
    }

    /// ‖L⁻¹f‖², the forward half of a solve, where L is that of the matrix.
    fn compliances(&self, loads: MatRef<'_, f64>) -> Vec<f64> {
        match &self.kept {
            Kept::Double(numbers) => Factor::definite(self.analysis, numbers).compliances(loads),
            Kept::Single(_) => by_solutions(self, loads),
        }
    }

    fn bytes(&self) -> u64 {
        self.analysis.factor_bytes(self.storage())
    }
}

/// Why there is no Cholesky factor: negative eigenvalues of K where a count finds any, otherwise a mechanism at `dof`.
fn not_definite(analysis: &Analysis, pencil: Pencil<'_>, dof: String) -> Error {
    let boundary = boundary_of(analysis, pencil.stiffness);
    match count_negative(analysis, pencil.stiffness) {
        Ok(count) if count > 0 => Error::IndefiniteStiffness { count, boundary },
        _ => Error::NotDefinite { dof, boundary },
    }
}
