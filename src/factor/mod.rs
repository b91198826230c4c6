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

mod block_solve;
mod cholesky;
mod indefinite;
mod inertia;
mod memory;
mod pattern;
mod rounding;
mod solve;

use dyn_stack::MemBuffer;
use faer::dyn_stack::{self, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SymbolicSupernodalParams;
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_symbolic_cholesky, factorize_supernodal_symbolic_cholesky_scratch,
};

use crate::error::{Error, Result};
use crate::sparse::SparseMatrix;

pub use cholesky::Cholesky;
pub use indefinite::{WholeCount, whole_count};
pub use inertia::{InertiaCount, ShiftedFactor, count_below, count_negative, rank};
pub use memory::refuse_beyond_memory;
pub use rounding::forming_error;
pub use solve::SolveOperator;

use pattern::{Part, Triangle};

/// A symmetric pencil in its order of elimination: K and M of one size, whose combinations K − σM are factored.
#[derive(Clone, Copy, Debug)]
pub struct Pencil<'a> {
    /// K, n × n.
    pub stiffness: &'a SparseMatrix,
    /// M, n × n.
    pub mass: &'a SparseMatrix,
}

/// The symbolic factorisation of a pencil: structure, work and memory, before any number is computed.
#[derive(Debug)]
pub struct Analysis {
    symbolic: SymbolicSupernodalCholesky<usize>,
    n: usize,
    /// Entries of the factor, without the zeros that supernodes add.
    pub nnz_factor: f64,
    /// Floating-point operations of one factorisation.
    pub flops: f64,
}

impl Analysis {
    /// Analyses the pattern of K ∪ M.
    ///
    /// # Errors
    /// The factor has more entries than can be counted, or there is no memory for its structure.
    pub fn new(pencil: Pencil<'_>) -> Result<Self> {
        let n = pencil.stiffness.rows();
        let upper = Triangle::pattern(pencil, Part::UpToDiagonal);
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &upper.pointers, None, &upper.indices);
        let mut tree = vec![0isize; n];
        let mut column_counts = vec![0usize; n];
        let scratch = prefactorize_symbolic_cholesky_scratch::<usize>(n, upper.indices.len())
            .or(factorize_supernodal_symbolic_cholesky_scratch::<usize>(n));
        let mut memory =
            MemBuffer::try_new(scratch).map_err(|_| Error::OutOfMemory { what: "the symbolic factorisation" })?;
        let stack = MemStack::new(&mut memory);
        let tree = prefactorize_symbolic_cholesky(&mut tree, &mut column_counts, pattern, stack);
        let symbolic = factorize_supernodal_symbolic_cholesky(
            pattern,
            tree,
            &column_counts,
            stack,
            SymbolicSupernodalParams { relax: None },
        )
        .map_err(|_| Error::OutOfMemory { what: "the structure of the factor" })?;
        let nnz_factor = column_counts.iter().map(|count| *count as f64).sum();
        let flops = column_counts.iter().map(|count| (*count as f64).powi(2)).sum();
        Ok(Self { symbolic, n, nnz_factor, flops })
    }

    /// Order of the matrix.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Bytes that one factor takes, with the zeros that supernodes add.
    pub fn factor_bytes(&self) -> u64 {
        8 * self.symbolic.len_val() as u64
    }
}
