//! The exact stiffness: derivative of the elastic, inertial and damping forces by the place, r × r.
//!
//! | symbol | meaning | shape |
//! |---|---|---|
//! | g, g_F | K e + M (ë + U V̇_F) + C ẋ; what the floating frame has of them, V̂_FᵀP_F included | r, 6 |
//! | h = g − Y Sᵀg_F | all forces are Jᵀh | r |
//! | z | ∂(J v − F V_F) at fixed v and V_F; zero at the modal amplitudes, as ζ is | 6k × r |
//! | ∂V_F = S Yᵀz | because Yᵀė = 0 | 6 × r |
//! | ∂ė, ∂ε | z − F ∂V_F, z − (F − U) ∂V_F; ∂ẋ is that on which the damping acts | 6k × r |
//! | ζ | ∂(J v̇ − F V̇_F) + ∂y at fixed v̇ and V̇_F | 6k × r |
//! | ∂(ë + U V̇_F) | ζ − (F − U) S Yᵀζ, because Yᵀë = 0 | 6k × r |
//!
//! K = K_T + [(∂J)ᵀh − Qᵀ(∂F)ᵀh] + BᵀM ∂(ë + U V̇_F) − Qᵀ[V̂_Fᵀ UᵀM ∂ε + P̌_F ∂V_F] + B_WᵀC ∂ẋ.
//!
//! The first bracket is the geometric part, which (82) leaves out. K is symmetric without deformation at rest alone: increments
//! of motions do not commute.

use super::dense;
use super::measures::NodeRates;
use super::modal_component::ModalComponent;
use super::place_terms::PlaceTerms;
use super::projection::Projector;
use super::rows::{
    add_by_place, add_gathered, add_turned, carry, frame_rows, gather, node_rows, subtract_frame_rows, times_node_rows,
};
use super::state::State;
use super::workspace::{Scratch, Workspace};
use crate::motion::{check, hat, multiply_6, times_6};

/// K, from the forces and K_T of the state.
pub(super) fn exact_stiffness_matrix(component: &ModalComponent, state: &State<'_>, workspace: &mut Workspace) {
    for j in 0..component.n_nodes() {
        workspace.scratch.terms[j] = place_terms(component, state, workspace, j);
    }
    workspace.results.exact_stiffness.fill(0.0);
    frame_part(component, workspace);
    inertial_part(component, workspace);
    damping_part(component, workspace);
    let of_frame = times_6(&dense::transposed(&workspace.s), &workspace.load.on_frame);
    let Workspace { nodes, q, load, results, scratch, .. } = workspace;
    let Scratch { wide: [wide_q, _, _, on_frame], .. } = scratch;
    let exact = &mut results.exact_stiffness;
    dense::add_scaled(exact, 1.0, &results.stiffness);
    add_by_place(component, &Projector { nodes, q }, (&load.on_deformation, &of_frame), wide_q, exact, on_frame);
    subtract_frame_rows(q, on_frame, exact);
}

/// y changes by the place itself, and by Ė = z − F ∂V_F and V_F, which the place changes.
fn place_terms(component: &ModalComponent, state: &State<'_>, workspace: &Workspace, j: usize) -> PlaceTerms {
    let (node, position) = (&workspace.nodes[j], &component.positions[j]);
    let rates = NodeRates::of(j, &workspace.deformation_rate, state.velocities, &workspace.frame_velocity);
    let accelerations = core::array::from_fn(|i| state.accelerations[6 * j + i]);
    let by_velocity = component.measures.rate_matrices(node, position, &rates);
    let velocity = component.measures.carried_by_place(node, position, [&rates.node, &rates.frame]);
    let acceleration = component
        .measures
        .carried_by_place(node, position, [&accelerations, &workspace.frame_acceleration])
        .plus(&component.measures.rates_by_place(node, position, &rates))
        .plus(&velocity.multiplied(&by_velocity.measure));
    let of_measure = multiply_6(&by_velocity.measure, &node.f);
    let of_frame = core::array::from_fn(|i| dense::plus_scaled(&of_measure[i], 1.0, &by_velocity.frame[i]));
    PlaceTerms { velocity, acceleration, of_frame }
}

/// Q, ∂V_F and V̂_Fᵀ UᵀM ∂ε + P̌_F ∂V_F in the scratch.
fn frame_part(component: &ModalComponent, workspace: &mut Workspace) {
    let v_f = workspace.frame_velocity;
    let Workspace { nodes, s, q, results, scratch, .. } = workspace;
    let Scratch { rates, terms, wide: [wide_q, frame_change, wide, on_frame], .. } = scratch;
    dense::transpose(q, wide_q);
    node_rows(wide_q, rates, |j| terms[j].velocity);
    frame_rows(&component.frame, s, rates, frame_change);
    // ∂ε is z − (F − U) ∂V_F: the second part joins P̌_F.
    gather(component.momenta.as_chunks::<6>().0.iter(), rates, wide);
    let carried = dense::block_sum(&component.momenta, nodes.iter().map(|node| &node.excess));
    let turning = dense::transposed(&hat(&v_f));
    let (turned, dragging) = (multiply_6(&turning, &carried), check(&results.frame_momentum));
    on_frame.fill(0.0);
    for (i, row) in on_frame.chunks_exact_mut(component.n_coordinates()).enumerate() {
        dense::add_six(row, &turning[i], wide, 0);
        dense::add_six(row, &dense::plus_scaled(&dragging[i], -1.0, &turned[i]), frame_change, 0);
    }
}

/// Adds JᵀM ∂(ë + U V̇_F), and (F − U)ᵀM ∂(ë + U V̇_F) to what is on the frame.
fn inertial_part(component: &ModalComponent, workspace: &mut Workspace) {
    let Workspace { nodes, s, results, scratch, .. } = workspace;
    let Scratch { square, rates, terms, wide: [wide_q, frame_change, wide, on_frame], .. } = scratch;
    node_rows(wide_q, rates, |j| terms[j].acceleration);
    carry(rates, terms.iter().map(|of_node| &of_node.of_frame), frame_change);
    frame_rows(&component.frame, s, rates, wide);
    carry(rates, nodes.iter().map(|node| &node.excess), wide);
    times_node_rows(&component.matrices().mass, rates, square);
    add_gathered(nodes.iter().map(|node| &node.excess), square, on_frame);
    add_turned(square, nodes, &mut results.exact_stiffness);
}

/// Adds JᵀC ∂ẋ, and WᵀC ∂ẋ to what is on the frame.
fn damping_part(component: &ModalComponent, workspace: &mut Workspace) {
    let (Some(damping), on) = (&component.matrices().damping, component.damping_acts_on) else {
        return;
    };
    let Workspace { nodes, results, scratch, .. } = workspace;
    let Scratch { square, rates, terms, wide: [wide_q, frame_change, _, on_frame], .. } = scratch;
    node_rows(wide_q, rates, |j| terms[j].velocity);
    carry(rates, nodes.iter().map(|node| on.carried(node)), frame_change);
    times_node_rows(damping, rates, square);
    add_gathered(nodes.iter().map(|node| on.carried(node)), square, on_frame);
    add_turned(square, nodes, &mut results.exact_stiffness);
}
