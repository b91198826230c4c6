//! Measures of the deformation of one interface node and their derivatives, eqs. (63), (64) and (90), (91).
//!
//! | symbol | meaning | shape |
//! |---|---|---|
//! | H_E = H_F⁻¹H_j = (R, u) | motion of the node seen from the floating frame | |
//! | E | measure of it: P(H_E), or (d; κ) with d = R x + u − x and κ̃ = (R − Rᵀ)/2 for a node at x | 6 |
//! | J, F | ΔE = J ΔU_j − F ΔU_F; with J = T⁻¹(E), F = T⁻¹(−E) = J − Ê for motion parameters | 6 × 6 |
//! | y = J̇ V − Ḟ V_F | part of Ë that does not come from accelerations | 6 |
//!
//! *By the velocities* a derivative is taken at a fixed place, *by the place* at fixed velocities.

mod choice;
mod classical;
mod motion_based;
mod node;

pub use choice::Measures;
pub(super) use node::{NodeMeasure, NodeRates, PlaceMatrices};
