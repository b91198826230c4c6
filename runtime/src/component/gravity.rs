//! Forces of a uniform gravity field, their potential and their stiffness.
//!
//! With the field a = R_Fᵀg in the floating frame and the loads Ĝ of a unit field (r × 3), the moment of mass that the
//! deformation moves is s = Ĝᵀe. UᵀĜ = (m I; x̃_m) of a component of mass m with the moment of mass x_m; then
//!
//! | | |
//! |---|---|
//! | potential | −gᵀ[R_F (x_m + s) + m u_F] |
//! | its forces | f = (J P_⊥)ᵀ Ĝ a + Qᵀ [UᵀĜ a + (0; s × a)] = Jᵀh |
//! | their stiffness −∂f | −[(∂J)ᵀh − Qᵀ(∂F)ᵀh] − L ã Q_θ − Qᵀ[UᵀĜ ã Q_θ + (0; s̃ ã Q_θ − ã Lᵀ)] |
//!
//! with L = (J P_⊥)ᵀĜ, and Q_θ the rotation rows of Q: ∂a = ã Q_θ, ∂s = Lᵀ.

use super::acts_on::ActsOn;
use super::dense;
use super::error::EvaluationError;
use super::modal_component::ModalComponent;
use super::projection::Projector;
use super::rows::{add_by_place, subtract_frame_rows};
use super::weight::{Weight, on_frame};
use super::workspace::{Scratch, Workspace, check_finite, check_result};
use crate::motion::{
    Vector3, Vector6, cross, dot, join, split, times_3, times_6, transposed_times_3, transposed_times_6,
};

impl ModalComponent {
    /// Forces on the coordinates (r) of the gravity field `g`, an acceleration in inertial axes, in the state that was
    /// last evaluated in the workspace.
    ///
    /// In the reference configuration they are the file's `gravity` times g, or M̂Û g where the file has none. It allocates
    /// nothing.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::ForeignWorkspace`]; [`EvaluationError::NoState`] after an evaluation that failed;
    /// [`EvaluationError::NotFinite`] for `g`; [`EvaluationError::Overflow`].
    pub fn gravity_forces<'w>(&self, g: &Vector3, workspace: &'w mut Workspace) -> Result<&'w [f64], EvaluationError> {
        self.gravity_load(g, workspace)?;
        check_finite([("forces of gravity", &workspace.results.gravity)])?;
        Ok(&workspace.results.gravity)
    }

    /// Potential energy −gᵀ∫x dm in the gravity field `g`, in the state that was last evaluated in the workspace; its
    /// gradient is minus [`gravity_forces`](Self::gravity_forces). It is zero with all mass at the inertial origin.
    ///
    /// # Errors
    ///
    /// The errors of [`gravity_forces`](Self::gravity_forces); [`EvaluationError::NoPotential`] where the loads of gravity in the
    /// file are those of no mass.
    pub fn gravity_potential(&self, g: &Vector3, workspace: &Workspace) -> Result<f64, EvaluationError> {
        self.check_gravity(g, workspace)?;
        let Weight { mass, mut moment } = self.weight.ok_or(EvaluationError::NoPotential)?;
        for (row, e) in self.gravity.iter().zip(workspace.deformation()) {
            moment = core::array::from_fn(|i| moment[i] + e * row[i]);
        }
        let frame = workspace.floating_frame();
        let turned = times_3(&frame.rotation, &moment);
        let potential = -(0..3).map(|i| g[i] * (turned[i] + mass * frame.translation[i])).sum::<f64>();
        check_finite([("potential of gravity", &[potential])])?;
        Ok(potential)
    }

    /// Adds the stiffness −∂f/∂U of [`gravity_forces`](Self::gravity_forces) to `stiffness` (r × r, row by row), in the
    /// state that was last evaluated in the workspace. It allocates nothing.
    ///
    /// # Errors
    ///
    /// The errors of [`gravity_forces`](Self::gravity_forces); [`EvaluationError::WrongLength`] for `stiffness`.
    pub fn add_gravity_stiffness(
        &self,
        g: &Vector3,
        workspace: &mut Workspace,
        stiffness: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let r = self.n_coordinates();
        check_result(stiffness.len(), r * r)?;
        let load = self.gravity_load(g, workspace)?;
        self.frame_rows_of_gravity(&load, workspace);
        let of_frame = times_6(&dense::transposed(&workspace.s), &load.on_frame);
        let Workspace { nodes, q, product, scratch, .. } = workspace;
        let Scratch { square, wide: [wide_q, columns, _, on_frame], .. } = scratch;
        dense::transpose(q, wide_q);
        // ∂f.
        square.fill(0.0);
        add_by_place(self, &Projector { nodes, q }, (product, &of_frame), wide_q, square, on_frame);
        for (row, column) in square.chunks_exact_mut(r).zip(columns.as_chunks::<3>().0) {
            let factors = cross(column, &load.field);
            dense::add_six(row, &join(&[0.0; 3], &factors), wide_q, 0);
        }
        subtract_frame_rows(q, on_frame, square);
        check_finite([("stiffness of gravity", square)])?;
        dense::add_scaled(stiffness, -1.0, square);
        Ok(())
    }

    fn check_gravity(&self, g: &Vector3, workspace: &Workspace) -> Result<(), EvaluationError> {
        workspace.check_component(self)?;
        workspace.check_state()?;
        if let Some(index) = g.iter().position(|value| !value.is_finite()) {
            return Err(EvaluationError::NotFinite { what: "acceleration of gravity", index });
        }
        let along = transposed_times_3(&workspace.floating_frame.rotation, g);
        if self.validity.allows_gravity(along) { Ok(()) } else { Err(EvaluationError::GravityNotTold { along }) }
    }

    /// The forces of gravity, with Ĝ a in the place of the product.
    fn gravity_load(&self, g: &Vector3, workspace: &mut Workspace) -> Result<GravityLoad, EvaluationError> {
        self.check_gravity(g, workspace)?;
        let Workspace { floating_frame, nodes, q, deformation, product, results, .. } = workspace;
        let field = transposed_times_3(&floating_frame.rotation, g);
        let mut moved = [0.0; 3];
        for ((row, e), force) in self.gravity.iter().zip(deformation.iter()).zip(product.iter_mut()) {
            *force = dot(row, &field);
            moved = core::array::from_fn(|i| moved[i] + e * row[i]);
        }
        let whole = self.gravity_on_frame(|row| dot(row, &field));
        let reaction = dense::plus_scaled(&whole, 1.0, &join(&[0.0; 3], &cross(&moved, &field))).map(|x| -x);
        let projector = Projector { nodes, q };
        let on_frame = projector.project(product, &reaction, ActsOn::Deformation, &mut results.gravity);
        Ok(GravityLoad { field, moved, on_frame })
    }

    /// L, a row of three for each coordinate, in the second and −[UᵀĜ ã Q_θ + (0; s̃ ã Q_θ − ã Lᵀ)] in the last wide scratch.
    fn frame_rows_of_gravity(&self, load: &GravityLoad, workspace: &mut Workspace) {
        let Workspace { nodes, q, scratch, .. } = workspace;
        let Scratch { wide: [_, columns, _, on_frame], tall, .. } = scratch;
        let columns = columns.as_chunks_mut::<3>().0;
        // JᵀĜ, and FᵀĜ as three columns.
        columns[..self.gravity.len()].copy_from_slice(&self.gravity);
        let mut carried = [[0.0; 6]; 3];
        let blocks = self.gravity.as_chunks::<6>().0.iter().zip(columns.as_chunks_mut::<6>().0);
        for ((rows, targets), node) in blocks.zip(nodes.iter()) {
            for c in 0..3 {
                let column = rows.each_ref().map(|row| row[c]);
                let turned = transposed_times_6(&node.j, &column);
                targets.iter_mut().zip(turned).for_each(|(target, value)| target[c] = value);
                carried[c] = dense::plus_scaled(&carried[c], 1.0, &transposed_times_6(&node.f, &column));
            }
        }
        let whole: [Vector6; 3] = core::array::from_fn(|c| self.gravity_on_frame(|row| row[c]));
        for ((column, q), target) in columns.iter_mut().zip(q.iter()).zip(tall.iter_mut()) {
            *column = core::array::from_fn(|c| column[c] - dense::dot(q, &carried[c]));
            let change = cross(&load.field, &split(q).1);
            let (turned, dragged) = (cross(&load.moved, &change), cross(&load.field, column));
            let moment = join(&[0.0; 3], &core::array::from_fn(|i| turned[i] - dragged[i]));
            *target = core::array::from_fn(|i| -moment[i] - (0..3).map(|c| whole[c][i] * change[c]).sum::<f64>());
        }
        dense::transpose(tall, on_frame);
    }

    /// UᵀĜ times what `value` takes of each row.
    fn gravity_on_frame(&self, value: impl Fn(&Vector3) -> f64) -> Vector6 {
        on_frame(&self.gravity, &self.rigid, value)
    }
}

/// Forces of gravity in a state.
struct GravityLoad {
    /// a.
    field: Vector3,
    /// s.
    moved: Vector3,
    /// What the floating frame has of them.
    on_frame: Vector6,
}
