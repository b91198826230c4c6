//! The modal component: a superelement in large motion with small deformation.
//!
//! | symbol | meaning | shape |
//! |---|---|---|
//! | k, n_η, r = 6k + n_η | interface nodes, modal amplitudes, coordinates | |
//! | H_j, H_F | changes of configuration of node j and of the floating frame | [`Motion`] |
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

mod at_nodes;
#[cfg(feature = "std")]
mod batch;
mod construction;
mod damping;
mod dense;
mod elastic;
mod error;
mod exact;
mod floating_frame;
mod gravity;
mod gyroscopic;
mod identity;
mod inertial;
mod loads;
mod measures;
mod projection;
mod recovery;
mod rows;
mod tangents;
mod workspace;

#[cfg(feature = "std")]
pub use batch::{BatchError, Evaluation, evaluate_all, exact_tangents_all, tangents_all};
pub use error::{ComponentError, EvaluationError};
pub use loads::DeadLoad;
pub use recovery::RecoveredNode;
pub use workspace::Workspace;

use alloc::vec::Vec;

use crate::metadata::InterfaceDof;
use crate::motion::{Matrix6, Motion, Vector3, Vector6};
use construction::Matrices;
use floating_frame::FrameRounding;
use gravity::Weight;
use identity::Identity;
use projection::ActsOn;
use recovery::RecoveryMap;

/// Which condition Yᵀe = 0 defines the floating frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FloatingFrame {
    /// Y = M̂Û: the deformation has no momentum in the floating frame; the paper's choice, eq. (25).
    MassWeighted,
    /// Y = Û: the deformation measures of the nodes have no mean. It needs no mass and does not depend on the mesh.
    Rigid,
}

/// How the deformation of an interface node is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measures {
    /// Motion parameters of the node relative to the floating frame, eq. (63).
    MotionBased,
    /// Displacement and skew part of the rotation in the floating frame, eq. (90); for comparison.
    Classical,
}

/// State of a component: what an evaluation needs to know.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// Changes of configuration of the k interface nodes.
    pub motions: &'a [Motion],
    /// Modal amplitudes η, n_η.
    pub amplitudes: &'a [f64],
    /// Material velocities of the nodes, then η̇: 6k + n_η.
    pub velocities: &'a [f64],
    /// Material accelerations of the nodes, then η̈: 6k + n_η.
    pub accelerations: &'a [f64],
}

/// A superelement in large motion; see the [module page](self).
///
/// It cannot be changed: threads may share it, each with a [`Workspace`] of its own.
#[derive(Clone, Debug)]
pub struct ModalComponent {
    identity: Identity,
    measures: Measures,
    positions: Vec<Vector3>,
    n_modal: usize,
    /// In the coordinates of the nodes; also in those of the measures where these are motion-based.
    nodal: Matrices,
    /// In the coordinates of the classical measures.
    measured: Option<Matrices>,
    /// Columns of U at each node, in the coordinates of the measures.
    rigid: Vec<Matrix6>,
    /// M U, one row of six for each coordinate.
    momenta: Vec<Vector6>,
    /// M_F = UᵀMU.
    rigid_mass: Matrix6,
    /// Y, scaled so that YᵀU = I.
    frame: Vec<Vector6>,
    frame_rounding: FrameRounding,
    /// Loads of unit gravity, one row of three for each coordinate.
    gravity: Vec<Vector3>,
    /// Mass and moment of mass that these loads are the weight of.
    weight: Option<Weight>,
    damping_is_symmetric: bool,
    damping_acts_on: ActsOn,
    unloaded: Vec<InterfaceDof>,
    recovery: Option<RecoveryMap>,
    rigid_motion_residual: f64,
}

impl ModalComponent {
    /// Measures of deformation.
    pub fn measures(&self) -> Measures {
        self.measures
    }

    /// Number of interface nodes k.
    pub fn n_nodes(&self) -> usize {
        self.positions.len()
    }

    /// Number of modal amplitudes n_η.
    pub fn n_modal(&self) -> usize {
        self.n_modal
    }

    /// Number of coordinates r = 6k + n_η.
    pub fn n_coordinates(&self) -> usize {
        6 * self.n_nodes() + self.n_modal
    }

    /// Positions of the k interface nodes in the reference configuration.
    pub fn positions(&self) -> &[Vector3] {
        &self.positions
    }

    /// Stiffness without deformation, r × r, row by row: the constant matrix for small deformation, eq. (82) at e = 0.
    pub fn reference_stiffness(&self) -> &[f64] {
        &self.nodal.stiffness
    }

    /// Mass without deformation, r × r, row by row: the constant matrix for small deformation.
    pub fn reference_mass(&self) -> &[f64] {
        &self.nodal.mass
    }

    /// Damping without deformation, r × r, row by row; none where the file has none.
    pub fn reference_damping(&self) -> Option<&[f64]> {
        self.nodal.damping.as_deref()
    }

    /// Rigid-body mass M_F = UᵀM̂U about the inertial origin.
    pub fn rigid_mass(&self) -> &Matrix6 {
        &self.rigid_mass
    }

    /// Largest force that a rigid-body motion makes, relative to the sum of the magnitudes of its parts and of its inertia in the
    /// first mode.
    pub fn rigid_motion_residual(&self) -> f64 {
        self.rigid_motion_residual
    }

    /// Room for the evaluations of this component, holding those of the reference configuration at rest.
    pub fn workspace(&self) -> Workspace {
        Workspace::new(self)
    }

    /// Floating frame, deformation, elastic, inertial and damping forces and energies of a state.
    ///
    /// It allocates nothing and costs O(r²).
    ///
    /// # Errors
    ///
    /// [`EvaluationError`]: arguments of wrong length, not finite or no rotations; a workspace of another component; a node half a turn from the floating frame; a floating frame that the nodes do not determine; results beyond
    /// the range of numbers.
    ///
    /// Source: paper, eqs. (63), (76), (81), and (85) with J⁻¹.
    pub fn evaluate(&self, state: &State<'_>, workspace: &mut Workspace) -> Result<(), EvaluationError> {
        self.kinematics(state, workspace)?;
        self.elastic_forces(workspace);
        self.inertial_forces(state, workspace);
        self.damping_forces(workspace);
        workspace.results.check_forces()?;
        workspace.has_state = true;
        Ok(())
    }

    /// Stiffness, mass, gyroscopic and damping matrix of a state.
    ///
    /// It allocates nothing and costs O((k + 1) r²); the accelerations of the state do not enter.
    ///
    /// # Errors
    ///
    /// The errors of [`evaluate`](Self::evaluate).
    ///
    /// Source: paper, eqs. (82), (84), (87).
    pub fn tangents(&self, state: &State<'_>, workspace: &mut Workspace) -> Result<(), EvaluationError> {
        self.kinematics(state, workspace)?;
        self.tangent_matrices(state, workspace);
        workspace.results.check_tangents()?;
        workspace.has_state = true;
        Ok(())
    }

    /// Forces, tangents and the exact stiffness of a state: the derivatives of
    /// f = f_E + f_I + f_D by the place ([`exact_stiffness`](Workspace::exact_stiffness)), by the velocities
    /// ([`gyroscopic`](Workspace::gyroscopic) and [`damping`](Workspace::damping)) and by the accelerations
    /// ([`mass`](Workspace::mass)). It does what [`evaluate`](Self::evaluate) and [`tangents`](Self::tangents) do, too.
    ///
    /// It allocates nothing and costs O((k + 1) r²), some one and a half times [`tangents`](Self::tangents).
    ///
    /// With K, G, C and M these derivatives, δ the increments of the coordinates and v̂ the operator (54) of each node's
    /// velocity, zero for the amplitudes, small motion about a motion v(t) is
    ///
    /// M δ̈ + (G + C + M v̂) δ̇ + (K + (G + C) v̂ + M v̇^) δ = 0,
    ///
    /// because v changes by δ̇ + v̂ δ. Loads add their own stiffness ([`add_load_stiffness`](Self::add_load_stiffness),
    /// [`add_gravity_stiffness`](Self::add_gravity_stiffness)).
    ///
    /// Newton's method with it converges quadratically once it is close. Far from the solution K_T is safer, because it has no
    /// negative directions.
    ///
    /// Exact is the derivative of the component's forces, which are linear in the deformation: a component has no stress
    /// stiffening inside; see the [module page](self#what-a-component-leaves-out).
    ///
    /// # Errors
    ///
    /// The errors of [`evaluate`](Self::evaluate).
    pub fn exact_tangents(&self, state: &State<'_>, workspace: &mut Workspace) -> Result<(), EvaluationError> {
        self.evaluate(state, workspace)?;
        workspace.has_state = false;
        self.tangent_matrices(state, workspace);
        self.exact_stiffness_matrix(state, workspace);
        workspace.results.check_tangents()?;
        workspace.results.check_exact_stiffness()?;
        workspace.has_state = true;
        Ok(())
    }

    /// Matrices in the coordinates of the measures.
    fn matrices(&self) -> &Matrices {
        self.measured.as_ref().unwrap_or(&self.nodal)
    }
}
