//! Elastic forces f_E = (J P_⊥)ᵀK e, the gradient of ½ eᵀK e; eq. (81).

use super::acts_on::ActsOn;
use super::dense;
use super::modal_component::ModalComponent;
use super::projection::Projector;
use super::workspace::Workspace;

pub(super) fn elastic_forces(component: &ModalComponent, workspace: &mut Workspace) {
    let Workspace { nodes, q, deformation, product, results, load, .. } = workspace;
    dense::symmetric_times(&component.matrices().stiffness, deformation, product);
    results.strain_energy = 0.5 * dense::dot(deformation, product);
    let projector = Projector { nodes, q };
    let on_frame = projector.project(product, &[0.0; 6], ActsOn::Deformation, &mut results.elastic);
    load.set(product, &on_frame);
}
