//! What a factor can do for its users.

use faer::{MatMut, MatRef};

use crate::dense;

/// A linear operator A⁻¹ applied to blocks of right-hand sides.
pub trait SolveOperator: Sync {
    /// Order of A.
    fn n(&self) -> usize;

    /// Replaces an n × k block of right-hand sides by the solutions.
    fn solve_in_place(&self, block: MatMut<'_, f64>);

    /// fᵀA⁻¹f of each column of an n × k block of loads.
    fn compliances(&self, loads: MatRef<'_, f64>) -> Vec<f64> {
        by_solutions(self, loads)
    }

    /// Bytes of the factor, all of which a solve reads.
    fn bytes(&self) -> u64;
}

/// fᵀA⁻¹f of each column where there is nothing better than to solve.
pub(super) fn by_solutions<S: SolveOperator + ?Sized>(operator: &S, loads: MatRef<'_, f64>) -> Vec<f64> {
    let mut x = loads.to_owned();
    operator.solve_in_place(x.as_mut());
    dense::dots(loads, x.as_ref())
}
