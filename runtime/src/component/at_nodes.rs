//! Coordinates taken at the nodes, for programs whose velocities are those of the nodes.
//!
//! The coordinates of forces and matrices are those of the material points at the inertial origin, V = S v with v = (Rᵀẋ; ω) of
//! the node in its own axes and S = [I, x̃; 0, I]; modal amplitudes stay as they are. S is constant, so that accelerations and
//! increments change as velocities do. In the coordinates v "the node stays where it is" means "the first three are zero".

use super::error::EvaluationError;
use super::modal_component::ModalComponent;
use crate::motion::{Vector3, Vector6, cross, force_to_point, velocity_to_origin, velocity_to_point};

impl ModalComponent {
    /// S v in the place of v: velocities, accelerations or increments (r) of the component from those at its nodes.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::WrongLength`].
    pub fn velocities_to_origin(&self, velocities: &mut [f64]) -> Result<(), EvaluationError> {
        self.each_node(velocities, velocity_to_origin)
    }

    /// S⁻¹ V in the place of V: velocities, accelerations or increments (r) at the nodes from those of the component.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::WrongLength`].
    pub fn velocities_to_nodes(&self, velocities: &mut [f64]) -> Result<(), EvaluationError> {
        self.each_node(velocities, velocity_to_point)
    }

    /// Sᵀ f in the place of f: forces (r) with moments about the nodes.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::WrongLength`].
    pub fn forces_to_nodes(&self, forces: &mut [f64]) -> Result<(), EvaluationError> {
        self.each_node(forces, force_to_point)
    }

    /// SᵀA S in the place of A, r × r, row by row: any tangent matrix for coordinates at the nodes.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::WrongLength`].
    pub fn matrix_to_nodes(&self, matrix: &mut [f64]) -> Result<(), EvaluationError> {
        let r = self.n_coordinates();
        check_length("entries of the matrix", matrix.len(), r * r)?;
        for row in matrix.chunks_exact_mut(r) {
            self.forces_to_nodes(row)?;
        }
        for (position, rows) in self.positions.iter().zip(matrix.chunks_exact_mut(6 * r)) {
            let (forces, moments) = rows.split_at_mut(3 * r);
            for c in 0..r {
                let lever = cross(position, &[forces[c], forces[r + c], forces[2 * r + c]]);
                (0..3).for_each(|i| moments[i * r + c] -= lever[i]);
            }
        }
        Ok(())
    }

    fn each_node(
        &self,
        values: &mut [f64],
        change: impl Fn(&Vector3, &Vector6) -> Vector6,
    ) -> Result<(), EvaluationError> {
        check_length("values of coordinates", values.len(), self.n_coordinates())?;
        for (position, six) in self.positions.iter().zip(values.as_chunks_mut::<6>().0) {
            *six = change(position, six);
        }
        Ok(())
    }
}

fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), EvaluationError> {
    if found == expected { Ok(()) } else { Err(EvaluationError::WrongLength { what, found, expected }) }
}
