//! The basis: Ψ = [I 0; Ψ_S Ψ_D] of equation (18).
//!
//! ```text
//! Ψ_S   n_I × n_B   constraint modes −K_II⁻¹ K_IB, corrected so that they carry rigid-body motion exactly (24)
//! Ψ_D   n_I × n_η   dynamic modes: inertia-relief modes (37), fixed-interface modes (38) or mode-accelerated ones (23),
//!                   computed or of a file; after them residual vectors of loads
//! ```
//! Where K_II is singular, Rubin's method has the static modes A_I A_B⁻¹ (41) in the place of constraint modes, and rigid-body modes among
//! the dynamic ones.
//! The reduction method decided which modes were chosen. From here on every method has this one form.

mod attached;
#[expect(clippy::module_inception, reason = "the basis is what the folder makes")]
mod basis;
mod dynamic;
mod orthonormal;
mod residual_vectors;
mod retained_columns;
mod rounding;

pub use basis::Basis;
pub use dynamic::{DroppedColumn, DynamicCoordinate};
pub use dynamic::{DynamicColumns, accelerated_columns, expansion_columns, inertia_relief_columns, modal_columns};
pub(crate) use residual_vectors::ANSWERED;
pub use residual_vectors::static_answers;
pub use retained_columns::retained_columns;
pub(crate) use rounding::INDEPENDENT;
pub(crate) use rounding::clear_unloaded;
