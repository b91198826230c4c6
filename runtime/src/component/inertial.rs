//! Inertial forces of a component whose velocity in its floating frame is ε = ė + U V_F.
//!
//! | symbol | meaning |
//! |---|---|
//! | y | J̇ v − Ḟ V_F, zero at the modal amplitudes |
//! | V̇_F, ë | Q v̇ + S Yᵀy, J v̇ + y − F V̇_F |
//! | P_F | momentum UᵀM ε |
//!
//! f_I = (J − (F − U) Q)ᵀ M (ë + U V̇_F) − Qᵀ V̂_Fᵀ P_F.
//!
//! With Yᵀė = 0 and Y = MU this is M_I [v̇ + J⁻¹(J̇ − Ḟ Q) v] − Qᵀ V̂_Fᵀ M_F V_F, M_I = (J P_⊥)ᵀM J P_⊥ + Qᵀ M_F Q: eq. (85) with
//! the J⁻¹ of (71), which multiplies J or YᵀJ in every product and need not be formed. Without it the forces are not those
//! of a Lagrangian, and the energy of a free component is not kept. With another Y the coupling of ė and V_F remains, and
//! the first form keeps it.

use super::acts_on::ActsOn;
use super::dense;
use super::measures::NodeRates;
use super::modal_component::ModalComponent;
use super::projection::{Projector, add_rigid, measure_rate};
use super::state::State;
use super::workspace::Workspace;
use crate::motion::{Vector6, hat, times_6, transposed_times_6};

pub(super) fn inertial_forces(component: &ModalComponent, state: &State<'_>, workspace: &mut Workspace) {
    let n_nodal = 6 * component.n_nodes();
    let v_f = workspace.frame_velocity;
    // y, in the place of the product, and the sum Yᵀy over the nodes.
    let mut sum = [0.0; 6];
    for (j, node) in workspace.nodes.iter().enumerate() {
        let rates = NodeRates::of(j, &workspace.deformation_rate, state.velocities, &v_f);
        let y = component.measures.rates_times(node, &component.positions[j], &rates);
        workspace.product[6 * j..6 * j + 6].copy_from_slice(&y);
        sum = dense::plus_scaled(&sum, 1.0, &dense::columns_times(&component.frame[6 * j..6 * j + 6], &y));
    }
    workspace.product[n_nodal..].fill(0.0);
    let from_rates = times_6(&workspace.s, &sum);
    let frame_acceleration = dense::plus_scaled(&workspace.frame_part(state.accelerations), 1.0, &from_rates);
    workspace.frame_acceleration = frame_acceleration;
    let Workspace { nodes, q, deformation_rate, velocity, acceleration, product, results, load, .. } = workspace;
    let projector = Projector { nodes, q };
    measure_rate(state.accelerations, &frame_acceleration, nodes, acceleration);
    dense::add_scaled(product, 1.0, acceleration);
    add_rigid(&component.rigid, product, &frame_acceleration, acceleration);

    let mass = &component.matrices().mass;
    dense::symmetric_times(mass, velocity, product);
    results.kinetic_energy = 0.5 * dense::dot(velocity, product);
    results.frame_momentum = momentum(component, &v_f, deformation_rate);
    let turning = transposed_times_6(&hat(&v_f), &results.frame_momentum);
    dense::symmetric_times(mass, acceleration, product);
    let on_frame = projector.project(product, &turning, ActsOn::Motion, &mut results.inertial);
    load.add(product, &on_frame);
}

/// P_F = M_F V_F + UᵀM ė.
pub(super) fn momentum(component: &ModalComponent, v_f: &Vector6, deformation_rate: &[f64]) -> Vector6 {
    let of_deformation = dense::columns_times(&component.momenta, deformation_rate);
    dense::plus_scaled(&times_6(&component.rigid_mass, v_f), 1.0, &of_deformation)
}
