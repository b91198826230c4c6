//! Displacements inside the component, in inertial axes.
//!
//! The recovery rows are applied to the deformation, d = Ψ A e, and the floating frame carries the node along:
//! x = R_F (x₀ + d) + u_F, with the rotation R_F exp(θ̃_d). To first order in the deformation it is the linear recovery.

use super::error::EvaluationError;
use super::modal_component::ModalComponent;
use super::recovery_map::RecoveryMap;
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
    /// Labels of the nodes that [`recover`](Self::recover) moves, in the order of their first rows; empty where the file recovers none.
    /// They are those of which the file has all three translations, and all three rotations or none.
    pub fn recovered_labels(&self) -> &[i64] {
        self.recovery.as_ref().map_or(&[], |recovery| &recovery.labels)
    }

    /// Positions of these nodes in the reference configuration; none where the file does not have them.
    pub fn recovered_positions(&self) -> Option<&[Vector3]> {
        self.recovery.as_ref()?.positions.as_deref()
    }

    /// Labels of the nodes of which the file has only some translations or only some rotations: these cannot be turned with the floating
    /// frame, and no function moves them.
    pub fn incomplete_labels(&self) -> &[i64] {
        self.recovery.as_ref().map_or(&[], |recovery| &recovery.incomplete)
    }

    /// Displacements and rotations of the recovered nodes in the state last evaluated in `workspace`, in the order of
    /// [`recovered_labels`](Self::recovered_labels).
    ///
    /// `positions` are those of the nodes in the reference configuration: [`recovered_positions`](Self::recovered_positions), or the
    /// caller's own for a file that does not have them. It allocates nothing and costs O(rows · r).
    ///
    /// # Errors
    ///
    /// [`EvaluationError::ForeignWorkspace`]; [`EvaluationError::NoState`] after an evaluation that failed;
    /// [`EvaluationError::WrongLength`]; [`EvaluationError::NotFinite`] for `positions`; [`EvaluationError::Overflow`].
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
        for ((place, position), node) in positions.iter().enumerate().zip(nodes) {
            *node = moved(recovery, workspace, (place, position))?;
        }
        Ok(())
    }

    /// Displacement and rotation of one recovered node, by its label, in the state last evaluated in `workspace`.
    ///
    /// `position` is that of the node in the reference configuration. It allocates nothing and costs O(n + r) for n recovered nodes.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::IncompleteRecovery`] for one of [`incomplete_labels`](Self::incomplete_labels),
    /// [`EvaluationError::NotRecovered`] for a node that the file does not recover, and those of [`recover`](Self::recover).
    pub fn recover_node(
        &self,
        workspace: &Workspace,
        label: i64,
        position: &Vector3,
    ) -> Result<RecoveredNode, EvaluationError> {
        workspace.check_component(self)?;
        workspace.check_state()?;
        if let Some(index) = position.iter().position(|value| !value.is_finite()) {
            return Err(EvaluationError::NotFinite { what: "positions of recovered nodes", index });
        }
        let recovery = self.recovery.as_ref().ok_or(EvaluationError::NotRecovered { label })?;
        match recovery.labels.iter().position(|other| *other == label) {
            Some(place) => moved(recovery, workspace, (place, position)),
            None if recovery.incomplete.contains(&label) => Err(EvaluationError::IncompleteRecovery { label }),
            None => Err(EvaluationError::NotRecovered { label }),
        }
    }
}

/// x − x₀ and the rotation of the node at a place of the map, whose position is x₀.
fn moved(
    recovery: &RecoveryMap,
    workspace: &Workspace,
    (place, position): (usize, &Vector3),
) -> Result<RecoveredNode, EvaluationError> {
    let frame = &workspace.floating_frame;
    let (d, theta) = recovery.deformation(place, workspace.deformation());
    let moved = frame.apply(&core::array::from_fn(|i| position[i] + d[i]));
    let turn = Motion::exp(&join(&[0.0; 3], &theta.unwrap_or_default())).rotation;
    let displacement = core::array::from_fn(|i| moved[i] - position[i]);
    check_finite([("displacements of recovered nodes", &displacement)])?;
    Ok(RecoveredNode { displacement, rotation: multiply_3(&frame.rotation, &turn) })
}
