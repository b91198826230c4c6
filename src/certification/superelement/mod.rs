//! A superelement of another program with its basis, held against K and M.
//!
//! ```text
//! Ψ        n' × r     its basis, on the dofs of the partition
//! K̂, M̂     r × r      its matrices, as they are in their files
//! K̃, M̃     r × r      ΨᵀKΨ and ΨᵀMΨ, what they have to be
//! Q        r × n_r    rigid-body motion in its coordinates: the least ‖U − ΨQ‖ in M
//! ```
//! Nothing is assumed of how it was made. A coordinate that is the only one to move some row, and moves it by one, is that row: rows of
//! this kind are its interface, and what the simulation feels there is compared as in a reduction of our own.

mod checks;
mod compared;
mod dependence;
mod files;
mod foreign;
mod interface;
mod judged;
mod left_out;
mod named_rows;
mod pairing;
mod preserved;
mod turned_nodes;
mod zero_motions;

pub use files::{ForeignSuperelement, ReducedFiles, ReducedMatrix};
pub use foreign::Foreign;
pub use interface::{Interface, interface};
pub use judged::{FreeComparison, ReducedCertification, compared_free};
pub use left_out::{LeftOut, Own, left_out};
pub use preserved::preserved;
pub use turned_nodes::Placed;
