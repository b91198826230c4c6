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
use super::measures::{NodeRates, PlaceMatrices};
use super::projection::Projector;
use super::rows::{add_gathered, gather};
use super::workspace::{Scratch, Workspace};
use super::{ModalComponent, State};
use crate::motion::{Matrix6, check, hat, multiply_6, times_6};

/// How velocities and accelerations at one node change with the place.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaceTerms {
    /// z.
    velocity: PlaceMatrices,
    /// ζ at fixed V_F, and what is taken from it for ∂V_F.
    acceleration: PlaceMatrices,
    of_frame: Matrix6,
}

impl PlaceTerms {
    pub(super) const ZERO: Self = {
        let zero = PlaceMatrices { node: [[0.0; 6]; 6], frame: [[0.0; 6]; 6] };
        Self { velocity: zero, acceleration: zero, of_frame: [[0.0; 6]; 6] }
    };
}

impl ModalComponent {
    /// K, from the forces and K_T of the state.
    pub(super) fn exact_stiffness_matrix(&self, state: &State<'_>, workspace: &mut Workspace) {
        for j in 0..self.n_nodes() {
            workspace.scratch.terms[j] = self.place_terms(state, workspace, j);
        }
        workspace.results.exact_stiffness.fill(0.0);
        self.frame_part(workspace);
        self.inertial_part(workspace);
        self.damping_part(workspace);
        let of_frame = times_6(&dense::transposed(&workspace.s), &workspace.load.on_frame);
        let Workspace { nodes, q, load, results, scratch, .. } = workspace;
        let Scratch { wide: [wide_q, _, _, on_frame], .. } = scratch;
        let exact = &mut results.exact_stiffness;
        dense::add_scaled(exact, 1.0, &results.stiffness);
        self.add_by_place(&Projector { nodes, q }, (&load.on_deformation, &of_frame), wide_q, exact, on_frame);
        self.subtract_frame_rows(q, on_frame, exact);
    }

    /// y changes by the place itself, and by Ė = z − F ∂V_F and V_F, which the place changes.
    fn place_terms(&self, state: &State<'_>, workspace: &Workspace, j: usize) -> PlaceTerms {
        let (node, position) = (&workspace.nodes[j], &self.positions[j]);
        let rates = NodeRates::of(j, &workspace.deformation_rate, state.velocities, &workspace.frame_velocity);
        let accelerations = core::array::from_fn(|i| state.accelerations[6 * j + i]);
        let by_velocity = self.measures.rate_matrices(node, position, &rates);
        let velocity = self.measures.carried_by_place(node, position, [&rates.node, &rates.frame]);
        let acceleration = self
            .measures
            .carried_by_place(node, position, [&accelerations, &workspace.frame_acceleration])
            .plus(&self.measures.rates_by_place(node, position, &rates))
            .plus(&velocity.multiplied(&by_velocity.measure));
        let of_measure = multiply_6(&by_velocity.measure, &node.f);
        let of_frame = core::array::from_fn(|i| dense::plus_scaled(&of_measure[i], 1.0, &by_velocity.frame[i]));
        PlaceTerms { velocity, acceleration, of_frame }
    }

    /// Q, ∂V_F and V̂_Fᵀ UᵀM ∂ε + P̌_F ∂V_F in the scratch.
    fn frame_part(&self, workspace: &mut Workspace) {
        let v_f = workspace.frame_velocity;
        let Workspace { nodes, s, q, results, scratch, .. } = workspace;
        let Scratch { rates, terms, wide: [wide_q, frame_change, wide, on_frame], .. } = scratch;
        dense::transpose(q, wide_q);
        self.node_rows(wide_q, rates, |j| terms[j].velocity);
        self.frame_rows(s, rates, frame_change);
        // ∂ε is z − (F − U) ∂V_F: the second part joins P̌_F.
        gather(self.momenta.as_chunks::<6>().0.iter(), rates, wide);
        let carried = dense::block_sum(&self.momenta, nodes.iter().map(|node| &node.excess));
        let turning = dense::transposed(&hat(&v_f));
        let (turned, dragging) = (multiply_6(&turning, &carried), check(&results.frame_momentum));
        on_frame.fill(0.0);
        for (i, row) in on_frame.chunks_exact_mut(self.n_coordinates()).enumerate() {
            dense::add_six(row, &turning[i], wide, 0);
            dense::add_six(row, &dense::plus_scaled(&dragging[i], -1.0, &turned[i]), frame_change, 0);
        }
    }

    /// Adds JᵀM ∂(ë + U V̇_F), and (F − U)ᵀM ∂(ë + U V̇_F) to what is on the frame.
    fn inertial_part(&self, workspace: &mut Workspace) {
        let Workspace { nodes, s, results, scratch, .. } = workspace;
        let Scratch { square, rates, terms, wide: [wide_q, frame_change, wide, on_frame], .. } = scratch;
        self.node_rows(wide_q, rates, |j| terms[j].acceleration);
        self.carry(rates, terms.iter().map(|of_node| &of_node.of_frame), frame_change);
        self.frame_rows(s, rates, wide);
        self.carry(rates, nodes.iter().map(|node| &node.excess), wide);
        self.times_node_rows(&self.matrices().mass, rates, square);
        add_gathered(nodes.iter().map(|node| &node.excess), square, on_frame);
        self.add_turned(square, nodes, &mut results.exact_stiffness);
    }

    /// Adds JᵀC ∂ẋ, and WᵀC ∂ẋ to what is on the frame.
    fn damping_part(&self, workspace: &mut Workspace) {
        let (Some(damping), on) = (&self.matrices().damping, self.damping_acts_on) else {
            return;
        };
        let Workspace { nodes, results, scratch, .. } = workspace;
        let Scratch { square, rates, terms, wide: [wide_q, frame_change, _, on_frame], .. } = scratch;
        self.node_rows(wide_q, rates, |j| terms[j].velocity);
        self.carry(rates, nodes.iter().map(|node| on.carried(node)), frame_change);
        self.times_node_rows(damping, rates, square);
        add_gathered(nodes.iter().map(|node| on.carried(node)), square, on_frame);
        self.add_turned(square, nodes, &mut results.exact_stiffness);
    }
}
