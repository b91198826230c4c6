//! The evaluations of a state: forces, tangents, and both with the exact stiffness.

use super::damping::damping_forces;
use super::elastic::elastic_forces;
use super::error::EvaluationError;
use super::exact::exact_stiffness_matrix;
use super::floating_frame::{kinematics, project_frame};
use super::inertial::inertial_forces;
use super::modal_component::ModalComponent;
use super::state::State;
use super::tangents::tangent_matrices;
use super::workspace::Workspace;

impl ModalComponent {
    /// Room for the evaluations of this component, holding those of the reference configuration at rest.
    pub fn workspace(&self) -> Workspace {
        let mut workspace = Workspace::new(self);
        project_frame(self, &mut workspace);
        workspace
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
        kinematics(self, state, workspace)?;
        elastic_forces(self, workspace);
        inertial_forces(self, state, workspace);
        damping_forces(self, workspace);
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
        kinematics(self, state, workspace)?;
        tangent_matrices(self, state, workspace);
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
    /// stiffening inside; see the [module page](super#what-a-component-leaves-out).
    ///
    /// # Errors
    ///
    /// The errors of [`evaluate`](Self::evaluate).
    pub fn exact_tangents(&self, state: &State<'_>, workspace: &mut Workspace) -> Result<(), EvaluationError> {
        self.evaluate(state, workspace)?;
        workspace.has_state = false;
        tangent_matrices(self, state, workspace);
        exact_stiffness_matrix(self, state, workspace);
        workspace.results.check_tangents()?;
        workspace.results.check_exact_stiffness()?;
        workspace.has_state = true;
        Ok(())
    }
}
