//! Loads on interface nodes that keep their direction in space.

use super::error::EvaluationError;
use super::floating_frame::check_motions;
use super::modal_component::ModalComponent;
use super::workspace::{check_finite, check_result};
use crate::metadata::InterfaceDof;
use crate::motion::{
    Matrix3, Matrix6, Motion, Vector3, Vector6, ZERO_3, blocks, force_to_origin, join, multiply_3, skew,
    transposed_times_3,
};

/// A load that should have no component along a dof has one of rounding, 1e-16 and the drift of the rotation; moments also that
/// of the lever arms of their forces.
const ALONG_THE_OTHERS: f64 = 1e-9;

/// A force and a moment on an interface node, constant in inertial axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeadLoad {
    /// Number of the interface node, from 0.
    pub node: usize,
    /// Force at the node, in inertial axes.
    pub force: Vector3,
    /// Moment, in inertial axes.
    pub moment: Vector3,
}

impl DeadLoad {
    /// The load on the coordinates of its node, (Rᵀf; x̃Rᵀf + Rᵀm) at the material point x of the node.
    pub fn in_node(&self, motion: &Motion, position: &Vector3) -> Vector6 {
        let force = transposed_times_3(&motion.rotation, &self.force);
        let moment = transposed_times_3(&motion.rotation, &self.moment);
        force_to_origin(position, &join(&force, &moment))
    }

    /// Load stiffness, −∂f_U/∂U of [`in_node`](Self::in_node): [0, −ã; 0, −(x̃ã + b̃)] with a = Rᵀf, b = Rᵀm. It is added to the
    /// tangent stiffness of the component.
    pub fn stiffness_in_node(&self, motion: &Motion, position: &Vector3) -> Matrix6 {
        let force = skew(&transposed_times_3(&motion.rotation, &self.force));
        let moment = skew(&transposed_times_3(&motion.rotation, &self.moment));
        let lever = multiply_3(&skew(position), &force);
        let lower: Matrix3 = core::array::from_fn(|i| core::array::from_fn(|j| -(lever[i][j] + moment[i][j])));
        blocks(&ZERO_3, &force.map(|row| row.map(|x| -x)), &ZERO_3, &lower)
    }
}

impl ModalComponent {
    /// Adds the load to `forces` (r), for nodes at `motions` (k).
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownNode`], [`EvaluationError::WrongLength`], [`EvaluationError::NotRotation`],
    /// [`EvaluationError::NotFinite`]; [`EvaluationError::Overflow`]; [`EvaluationError::UnloadedDof`] for a load along a dof of which the file says that
    /// none acts.
    pub fn add_load(&self, load: &DeadLoad, motions: &[Motion], forces: &mut [f64]) -> Result<(), EvaluationError> {
        self.check_load(load, motions, forces.len(), self.n_coordinates())?;
        let f = load.in_node(&motions[load.node], &self.positions[load.node]);
        check_finite([("load at the origin", &f)])?;
        for (sum, value) in forces[6 * load.node..].iter_mut().zip(f) {
            *sum += value;
        }
        Ok(())
    }

    /// Adds the load stiffness to `stiffness` (r × r, row by row), for nodes at `motions` (k).
    ///
    /// # Errors
    ///
    /// The errors of [`add_load`](Self::add_load).
    pub fn add_load_stiffness(
        &self,
        load: &DeadLoad,
        motions: &[Motion],
        stiffness: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let r = self.n_coordinates();
        self.check_load(load, motions, stiffness.len(), r * r)?;
        let first = 6 * load.node;
        let block = load.stiffness_in_node(&motions[load.node], &self.positions[load.node]);
        check_finite([("load stiffness", block.as_flattened())])?;
        for (row, block_row) in stiffness.chunks_exact_mut(r).skip(first).zip(&block) {
            for (sum, value) in row[first..].iter_mut().zip(block_row) {
                *sum += value;
            }
        }
        Ok(())
    }

    fn check_load(
        &self,
        load: &DeadLoad,
        motions: &[Motion],
        found: usize,
        expected: usize,
    ) -> Result<(), EvaluationError> {
        if load.node >= self.n_nodes() {
            return Err(EvaluationError::UnknownNode { node: load.node, n_nodes: self.n_nodes() });
        }
        check_result(found, expected)?;
        for (what, values) in [("force", &load.force), ("moment", &load.moment)] {
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                return Err(EvaluationError::NotFinite { what, index });
            }
        }
        check_motions(self, motions)?;
        self.check_unloaded(load, &motions[load.node])
    }

    /// The axes of a declared dof turn with its node.
    fn check_unloaded(&self, load: &DeadLoad, motion: &Motion) -> Result<(), EvaluationError> {
        let in_node = join(
            &transposed_times_3(&motion.rotation, &load.force),
            &transposed_times_3(&motion.rotation, &load.moment),
        );
        for &InterfaceDof { node, direction } in self.validity.unloaded.iter().filter(|dof| dof.node == load.node) {
            let largest = |part: &[f64]| part.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            let (force, moment) = (largest(&in_node[..3]), largest(&in_node[3..]));
            let lever = self.frame_rounding.extent;
            let whole = if (direction as usize) < 3 { force } else { moment.max(force * lever) };
            if in_node[direction as usize].abs() > ALONG_THE_OTHERS * whole {
                return Err(EvaluationError::UnloadedDof { node, direction });
            }
        }
        Ok(())
    }
}
