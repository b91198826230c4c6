//! The Schur complement of the interior: the stiffness of the interface with the internal dofs condensed, K̂_BB.

use std::ops::Range;

use faer::Mat;

use super::static_modes::StaticModes;
use crate::dense;
use crate::partition::Partition;
use crate::sparse::{absolute_energy, panels, product};

/// Interface dofs that stand for all where the terms of each would take a solve.
const SAMPLED: usize = 16;

/// K̂_BB and how far its terms cancel.
pub(super) fn condensed_stiffness(partition: &Partition, modes: &StaticModes<'_>) -> (Mat<f64>, f64) {
    let n_b = modes.n_interface();
    if !modes.is_stored() {
        return by_panels(partition, modes);
    }
    let psi = whole(partition, modes, 0..n_b);
    let mut stiffness = dense::gram(psi.as_ref(), product(&partition.stiffness, psi.as_ref()).as_ref());
    dense::symmetrise(&mut stiffness);
    let terms = absolute_energy(&partition.stiffness, psi.as_ref());
    (stiffness, largest_ratio(partition, 0..n_b, terms))
}

/// K̂_BB some columns at a time: what Ψ_Sᵀ makes of their forces is gathered by the factor.
fn by_panels(partition: &Partition, modes: &StaticModes<'_>) -> (Mat<f64>, f64) {
    let (n_i, n_b) = (modes.n_internal(), modes.n_interface());
    let (mut stiffness, mut cancellation) = (Mat::zeros(n_b, n_b), 1.0f64);
    for columns in panels(n_b) {
        let psi = whole(partition, modes, columns.clone());
        let forces = product(&partition.stiffness, psi.as_ref());
        let mut gathered = modes.gather(forces.as_ref().subrows(0, n_i));
        gathered += forces.as_ref().subrows(n_i, n_b);
        stiffness.as_mut().get_mut(.., columns.clone()).copy_from(&gathered);
        let terms = absolute_energy(&partition.stiffness, psi.as_ref());
        cancellation = cancellation.max(largest_ratio(partition, columns, terms));
    }
    dense::symmetrise(&mut stiffness);
    (stiffness, cancellation)
}

/// How far the terms of K̂_BB cancel, by some columns that stand for all.
pub(super) fn sampled_cancellation(partition: &Partition, modes: &StaticModes<'_>) -> f64 {
    let n_b = modes.n_interface();
    let step = n_b.div_ceil(SAMPLED).max(1);
    let ratio = |j: usize| {
        let psi = whole(partition, modes, j..j + 1);
        largest_ratio(partition, j..j + 1, absolute_energy(&partition.stiffness, psi.as_ref()))
    };
    (0..n_b).step_by(step).map(ratio).fold(1.0, f64::max)
}

/// [Ψ_S; I] of some interface dofs, n' × k.
fn whole(partition: &Partition, modes: &StaticModes<'_>, columns: Range<usize>) -> Mat<f64> {
    let (n_i, k) = (modes.n_internal(), columns.len());
    let mut psi = Mat::zeros(partition.n_dofs(), k);
    psi.as_mut().subrows_mut(0, n_i).copy_from(modes.columns(columns.clone()));
    (0..k).for_each(|j| psi[(n_i + columns.start + j, j)] = 1.0);
    psi
}

/// max t_j / K_BB,jj of terms t of some interface dofs.
fn largest_ratio(partition: &Partition, columns: Range<usize>, terms: Vec<f64>) -> f64 {
    let n_i = partition.n_internal;
    let ratio = |(j, terms): (usize, f64)| {
        let uncondensed = partition.stiffness.get(n_i + j, n_i + j).copied().unwrap_or(0.0);
        if uncondensed > 0.0 { terms / uncondensed } else { 1.0 }
    };
    columns.zip(terms).map(ratio).fold(1.0, f64::max)
}
