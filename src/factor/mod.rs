//! Factorisation of K − σM without its interface, solves, and counts of negative pivots.
//!
//! ```text
//! Analysis       elimination tree, supernodes, tasks; shared by every factorisation of the same pattern
//! Cholesky       K − σM = L Lᵀ where it is definite: solves on blocks of right-hand sides, constraint modes
//! ShiftedFactor  K − σM = L B Lᵀ: how many eigenvalues lie below σ, and solves with it
//!
//! multifrontal   fronts, on faer's dense kernels        substitution   forward and backward through the tree
//! ```
//!
//! The interface is a border that is not eliminated. L has its rows, and elimination leaves the Schur complement in its
//! block. Threads eliminate subtrees side by side and large fronts in tiles. Both are cut by the amount of work and not by
//! the number of threads, so that bits repeat. Nothing outside this folder knows how a factor is stored.

mod analysis;
mod cholesky;
mod diagonal;
mod elimination;
mod entry;
mod exact_residual;
mod indefinite;
mod matrix;
mod multifrontal;
mod panels;
mod prefetch;
mod refined;
mod rounding;
mod rows;
mod solve;
mod sturm_count;
mod substitution;
mod without_energy;

pub use analysis::Analysis;
pub use cholesky::Cholesky;
pub use indefinite::{WholeCount, whole_count};
pub use refined::Refinement;
pub use rounding::forming_error;
pub use solve::SolveOperator;
pub(crate) use sturm_count::boundary_of;
pub use sturm_count::{
    CONDENSED_GAP, InertiaCount, ShiftedFactor, condensed, count_below, count_below_freeing, count_negative,
    few_digits, rank,
};
pub use without_energy::without_energy;

/// How the entries of a Cholesky factor are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// As they are computed, in eight bytes.
    Double,
    /// Rounded to four bytes; conjugate gradients make solves as accurate as in double precision.
    Single,
}
