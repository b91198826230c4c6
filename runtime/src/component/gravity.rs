//! Forces of a uniform gravity field, exact gradients of its potential.
//!
//! With the field a = R_Fᵀg in the floating frame and the loads Ĝ of a unit field (r × 3), the mass moved by the
//! deformation is Ĝᵀe, and the potential −gᵀ[R_F (m c + Ĝᵀe) + m u_F] gives
//!
//! f = (J P_⊥)ᵀ Ĝ a + Qᵀ [UᵀĜ a + (0; Ĝᵀe × a)].

use super::ModalComponent;
use super::dense;
use super::projection::{ActsOn, Projector};
use super::workspace::Workspace;
use crate::motion::{Vector3, Vector6, cross, dot, join, transposed_times_3, transposed_times_6};

impl ModalComponent {
    /// Forces on the coordinates (r) of the gravity field `g`, an acceleration in inertial axes, in the state that was
    /// last evaluated in the workspace.
    ///
    /// They are the gradient of a potential; in the reference configuration they are the file's `gravity` times g, or M̂Û g
    /// where the file has none.
    ///
    /// # Panics
    ///
    /// Panics on the workspace of a component with other numbers of nodes or coordinates.
    pub fn gravity_forces<'w>(&self, g: &Vector3, workspace: &'w mut Workspace) -> &'w [f64] {
        let fit = self.check_workspace(workspace);
        assert_eq!(fit, Ok(()), "the workspace is that of the component");
        let Workspace { floating_frame, nodes, q, deformation, product, results, .. } = workspace;
        let a = transposed_times_3(&floating_frame.rotation, g);
        let mut moved = [0.0; 3];
        for ((row, e), force) in self.gravity.iter().zip(deformation.iter()).zip(product.iter_mut()) {
            *force = dot(row, &a);
            moved = core::array::from_fn(|i| moved[i] + e * row[i]);
        }
        let mut on_frame: Vector6 = join(&[0.0; 3], &cross(&moved, &a));
        for (rigid, g) in self.rigid.iter().zip(product.as_chunks::<6>().0) {
            on_frame = dense::plus_scaled(&on_frame, 1.0, &transposed_times_6(rigid, g));
        }
        let reaction = on_frame.map(|x| -x);
        self.project(product, &reaction, ActsOn::Deformation, &Projector { nodes, q }, &mut results.gravity);
        &results.gravity
    }
}
