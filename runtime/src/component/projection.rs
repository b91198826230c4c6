//! Passage between the coordinates of the nodes and those of the deformation: Δe = (J − F Q) Δu.
//!
//! The component moves by ė in its floating frame, and by ε = ė + U V_F altogether; both are (J − W Q) v, with W = F for
//! the first and W = F − U for the second, because V_F = Q v.

use alloc::vec::Vec;

use super::acts_on::ActsOn;
use super::dense;
use super::measures::NodeMeasure;
use crate::motion::{Matrix6, Vector6, times_6, transposed_times_6};

/// J x − F x_F, r.
pub(super) fn measure_rate(x: &[f64], x_f: &Vector6, nodes: &[NodeMeasure], rate: &mut [f64]) {
    let n_nodal = 6 * nodes.len();
    let (blocks, amplitudes) = rate.split_at_mut(n_nodal);
    for ((target, x), node) in blocks.as_chunks_mut::<6>().0.iter_mut().zip(x.as_chunks::<6>().0).zip(nodes) {
        let (of_node, of_frame) = (times_6(&node.j, x), times_6(&node.f, x_f));
        *target = core::array::from_fn(|i| of_node[i] - of_frame[i]);
    }
    amplitudes.copy_from_slice(&x[n_nodal..]);
}

/// x + U x_F, r.
pub(super) fn add_rigid(rigid: &[Matrix6], x: &[f64], x_f: &Vector6, sum: &mut [f64]) {
    let n_nodal = 6 * rigid.len();
    let (blocks, amplitudes) = sum.split_at_mut(n_nodal);
    let each = blocks.as_chunks_mut::<6>().0.iter_mut().zip(x.as_chunks::<6>().0);
    for ((target, x), rigid) in each.zip(rigid) {
        *target = dense::plus_scaled(x, 1.0, &times_6(rigid, x_f));
    }
    amplitudes.copy_from_slice(&x[n_nodal..]);
}

/// The parts of a workspace that make J − F Q.
#[derive(Clone, Copy)]
pub(super) struct Projector<'a> {
    pub(super) nodes: &'a [NodeMeasure],
    pub(super) q: &'a [Vector6],
}

impl Projector<'_> {
    /// (J − W Q)ᵀg − Qᵀg_F, r: forces on the coordinates, from those on the deformation or motion and on the frame. All that
    /// the frame has of them, Wᵀg + g_F, is returned.
    pub(super) fn project(&self, g: &[f64], g_f: &Vector6, on: ActsOn, forces: &mut [f64]) -> Vector6 {
        let n_nodal = 6 * self.nodes.len();
        let (blocks, amplitudes) = forces.split_at_mut(n_nodal);
        let mut on_frame = *g_f;
        let each = blocks.as_chunks_mut::<6>().0.iter_mut().zip(g.as_chunks::<6>().0);
        for ((target, g), node) in each.zip(self.nodes) {
            *target = transposed_times_6(&node.j, g);
            on_frame = dense::plus_scaled(&on_frame, 1.0, &transposed_times_6(on.carried(node), g));
        }
        amplitudes.copy_from_slice(&g[n_nodal..]);
        for (force, q) in forces.iter_mut().zip(self.q) {
            *force -= dense::dot(q, &on_frame);
        }
        on_frame
    }
}

/// Sum of what acts on the coordinates by [`Projector::project`].
#[derive(Clone, Debug)]
pub(super) struct Load {
    /// g, r.
    pub(super) on_deformation: Vec<f64>,
    /// Wᵀg + g_F.
    pub(super) on_frame: Vector6,
}

impl Load {
    pub(super) fn set(&mut self, g: &[f64], on_frame: &Vector6) {
        self.on_deformation.copy_from_slice(g);
        self.on_frame = *on_frame;
    }

    pub(super) fn add(&mut self, g: &[f64], on_frame: &Vector6) {
        dense::add_scaled(&mut self.on_deformation, 1.0, g);
        self.on_frame = dense::plus_scaled(&self.on_frame, 1.0, on_frame);
    }
}
