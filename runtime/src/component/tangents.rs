//! Tangent matrices of the forces, r × r.
//!
//! | symbol | meaning |
//! |---|---|
//! | B_W = J − W Q | W = F for the deformation, W = F − U for the whole motion |
//! | K_T, C_T, M_I | B_WᵀK B_W, …; eqs. (82), (84) |
//! | Z | ∂y/∂v, zero at the modal amplitudes; rows A_j (J − F Q)_j + B_j D_j − C_j Q, where D_j selects V_j |
//! | G | BᵀM (Z − (F − U) S YᵀZ) − Qᵀ[V̂_Fᵀ UᵀM B + P̌_F Q] with B = J − (F − U) Q |
//!
//! The second part of G is the paper's (87), where UᵀM B = M_F Q for a mass-weighted floating frame. The first comes from
//! the Coriolis forces M_I J⁻¹(J̇ − Ḟ Q) v and is of the same order.

use super::dense;
use super::projection::{ActsOn, Projector};
use super::workspace::{Scratch, Workspace};
use super::{ModalComponent, State};
use crate::motion::{Matrix6, check, hat, multiply_6, times_6, transposed_times_6};

impl ModalComponent {
    pub(super) fn tangent_matrices(&self, state: &State<'_>, workspace: &mut Workspace) {
        self.gyroscopic_matrices(state, workspace);
        let Workspace { nodes, q, results, scratch, .. } = workspace;
        let projector = Projector { nodes, q };
        let matrices = self.matrices();
        self.congruence(&matrices.stiffness, ActsOn::Deformation, &projector, scratch, &mut results.stiffness);
        self.congruence(&matrices.mass, ActsOn::Motion, &projector, scratch, &mut results.mass);
        if let Some(damping) = &matrices.damping {
            self.congruence(damping, self.damping_acts_on, &projector, scratch, &mut results.damping);
        }
    }

    /// (J − W Q)ᵀA (J − W Q) for symmetric A.
    ///
    /// With H = JᵀA W, N = WᵀA W and B = H − ½ QᵀN it is JᵀA J − B Q − QᵀBᵀ: products of rank six instead of dense ones.
    fn congruence(&self, a: &[f64], on: ActsOn, projector: &Projector<'_>, scratch: &mut Scratch, result: &mut [f64]) {
        let (r, n_nodal) = (self.n_coordinates(), 6 * self.n_nodes());
        let Scratch { square, wide: [wide_q, wide_b], tall, .. } = scratch;
        let mut n = [[0.0; 6]; 6];
        // A W and A J, row by row.
        for ((row, turned), carried) in a.chunks_exact(r).zip(square.chunks_exact_mut(r)).zip(tall.iter_mut()) {
            turned.copy_from_slice(row);
            *carried = [0.0; 6];
            let each = row.as_chunks::<6>().0.iter().zip(turned.as_chunks_mut::<6>().0);
            for ((entries, target), node) in each.zip(projector.nodes) {
                *target = transposed_times_6(&node.j, entries);
                *carried = dense::plus_scaled(carried, 1.0, &transposed_times_6(on.carried(node), entries));
            }
        }
        // N = WᵀA W, H = JᵀA W.
        for (rows, node) in tall[..n_nodal].as_chunks_mut::<6>().0.iter_mut().zip(projector.nodes) {
            for (target, row) in n.iter_mut().zip(dense::turned_rows(on.carried(node), rows)) {
                *target = dense::plus_scaled(target, 1.0, &row);
            }
            *rows = dense::turned_rows(&node.j, rows);
        }
        for (row, q) in tall.iter_mut().zip(projector.q) {
            *row = dense::plus_scaled(row, -0.5, &times_6(&n, q));
        }
        dense::transpose(projector.q, wide_q);
        dense::transpose(tall, wide_b);
        self.turn_rows(square, projector, result);
        for (i, (q, b)) in projector.q.iter().zip(tall.iter()).enumerate() {
            let row = &mut result[i * r + i..(i + 1) * r];
            dense::add_six(row, &b.map(|x| -x), wide_q, i);
            dense::add_six(row, &q.map(|x| -x), wide_b, i);
        }
        dense::mirror(result, r);
    }

    /// Jᵀ X for X with rows of r, row by row.
    fn turn_rows(&self, x: &[f64], projector: &Projector<'_>, product: &mut [f64]) {
        let r = self.n_coordinates();
        let each = x.chunks_exact(6 * r).zip(product.chunks_exact_mut(6 * r)).zip(projector.nodes);
        for ((rows, targets), node) in each {
            targets.fill(0.0);
            for (target, column) in targets.chunks_exact_mut(r).zip(&dense::transposed(&node.j)) {
                dense::add_six(target, column, rows, 0);
            }
        }
        let n_nodal = 6 * self.n_nodes();
        product[n_nodal * r..].copy_from_slice(&x[n_nodal * r..]);
    }

    /// G and its part (87).
    fn gyroscopic_matrices(&self, state: &State<'_>, workspace: &mut Workspace) {
        self.momentum_part(workspace);
        self.acceleration_rates(state, workspace);
        let r = self.n_coordinates();
        let Workspace { nodes, q, results, scratch, .. } = workspace;
        let projector = Projector { nodes, q };
        let Scratch { square, rates, wide: [on_frame, _], .. } = scratch;
        // M Z̄; Z̄ is zero at the modal amplitudes.
        for (row, target) in self.matrices().mass.chunks_exact(r).zip(square.chunks_exact_mut(r)) {
            target.fill(0.0);
            for (factors, rates) in row.as_chunks::<6>().0.iter().zip(rates.chunks_exact(6 * r)) {
                dense::add_six(target, factors, rates, 0);
            }
        }
        self.turn_rows(square, &projector, &mut results.gyroscopic);
        // (F − U)ᵀM Z̄, six rows.
        on_frame.fill(0.0);
        for (rows, node) in square.chunks_exact(6 * r).zip(nodes.iter()) {
            for (target, column) in on_frame.chunks_exact_mut(r).zip(&dense::transposed(&node.excess)) {
                dense::add_six(target, column, rows, 0);
            }
        }
        let each = results.gyroscopic.chunks_exact_mut(r).zip(results.frame_gyroscopic.chunks_exact(r)).zip(q.iter());
        for ((row, frame_row), q) in each {
            dense::add_six(row, &q.map(|x| -x), on_frame, 0);
            dense::add_scaled(row, 1.0, frame_row);
        }
    }

    /// (87): −Qᵀ[V̂_Fᵀ UᵀM B + P̌_F Q], with UᵀM B = M_F Q + UᵀM (J − F Q).
    fn momentum_part(&self, workspace: &mut Workspace) {
        let r = self.n_coordinates();
        let v_f = workspace.frame_velocity;
        let momentum = self.momentum(&v_f, &workspace.deformation_rate);
        let Workspace { nodes, q, results, scratch, .. } = workspace;
        let Scratch { wide: [wide, _], tall, .. } = scratch;
        // Rows of (UᵀM J)ᵀ, and UᵀM F.
        let carried = dense::block_sum(&self.momenta, nodes.iter().map(|node| &node.f));
        tall.copy_from_slice(&self.momenta);
        for (rows, node) in tall.as_chunks_mut::<6>().0.iter_mut().zip(nodes.iter()) {
            *rows = dense::turned_rows(&node.j, rows);
        }
        let of_frame: Matrix6 = core::array::from_fn(|i| dense::plus_scaled(&self.rigid_mass[i], -1.0, &carried[i]));
        let (turning, dragging) = (dense::transposed(&hat(&v_f)), check(&momentum));
        for (row, q) in tall.iter_mut().zip(q.iter()) {
            let moved = dense::plus_scaled(row, 1.0, &times_6(&of_frame, q));
            *row = dense::plus_scaled(&times_6(&turning, &moved), 1.0, &times_6(&dragging, q));
        }
        dense::transpose(tall, wide);
        results.frame_gyroscopic.fill(0.0);
        for (row, q) in results.frame_gyroscopic.chunks_exact_mut(r).zip(q.iter()) {
            dense::add_six(row, &q.map(|x| -x), wide, 0);
        }
    }

    /// Z̄ = Z − (F − U) S YᵀZ, 6k × r.
    fn acceleration_rates(&self, state: &State<'_>, workspace: &mut Workspace) {
        let r = self.n_coordinates();
        let mut rates = core::mem::take(&mut workspace.scratch.rates);
        dense::transpose(&workspace.q, &mut workspace.scratch.wide[0]);
        let wide_q = &workspace.scratch.wide[0];
        for (j, target) in rates.chunks_exact_mut(6 * r).enumerate() {
            let node = &workspace.nodes[j];
            let by = self.measures.rate_matrices(node, &self.positions[j], &workspace.node_rates(state, j));
            // A (J − F Q) + B D − C Q = (A J + B) D − (A F + C) Q.
            let (with_j, with_f) = (multiply_6(&by.measure, &node.j), multiply_6(&by.measure, &node.f));
            for (a, row) in target.chunks_exact_mut(r).enumerate() {
                let on_frame = dense::plus_scaled(&with_f[a], 1.0, &by.frame[a]);
                row.fill(0.0);
                dense::add_six(row, &on_frame.map(|x| -x), wide_q, 0);
                dense::add_scaled(&mut row[6 * j..6 * j + 6], 1.0, &dense::plus_scaled(&with_j[a], 1.0, &by.node[a]));
            }
        }
        // S YᵀZ, six rows.
        let [sum, turned] = &mut workspace.scratch.wide;
        sum.fill(0.0);
        for (rows, y) in rates.chunks_exact(6 * r).zip(self.frame.as_chunks::<6>().0) {
            for (target, column) in sum.chunks_exact_mut(r).zip(&dense::transposed(y)) {
                dense::add_six(target, column, rows, 0);
            }
        }
        turned.fill(0.0);
        for (target, s) in turned.chunks_exact_mut(r).zip(&workspace.s) {
            dense::add_six(target, s, sum, 0);
        }
        for (target, node) in rates.chunks_exact_mut(6 * r).zip(&workspace.nodes) {
            for (row, factors) in target.chunks_exact_mut(r).zip(&node.excess) {
                dense::add_six(row, &factors.map(|x| -x), turned, 0);
            }
        }
        workspace.scratch.rates = rates;
    }
}
