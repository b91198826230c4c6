//! The Cholesky factor of a definite matrix.

mod backward_error;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::supernodal::{
    SupernodalLltRef, factorize_supernodal_numeric_llt, factorize_supernodal_numeric_llt_scratch,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{MatMut, Par, Spec};

use super::block_solve;
use super::inertia::count_negative;
use super::{Analysis, Pencil, SolveOperator, Triangle};
use crate::error::{Error, Result};

/// Pivots below this share of their diagonal entry are rounding: a singular matrix leaves 50 to 500 ε, and a healthy one
/// of which less were left would have lost all but three digits.
const SINGULAR: f64 = 1024.0 * f64::EPSILON;

/// L of K − σM = L Lᵀ.
#[derive(Debug)]
pub struct Cholesky<'a> {
    analysis: &'a Analysis,
    values: Vec<f64>,
    /// Smallest ratio of a pivot to the diagonal entry it came from: how much of a dof's stiffness elimination left.
    pub smallest_pivot_ratio: f64,
}

impl<'a> Cholesky<'a> {
    /// Factors K − σM; `name` says what the dof of a step of elimination is called.
    ///
    /// # Errors
    /// [`Error::NotDefinite`] with the dof at which a pivot was not positive beyond rounding, or
    /// [`Error::IndefiniteStiffness`] with the number of negative eigenvalues of K; no memory.
    pub fn new(analysis: &'a Analysis, pencil: Pencil<'_>, sigma: f64, name: &dyn Fn(usize) -> String) -> Result<Self> {
        let symbolic = &analysis.symbolic;
        let lower = Triangle::shifted(pencil, sigma);
        let pattern =
            SymbolicSparseColMatRef::new_checked(analysis.n, analysis.n, &lower.pointers, None, &lower.indices);
        let matrix = SparseColMatRef::new(pattern, lower.values.as_slice());
        let mut values = zeros(symbolic.len_val())?;
        let parameters = Spec::default();
        let scratch = factorize_supernodal_numeric_llt_scratch::<usize, f64>(symbolic, Par::Seq, parameters);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| Error::OutOfMemory { what: "the factorisation" })?;
        factorize_supernodal_numeric_llt(
            &mut values,
            matrix,
            Default::default(),
            symbolic,
            Par::Seq,
            MemStack::new(&mut memory),
            parameters,
        )
        .map_err(|faer::linalg::cholesky::llt::factor::LltError::NonPositivePivot { index }| {
            not_definite(analysis, pencil, name(index))
        })?;
        let mut factor = Self { analysis, values, smallest_pivot_ratio: 1.0 };
        let (ratio, step) = factor.smallest_pivot(&lower);
        // Rounding decides the sign of a pivot that should be zero, so a singular matrix may well get this far.
        if ratio.is_nan() || ratio <= SINGULAR {
            return Err(not_definite(analysis, pencil, name(step)));
        }
        factor.smallest_pivot_ratio = ratio;
        Ok(factor)
    }

    /// The smallest ratio of a pivot to its diagonal entry, and the step of elimination it is met at.
    fn smallest_pivot(&self, lower: &Triangle) -> (f64, usize) {
        let factor = SupernodalLltRef::new(&self.analysis.symbolic, &self.values);
        let mut smallest = (1.0f64, 0);
        for s in 0..self.analysis.symbolic.n_supernodes() {
            let node = factor.supernode(s);
            for j in 0..node.val().ncols() {
                let step = node.start() + j;
                let ratio = node.val()[(j, j)].powi(2) / lower.values[lower.pointers[step]];
                // A ratio that is not a number is kept, and refused.
                if ratio.is_nan() || ratio < smallest.0 {
                    smallest = (ratio, step);
                }
            }
        }
        smallest
    }
}

impl SolveOperator for Cholesky<'_> {
    fn n(&self) -> usize {
        self.analysis.n
    }

    fn solve_in_place(&self, block: MatMut<'_, f64>) {
        block_solve::solve_in_place(SupernodalLltRef::new(&self.analysis.symbolic, &self.values), block);
    }
}

/// Why there is no Cholesky factor: negative eigenvalues of K where a count finds any, otherwise a mechanism at `dof`.
fn not_definite(analysis: &Analysis, pencil: Pencil<'_>, dof: String) -> Error {
    match count_negative(analysis, pencil.stiffness) {
        Ok(count) if count > 0 => Error::IndefiniteStiffness { count, boundary: "held" },
        _ => Error::NotDefinite { dof },
    }
}

/// A vector of zeros, or an error where there is no memory for it.
pub(super) fn zeros(len: usize) -> Result<Vec<f64>> {
    let mut values = Vec::new();
    values.try_reserve_exact(len).map_err(|_| Error::OutOfMemory { what: "the factor" })?;
    values.resize(len, 0.0);
    Ok(values)
}
