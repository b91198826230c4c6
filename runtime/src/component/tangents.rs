//! Tangent matrices of the paper, r × r: those of the deformation rate and of the motion, (J − W Q)ᵀA (J − W Q).
//!
//! | symbol | meaning |
//! |---|---|
//! | B_W = J − W Q | W = F for the deformation, W = F − U for the whole motion |
//! | K_T, C_T, M_I | B_WᵀK B_W, …; eqs. (82), (84) |

use super::acts_on::ActsOn;
use super::dense;
use super::gyroscopic::gyroscopic_matrices;
use super::modal_component::ModalComponent;
use super::projection::Projector;
use super::rows::{add_turned, gather, subtract_frame_rows};
use super::state::State;
use super::workspace::{Scratch, Workspace};
use crate::motion::{Vector6, times_6, transposed_times_6};

pub(super) fn tangent_matrices(component: &ModalComponent, state: &State<'_>, workspace: &mut Workspace) {
    gyroscopic_matrices(component, state, workspace);
    let Workspace { nodes, q, results, scratch, .. } = workspace;
    let projector = Projector { nodes, q };
    let matrices = component.matrices();
    congruence(&matrices.stiffness, ActsOn::Deformation, &projector, scratch, &mut results.stiffness);
    congruence(&matrices.mass, ActsOn::Motion, &projector, scratch, &mut results.mass);
    let Some(damping) = &matrices.damping else {
        return;
    };
    if component.damping_is_symmetric {
        congruence(damping, component.damping_acts_on, &projector, scratch, &mut results.damping);
    } else {
        any_congruence(damping, component.damping_acts_on, &projector, scratch, &mut results.damping);
    }
}

/// (J − W Q)ᵀA (J − W Q) for symmetric A.
///
/// With H = JᵀA W, N = WᵀA W and B = H − ½ QᵀN it is JᵀA J − B Q − QᵀBᵀ: products of rank six instead of dense ones.
fn congruence(a: &[f64], on: ActsOn, projector: &Projector<'_>, scratch: &mut Scratch, result: &mut [f64]) {
    let (r, n_nodal) = (projector.q.len(), 6 * projector.nodes.len());
    let Scratch { square, wide: [wide_q, wide_b, ..], tall, .. } = scratch;
    let mut n = [[0.0; 6]; 6];
    // A W and A J, row by row.
    times_blocks(a, on, projector, square, tall);
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
    result.fill(0.0);
    add_turned(square, projector.nodes, result);
    for (i, (q, b)) in projector.q.iter().zip(tall.iter()).enumerate() {
        let row = &mut result[i * r + i..(i + 1) * r];
        dense::add_six(row, &b.map(|x| -x), wide_q, i);
        dense::add_six(row, &q.map(|x| -x), wide_b, i);
    }
    dense::mirror(result, r);
}

/// (J − W Q)ᵀA (J − W Q) for any A.
fn any_congruence(a: &[f64], on: ActsOn, projector: &Projector<'_>, scratch: &mut Scratch, result: &mut [f64]) {
    let r = projector.q.len();
    let Scratch { square, wide: [wide_q, on_frame, ..], tall, .. } = scratch;
    dense::transpose(projector.q, wide_q);
    // A (J − W Q), row by row.
    times_blocks(a, on, projector, square, tall);
    for (row, factors) in square.chunks_exact_mut(r).zip(tall.iter()) {
        dense::add_six(row, &factors.map(|x| -x), wide_q, 0);
    }
    gather(projector.nodes.iter().map(|node| on.carried(node)), square, on_frame);
    result.fill(0.0);
    add_turned(square, projector.nodes, result);
    subtract_frame_rows(projector.q, on_frame, result);
}

/// A J in `square` and A W in `tall`.
fn times_blocks(a: &[f64], on: ActsOn, projector: &Projector<'_>, square: &mut [f64], tall: &mut [Vector6]) {
    let r = projector.q.len();
    for ((row, turned), carried) in a.chunks_exact(r).zip(square.chunks_exact_mut(r)).zip(tall) {
        turned.copy_from_slice(row);
        *carried = [0.0; 6];
        let each = row.as_chunks::<6>().0.iter().zip(turned.as_chunks_mut::<6>().0);
        for ((entries, target), node) in each.zip(projector.nodes) {
            *target = transposed_times_6(&node.j, entries);
            *carried = dense::plus_scaled(carried, 1.0, &transposed_times_6(on.carried(node), entries));
        }
    }
}
