//! Elastic forces f_E = (J P_⊥)ᵀK e, the gradient of ½ eᵀK e; eq. (81).

use super::ModalComponent;
use super::dense;
use super::projection::{ActsOn, Projector};
use super::workspace::Workspace;

impl ModalComponent {
    pub(super) fn elastic_forces(&self, workspace: &mut Workspace) {
        let Workspace { nodes, q, deformation, product, results, load, .. } = workspace;
        dense::symmetric_times(&self.matrices().stiffness, deformation, product);
        results.strain_energy = 0.5 * dense::dot(deformation, product);
        let projector = Projector { nodes, q };
        let on_frame = self.project(product, &[0.0; 6], ActsOn::Deformation, &projector, &mut results.elastic);
        load.set(product, &on_frame);
    }
}
