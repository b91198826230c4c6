//! Factorisation of K_II and of K − σM, solves, and counts of negative pivots.
//!
//! ```text
//! Analysis       order given, elimination tree, supernodes; shared by every factorisation of the same pattern
//! Cholesky       K = L Lᵀ for a definite matrix: solves on blocks of right-hand sides
//! ShiftedFactor  K − σM = L B Lᵀ: how many eigenvalues lie below σ, and solves with it
//! ```
//!
//! The matrices arrive in their order of elimination. Everything here runs on faer's supernodal kernels with one
//! thread for each task, which is what they are fastest with and what makes their bits repeat; callers take
//! parallelism from independent tasks. Nothing outside this folder knows how a factor is stored.

mod analysis;
mod cholesky;
mod elimination;
mod indefinite;
mod inertia;
mod matrix;
mod memory;
mod multifrontal;
mod rounding;
mod rows;
mod solve;
mod substitution;

use crate::sparse::SparseMatrix;

pub use analysis::Analysis;
pub use cholesky::Cholesky;
pub use indefinite::{WholeCount, whole_count};
pub use inertia::{InertiaCount, ShiftedFactor, condensed, count_below, count_negative, rank};
pub use memory::refuse_beyond_memory;
pub use rounding::forming_error;
pub use solve::SolveOperator;

/// A symmetric pencil in its order of elimination: K and M of one size, whose combinations K − σM are factored.
#[derive(Clone, Copy, Debug)]
pub struct Pencil<'a> {
    /// K, n × n.
    pub stiffness: &'a SparseMatrix,
    /// M, n × n.
    pub mass: &'a SparseMatrix,
}
