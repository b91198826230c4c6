//! What a factor can do for its users.

use faer::MatMut;

/// A linear operator A⁻¹ applied to blocks of right-hand sides.
pub trait SolveOperator: Sync {
    /// Order of A.
    fn n(&self) -> usize;

    /// Replaces an n × k block of right-hand sides by the solutions.
    fn solve_in_place(&self, block: MatMut<'_, f64>);

    /// Bytes of the factor, all of which a solve reads.
    fn bytes(&self) -> u64;
}
