//! Damping forces f_D = (J − W Q)ᵀC (J − W Q) v of a linear damping matrix C.
//!
//! A matrix that resists rigid-body motion, the mass-proportional part of Rayleigh's, acts on the whole motion, as seen
//! from the floating frame; any other one on the deformation rate alone, so that rounding in C U does not brake a fast
//! rotation.

use super::ModalComponent;
use super::dense;
use super::projection::{ActsOn, Projector};
use super::workspace::Workspace;

impl ModalComponent {
    pub(super) fn damping_forces(&self, workspace: &mut Workspace) {
        let Some(damping) = &self.matrices().damping else {
            return;
        };
        let Workspace { nodes, q, deformation_rate, velocity, product, results, .. } = workspace;
        let rate = match self.damping_acts_on {
            ActsOn::Deformation => deformation_rate,
            ActsOn::Motion => velocity,
        };
        dense::symmetric_times(damping, rate, product);
        self.project(product, &[0.0; 6], self.damping_acts_on, &Projector { nodes, q }, &mut results.damping_forces);
    }
}
