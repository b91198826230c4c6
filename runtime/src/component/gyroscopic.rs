//! The gyroscopic matrix: derivative of the inertial forces by the velocities, r × r.
//!
//! | symbol | meaning |
//! |---|---|
//! | Z | ∂y/∂v, zero at the modal amplitudes; rows A_j (J − F Q)_j + B_j D_j − C_j Q, where D_j selects V_j |
//! | G | BᵀM (Z − (F − U) S YᵀZ) − Qᵀ[V̂_Fᵀ UᵀM B + P̌_F Q] with B = J − (F − U) Q |
//!
//! The second part of G is the paper's (87), where UᵀM B = M_F Q for a mass-weighted floating frame. The first comes from
//! the Coriolis forces M_I J⁻¹(J̇ − Ḟ Q) v and is of the same order.

use super::dense;
use super::inertial::momentum;
use super::measures::{NodeRates, PlaceMatrices};
use super::modal_component::ModalComponent;
use super::rows::{add_turned, carry, frame_rows, gather, node_rows, subtract_frame_rows, times_node_rows};
use super::state::State;
use super::workspace::{Scratch, Workspace};
use crate::motion::{Matrix6, check, hat, multiply_6, times_6};

/// G and its part (87).
pub(super) fn gyroscopic_matrices(component: &ModalComponent, state: &State<'_>, workspace: &mut Workspace) {
    momentum_part(component, workspace);
    let Workspace { nodes, s, q, deformation_rate, frame_velocity, results, scratch, .. } = workspace;
    let Scratch { square, rates, wide: [wide_q, on_frame, ..], .. } = scratch;
    dense::transpose(q, wide_q);
    node_rows(wide_q, rates, |j| {
        let node = &nodes[j];
        let rates = NodeRates::of(j, deformation_rate, state.velocities, frame_velocity);
        let by = component.measures.rate_matrices(node, &component.positions[j], &rates);
        // A (J − F Q) + B D − C Q = (A J + B) D − (A F + C) Q.
        PlaceMatrices { node: multiply_6(&by.measure, &node.j), frame: multiply_6(&by.measure, &node.f) }
            .plus(&PlaceMatrices { node: by.node, frame: by.frame })
    });
    frame_rows(&component.frame, s, rates, on_frame);
    carry(rates, nodes.iter().map(|node| &node.excess), on_frame);
    times_node_rows(&component.matrices().mass, rates, square);
    gather(nodes.iter().map(|node| &node.excess), square, on_frame);
    results.gyroscopic.copy_from_slice(&results.frame_gyroscopic);
    add_turned(square, nodes, &mut results.gyroscopic);
    subtract_frame_rows(q, on_frame, &mut results.gyroscopic);
}

/// (87): −Qᵀ[V̂_Fᵀ UᵀM B + P̌_F Q], with UᵀM B = M_F Q + UᵀM (J − F Q).
fn momentum_part(component: &ModalComponent, workspace: &mut Workspace) {
    let v_f = workspace.frame_velocity;
    let momentum = momentum(component, &v_f, &workspace.deformation_rate);
    let Workspace { nodes, q, results, scratch, .. } = workspace;
    let Scratch { wide: [wide, ..], tall, .. } = scratch;
    // Rows of (UᵀM J)ᵀ, and UᵀM F.
    let carried = dense::block_sum(&component.momenta, nodes.iter().map(|node| &node.f));
    tall.copy_from_slice(&component.momenta);
    for (rows, node) in tall.as_chunks_mut::<6>().0.iter_mut().zip(nodes.iter()) {
        *rows = dense::turned_rows(&node.j, rows);
    }
    let of_frame: Matrix6 = core::array::from_fn(|i| dense::plus_scaled(&component.rigid_mass[i], -1.0, &carried[i]));
    let (turning, dragging) = (dense::transposed(&hat(&v_f)), check(&momentum));
    for (row, q) in tall.iter_mut().zip(q.iter()) {
        let moved = dense::plus_scaled(row, 1.0, &times_6(&of_frame, q));
        *row = dense::plus_scaled(&times_6(&turning, &moved), 1.0, &times_6(&dragging, q));
    }
    dense::transpose(tall, wide);
    results.frame_gyroscopic.fill(0.0);
    subtract_frame_rows(q, wide, &mut results.frame_gyroscopic);
}
