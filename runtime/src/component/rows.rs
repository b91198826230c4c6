//! Derivatives of node quantities by all coordinates, and what becomes of them on the way to forces.
//!
//! | symbol | meaning | layout |
//! |---|---|---|
//! | Z | derivatives of six numbers at each node; zero at the modal amplitudes | 6k × r, row by row |
//! | Q, S YᵀZ, WᵀX | of six numbers of the floating frame | 6 × r, row by row |
//! | X | forces on the deformation or the motion | r × r, row by row |

use super::dense;
use super::measures::{NodeMeasure, PlaceMatrices};
use super::modal_component::ModalComponent;
use super::projection::Projector;
use crate::motion::{Matrix6, Vector6};

/// Z with rows `node` D_j − `frame` Q for each node, where D_j selects its coordinates.
pub(super) fn node_rows(wide_q: &[f64], rates: &mut [f64], each: impl Fn(usize) -> PlaceMatrices) {
    let r = wide_q.len() / 6;
    rates.fill(0.0);
    for (j, rows) in rates.chunks_exact_mut(6 * r).enumerate() {
        add_node_rows(&each(j), j, wide_q, rows);
    }
}

/// Z − W R with W of each node, R 6 × r.
pub(super) fn carry<'a>(rates: &mut [f64], w: impl Iterator<Item = &'a Matrix6>, wide: &[f64]) {
    let r = wide.len() / 6;
    for (rows, w) in rates.chunks_exact_mut(6 * r).zip(w) {
        for (row, factors) in rows.chunks_exact_mut(r).zip(w) {
            dense::add_six(row, &factors.map(|x| -x), wide, 0);
        }
    }
}

/// S YᵀZ, the change of the floating frame that Z brings about.
pub(super) fn frame_rows(y: &[Vector6], s: &Matrix6, rates: &[f64], frame: &mut [f64]) {
    gather(y.as_chunks::<6>().0.iter(), rates, frame);
    let r = y.len();
    for c in 0..r {
        let column: Vector6 = core::array::from_fn(|i| frame[i * r + c]);
        s.iter().enumerate().for_each(|(i, row)| frame[i * r + c] = dense::dot(row, &column));
    }
}

/// A Z, r × r, for A, r × r.
pub(super) fn times_node_rows(a: &[f64], rates: &[f64], product: &mut [f64]) {
    let r = a.len().isqrt();
    for (row, target) in a.chunks_exact(r).zip(product.chunks_exact_mut(r)) {
        target.fill(0.0);
        for (factors, rates) in row.as_chunks::<6>().0.iter().zip(rates.chunks_exact(6 * r)) {
            dense::add_six(target, factors, rates, 0);
        }
    }
}

/// `sum` += Jᵀ X.
pub(super) fn add_turned(x: &[f64], nodes: &[NodeMeasure], sum: &mut [f64]) {
    let (r, n_nodal) = (x.len().isqrt(), 6 * nodes.len());
    let (blocks, amplitudes) = sum.split_at_mut(n_nodal * r);
    for ((rows, targets), node) in x.chunks_exact(6 * r).zip(blocks.chunks_exact_mut(6 * r)).zip(nodes) {
        for (target, column) in targets.chunks_exact_mut(r).zip(&dense::transposed(&node.j)) {
            dense::add_six(target, column, rows, 0);
        }
    }
    dense::add_scaled(amplitudes, 1.0, &x[n_nodal * r..]);
}

/// `sum` −= Qᵀ R, R 6 × r.
pub(super) fn subtract_frame_rows(q: &[Vector6], wide: &[f64], sum: &mut [f64]) {
    for (row, q) in sum.chunks_exact_mut(q.len()).zip(q) {
        dense::add_six(row, &q.map(|x| -x), wide, 0);
    }
}

/// Derivative of Jᵀh by the place, added to `sum`, and that of Fᵀh, added to `on_frame`; of Jᵀ(g − Y y), where y brings
/// Fᵀ(g − Y y) to a fixed value, the derivative is the first less Qᵀ times the second.
///
/// Here g is what acts on the deformation and `y` what the floating frame has of it.
pub(super) fn add_by_place(
    component: &ModalComponent,
    projector: &Projector<'_>,
    (g, y): (&[f64], &Vector6),
    wide_q: &[f64],
    sum: &mut [f64],
    on_frame: &mut [f64],
) {
    let r = component.n_coordinates();
    let frame = component.frame.as_chunks::<6>().0;
    for (j, (node, rows)) in projector.nodes.iter().zip(sum.chunks_exact_mut(6 * r)).enumerate() {
        let h = core::array::from_fn(|i| g[6 * j + i] - dense::dot(&frame[j][i], y));
        let [of_node, of_frame] = component.measures.forces_by_place(node, &component.positions[j], &h);
        add_node_rows(&of_node, j, wide_q, rows);
        add_node_rows(&of_frame, j, wide_q, on_frame);
    }
}

/// Rows `node` D_j − `frame` Q, six of r.
fn add_node_rows(matrices: &PlaceMatrices, j: usize, wide_q: &[f64], rows: &mut [f64]) {
    let r = rows.len() / 6;
    for ((row, of_node), of_frame) in rows.chunks_exact_mut(r).zip(&matrices.node).zip(&matrices.frame) {
        dense::add_six(row, &of_frame.map(|x| -x), wide_q, 0);
        dense::add_scaled(&mut row[6 * j..6 * j + 6], 1.0, of_node);
    }
}

/// Σ W_jᵀX_j over the nodes, 6 × r.
pub(super) fn gather<'a>(w: impl Iterator<Item = &'a Matrix6>, x: &[f64], sum: &mut [f64]) {
    sum.fill(0.0);
    add_gathered(w, x, sum);
}

/// Adds Σ W_jᵀX_j over the nodes to `sum`.
pub(super) fn add_gathered<'a>(w: impl Iterator<Item = &'a Matrix6>, x: &[f64], sum: &mut [f64]) {
    let r = sum.len() / 6;
    for (rows, w) in x.chunks_exact(6 * r).zip(w) {
        for (target, column) in sum.chunks_exact_mut(r).zip(&dense::transposed(w)) {
            dense::add_six(target, column, rows, 0);
        }
    }
}
