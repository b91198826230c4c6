//! Constraint modes, and what they show: mechanisms, and an operator of the free component at shift zero.
//!
//! ```text
//! Ψ_S   n_I × n_B   −K_II⁻¹ K_IB, corrected so that they carry rigid-body motion exactly (24)
//! S     n_B × n_B   K_BB + K_BI Ψ_S = K̂_BB, formed once; its null space is U_B and the motions of mechanisms
//! K⁺    n' × n'     of self-equilibrated loads, from the factor of K_II and S
//! ```

mod attached;
mod attachment;
mod constrained;
mod constraint_modes;
mod free_at_zero;
mod free_statics;
mod interior;
mod mechanism;
mod negative;
mod rigid_correction;
mod schur_complement;
mod static_modes;

pub use attachment::Attachment;
pub use constrained::{Constrained, constrained};
pub use constraint_modes::{ConstraintModes, constraint_modes, constraint_modes_in};
pub use free_at_zero::{FreeAtZero, RefinedAtZero};
pub use free_statics::FreeStatics;
pub use interior::interior_factor;
pub use mechanism::{Loose, LooseMotions, with_mechanisms};
pub use negative::n_negative;
pub(crate) use rigid_correction::left_inverse;
pub use rigid_correction::{Carried, RigidError, rigid_error};
pub use static_modes::StaticModes;
