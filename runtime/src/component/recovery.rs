//! Displacements inside the component, in inertial axes.
//!
//! The recovery rows are applied to the deformation, d = Ψ A e, and the floating frame carries the node along:
//! x = R_F (x₀ + d) + u_F, with the rotation R_F exp(θ̃_d). To first order in the deformation it is the linear recovery.

use super::error::EvaluationError;
use super::modal_component::ModalComponent;
use super::workspace::Workspace;
use super::workspace::check_finite;
use crate::motion::{Matrix3, Motion, Vector3, join, multiply_3};

/// Where a node inside the component has gone.
///
/// Its memory is twelve doubles in this order, for programs in other languages.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecoveredNode {
    /// Displacement, in inertial axes.
    pub displacement: Vector3,
    /// Rotation: that of the floating frame where the file recovers no rotation of the node.
    pub rotation: Matrix3,
}

impl ModalComponent {
    /// Labels of the nodes that the file recovers, in the order of their first rows; empty where it recovers none.
    pub fn recovered_labels(&self) -> &[i64] {
        self.recovery.as_ref().map_or(&[], |recovery| &recovery.labels)
    }

    /// Displacements and rotations of the recovered nodes in the state last evaluated in `workspace`, in the order of
    /// [`recovered_labels`](Self::recovered_labels).
    ///
    /// `positions` are those of the nodes in the reference configuration, which the file does not hold. It allocates nothing
    /// and costs O(rows · r).
    ///
    /// # Errors
    ///
    /// [`EvaluationError::ForeignWorkspace`]; [`EvaluationError::NoState`] after an evaluation that failed;
    /// [`EvaluationError::WrongLength`]; [`EvaluationError::NotFinite`] for `positions`; [`EvaluationError::Overflow`];
    /// [`EvaluationError::IncompleteRecovery`] where the file recovers only some of the
    /// three translations of a node, or only some of its rotations: they cannot be turned with the floating frame. The tool
    /// writes the directions that a node of the model has, which may be fewer: one such node makes this function refuse
    /// the file as a whole, and the job must leave it out of `recovery`.
    pub fn recover(
        &self,
        workspace: &Workspace,
        positions: &[Vector3],
        nodes: &mut [RecoveredNode],
    ) -> Result<(), EvaluationError> {
        workspace.check_component(self)?;
        workspace.check_state()?;
        let expected = self.recovered_labels().len();
        for (what, found) in [("positions of recovered nodes", positions.len()), ("recovered nodes", nodes.len())] {
            if found != expected {
                return Err(EvaluationError::WrongLength { what, found, expected });
            }
        }
        if let Some(index) = positions.as_flattened().iter().position(|value| !value.is_finite()) {
            return Err(EvaluationError::NotFinite { what: "positions of recovered nodes", index });
        }
        let Some(recovery) = &self.recovery else {
            return Ok(());
        };
        let (frame, e) = (&workspace.floating_frame, workspace.deformation());
        for ((place, position), node) in positions.iter().enumerate().zip(nodes) {
            let incomplete = || EvaluationError::IncompleteRecovery { label: recovery.labels[place] };
            let [d, theta] = recovery.deformation(place, e);
            let d = d.ok_or_else(incomplete)?;
            let n_rotations = recovery.directions[place][3..].iter().flatten().count();
            if theta.is_none() && n_rotations > 0 {
                return Err(incomplete());
            }
            let moved = frame.apply(&core::array::from_fn(|i| position[i] + d[i]));
            let turn = Motion::exp(&join(&[0.0; 3], &theta.unwrap_or_default())).rotation;
            node.displacement = core::array::from_fn(|i| moved[i] - position[i]);
            node.rotation = multiply_3(&frame.rotation, &turn);
            check_finite([("displacements of recovered nodes", &node.displacement)])?;
        }
        Ok(())
    }
}
