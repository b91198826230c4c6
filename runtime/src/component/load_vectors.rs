//! Forces of the loads that the file carries, and their stiffness.
//!
//! A load ℓ of the file, r values in the coordinates of the measures, acts in the floating frame and turns with it: a follower load, as
//! the thrust of an engine, a pressure or the pull of a spring inside is. It does the work ℓᵀ(Δe + U ΔU_F), as forces on the finite
//! element model do, with the deformation linear and lever arms those of the undeformed component, as inertial forces have them; with
//! Δe = J P_⊥ Δu and ΔU_F = Q Δu and an amplitude a
//!
//! | | |
//! |---|---|
//! | forces | f = a [(J P_⊥)ᵀ ℓ + Qᵀ Uᵀℓ] = Jᵀh |
//! | their stiffness −∂f | −[(∂J)ᵀh − Qᵀ(∂F)ᵀh] |
//!
//! In the floating frame nothing of it changes, so that the stiffness is that of the change of J and F alone. It is not symmetric: a
//! follower load has no potential. A load that keeps its direction in space is a [`DeadLoad`](super::DeadLoad) on an interface node, or
//! [`gravity_forces`](ModalComponent::gravity_forces).

use alloc::string::String;

use super::acts_on::ActsOn;
use super::dense;
use super::error::EvaluationError;
use super::modal_component::ModalComponent;
use super::projection::Projector;
use super::rows::{add_by_place, subtract_frame_rows};
use super::workspace::{Scratch, Workspace, check_finite, check_result};
use crate::motion::{Vector6, times_6, transposed_times_6};

impl ModalComponent {
    /// Names of the loads that the file carries, in their order.
    pub fn load_names(&self) -> &[String] {
        &self.loads.names
    }

    /// Forces on the coordinates (r) of load number `load` of the file, from 0, with an amplitude, in the state that was last evaluated
    /// in the workspace. The load turns with the floating frame.
    ///
    /// In the reference configuration they are the amplitude times the column of the file's `load_vectors`. Amplitudes have the unit
    /// that is left of a force by what the column is for: one for a load in newtons, ω² for a centrifugal load. The inertial forces of
    /// a component that turns have the resultant of its centrifugal load already. It allocates nothing.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownLoad`]; [`EvaluationError::ForeignWorkspace`]; [`EvaluationError::NoState`] after an evaluation that
    /// failed; [`EvaluationError::NotFinite`] for `amplitude`; [`EvaluationError::Overflow`].
    pub fn load_vector_forces<'w>(
        &self,
        load: usize,
        amplitude: f64,
        workspace: &'w mut Workspace,
    ) -> Result<&'w [f64], EvaluationError> {
        self.project_load_vector(load, amplitude, workspace)?;
        check_finite([("forces of a load", &workspace.results.load_vector)])?;
        Ok(&workspace.results.load_vector)
    }

    /// Adds the stiffness −∂f/∂U of [`load_vector_forces`](Self::load_vector_forces) to `stiffness` (r × r, row by row), in the state that
    /// was last evaluated in the workspace. It allocates nothing.
    ///
    /// # Errors
    ///
    /// The errors of [`load_vector_forces`](Self::load_vector_forces); [`EvaluationError::WrongLength`] for `stiffness`.
    pub fn add_load_vector_stiffness(
        &self,
        load: usize,
        amplitude: f64,
        workspace: &mut Workspace,
        stiffness: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let r = self.n_coordinates();
        check_result(stiffness.len(), r * r)?;
        let on_frame = self.project_load_vector(load, amplitude, workspace)?;
        let y = times_6(&dense::transposed(&workspace.s), &on_frame);
        let Workspace { nodes, q, product, scratch, .. } = workspace;
        let Scratch { square, wide: [wide_q, _, _, frame_rows], .. } = scratch;
        dense::transpose(q, wide_q);
        // ∂f.
        square.fill(0.0);
        frame_rows.fill(0.0);
        add_by_place(self, &Projector { nodes, q }, (product, &y), wide_q, square, frame_rows);
        subtract_frame_rows(q, frame_rows, square);
        check_finite([("stiffness of a load", square)])?;
        dense::add_scaled(stiffness, -1.0, square);
        Ok(())
    }

    /// The forces, with a ℓ in the place of the product; what the floating frame has of them is returned.
    fn project_load_vector(
        &self,
        load: usize,
        amplitude: f64,
        workspace: &mut Workspace,
    ) -> Result<Vector6, EvaluationError> {
        workspace.check_component(self)?;
        workspace.check_state()?;
        let n_loads = self.loads.names.len();
        if load >= n_loads {
            return Err(EvaluationError::UnknownLoad { load, n_loads });
        }
        if !amplitude.is_finite() {
            return Err(EvaluationError::NotFinite { what: "amplitude", index: 0 });
        }
        let r = self.n_coordinates();
        let Workspace { nodes, q, product, results, .. } = workspace;
        let vector = &self.loads.values[load * r..(load + 1) * r];
        product.iter_mut().zip(vector).for_each(|(force, value)| *force = amplitude * value);
        let mut reaction = [0.0; 6];
        for (rigid, force) in self.rigid.iter().zip(product.as_chunks::<6>().0) {
            reaction = dense::plus_scaled(&reaction, -1.0, &transposed_times_6(rigid, force));
        }
        let projector = Projector { nodes, q };
        Ok(projector.project(product, &reaction, ActsOn::Deformation, &mut results.load_vector))
    }
}
