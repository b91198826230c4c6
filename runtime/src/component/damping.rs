//! Damping forces f_D = (J − W Q)ᵀC (J − W Q) v of a linear damping matrix C.
//!
//! C need not be symmetric: its symmetric part takes the power ẋᵀC ẋ from the motion ẋ = (J − W Q) v, its skew part, as of a
//! rotor that spins inside, turns the motion and takes none.
//!
//! A matrix that resists rigid-body motion or makes forces on it, as the mass-proportional part of Rayleigh's, acts on the
//! whole motion, as seen from the floating frame; any other one on the deformation rate alone, so that rounding in C U does
//! not brake a fast rotation.

use super::acts_on::ActsOn;
use super::dense;
use super::modal_component::ModalComponent;
use super::projection::Projector;
use super::workspace::Workspace;

pub(super) fn damping_forces(component: &ModalComponent, workspace: &mut Workspace) {
    let Some(damping) = &component.matrices().damping else {
        return;
    };
    let Workspace { nodes, q, deformation_rate, velocity, product, results, load, .. } = workspace;
    let rate = match component.damping_acts_on {
        ActsOn::Deformation => deformation_rate,
        ActsOn::Motion => velocity,
    };
    dense::times(damping, rate, product);
    results.dissipated_power = dense::dot(rate, product);
    let (on, projector) = (component.damping_acts_on, Projector { nodes, q });
    let on_frame = projector.project(product, &[0.0; 6], on, &mut results.damping_forces);
    load.add(product, &on_frame);
}
