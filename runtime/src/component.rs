//! The modal component: a superelement in large motion with small deformation.
//!
//! | symbol | meaning | shape |
//! |---|---|---|
//! | k, n_η, r = 6k + n_η | interface nodes, modal amplitudes, coordinates | |
//! | H_j, H_F | changes of configuration of node j and of the floating frame | [`Motion`](crate::motion::Motion) |
//! | v, v̇ | (V_1, …, V_k, η̇): material velocities and accelerations, then rates of the amplitudes | r |
//! | e = (E_1, …, E_k, η) | deformation measure, E_j = P(H_F⁻¹H_j) | r |
//! | J, F, U | Δe = J Δu − F ΔU_F; J = I and F = U = [I; …; I; 0] without deformation | r × r, r × 6 |
//! | Y, S, Q | Yᵀe = 0 defines the floating frame; S = (YᵀF)⁻¹, ΔU_F = Q Δu with Q = S YᵀJ | r × 6, 6 × 6, 6 × r |
//! | J P_⊥ = J − F Q | Δe = J P_⊥ Δu | r × r |
//!
//! The coordinates of forces and matrices are material: of node j the increment ΔU_j with dH_j = H_j ΔŨ_j. H_j maps the
//! reference configuration, so that its translation part belongs to the material point at the inertial origin and a force
//! f on node j at x_j is (Rᵀf; x̃_j Rᵀf + Rᵀm). A superelement file holds displacements and rotations of the nodes in the
//! inertial frame, whatever the axes of its interface frames; the component changes them once, when it is made.
//!
//! # Coordinates at the nodes
//!
//! A multibody program may want the velocities of its nodes instead of those at the inertial origin:
//! [`velocities_to_origin`](ModalComponent::velocities_to_origin) takes them in,
//! [`forces_to_nodes`](ModalComponent::forces_to_nodes) and [`matrix_to_nodes`](ModalComponent::matrix_to_nodes) bring forces
//! and tangents back.
//!
//! # What a component leaves out
//!
//! Deformation is linear in the floating frame. Two effects are therefore absent, from forces and from every tangent:
//!
//! - the stiffness does not depend on the stress: no stress stiffening inside a component, neither that of a blade by its
//!   centrifugal force nor the buckling of a column by its load;
//! - the inertia is that of the undeformed component: centrifugal forces do not grow with the deformation, and are
//!   distributed over it as those of a rigid acceleration.
//!
//! Between components both effects are present, because large motion is exact. Divide a slender part that turns fast or
//! carries a large load into several components: the error falls with the square of their size.
//!
//! Source: paper, section 4. Its inertial forces (85) lack J⁻¹, and those of its table 1 lack Qᵀ M_F Q. Both are complete
//! here, so that forces are those of a Lagrangian for any choice of Y.

mod acts_on;
mod at_nodes;
#[cfg(feature = "std")]
mod batch;
mod construction;
mod damping;
mod dense;
mod elastic;
mod error;
mod evaluation;
mod exact;
mod floating_frame;
mod frame_condition;
mod gravity;
mod gyroscopic;
mod identity;
mod inertial;
mod load_map;
mod load_vectors;
mod loads;
mod measures;
mod modal_component;
mod place_terms;
mod projection;
mod recovery;
mod recovery_map;
mod rows;
mod state;
mod tangents;
mod weight;
mod workspace;

#[cfg(feature = "std")]
pub use batch::{BatchError, Evaluation, evaluate_all, exact_tangents_all, tangents_all};
pub use error::{ComponentError, EvaluationError};
pub use frame_condition::FloatingFrame;
pub use loads::DeadLoad;
pub use measures::Measures;
pub use modal_component::ModalComponent;
pub use recovery::RecoveredNode;
pub use state::State;
pub use workspace::Workspace;
