//! Rigid-body modes: every motion of the component that stores no energy.
//!
//! ```text
//! U    n' × n_r    K U = 0; for one free body the six unit motions, translations first, rotations about the origin
//! Q    n' × n_r    spans the space of U with QᵀMQ = I, used to deflate
//! ```
//!
//! A preloaded body moves freely where that turns no internal force: its translations, and the rotation about the line of all of its
//! forces where they have one direction. U spans those.
//!
//! Where coordinates are known, rigid-body modes come from them and are verified against K. Otherwise they come from the
//! matrices, by inverse iteration. Their number is never assumed: it is the number of motions without energy that K has.

mod algebraic;
mod confirmed_rank;
mod energy;
mod facts;
mod geometric;
mod of_partition;
mod passing;
mod preload;
mod rank;
mod residual;
mod rigid_body_modes;
mod rounding;
mod shift;

pub use algebraic::from_matrices;
pub(crate) use algebraic::{
    ZeroModes, bar_of_digits, found_zero_modes, is_uncounted, lost_interface, refuse_uncounted, zero_modes,
};
pub use confirmed_rank::confirmed_rank;
pub(crate) use energy::{noise_of_digits, shown_below_zero, zero_energy};
pub use facts::facts;
pub(crate) use geometric::{moving_directions, settled};
pub use of_partition::{counted_by_matrices, from_coordinates, rigid_body_modes};
pub use passing::with_passing;
pub(crate) use passing::{n_moving_less, n_passing, passing_motions, that_pass};
pub use rank::{ILL_CONDITIONED, InterfaceRank, interface_rank, or_lack_of_rank, rank_of_every};
pub(crate) use rank::{scales, unit_motions};
pub(crate) use residual::FORCE_ASKED;
pub use rigid_body_modes::{RigidBodyModes, RigidEnergy, RigidSource};
pub(crate) use rounding::residual_of;
pub use shift::shift_of_factor;
