//! The Schur complement of the interior: the stiffness of the interface with the internal dofs condensed, K̂_BB.

use faer::{Mat, MatRef};

use crate::dense;
use crate::partition::Partition;
use crate::sparse::{absolute_energy, product};

/// K̂_BB and how far its terms cancel.
pub(super) fn condensed_stiffness(partition: &Partition, modes: MatRef<'_, f64>) -> (Mat<f64>, f64) {
    let (n_i, n_b) = (modes.nrows(), modes.ncols());
    let mut psi = Mat::zeros(partition.n_dofs(), n_b);
    psi.as_mut().subrows_mut(0, n_i).copy_from(modes);
    psi.as_mut().subrows_mut(n_i, n_b).copy_from(Mat::<f64>::identity(n_b, n_b));
    let mut stiffness = dense::gram(psi.as_ref(), product(&partition.stiffness, psi.as_ref()).as_ref());
    dense::symmetrise(&mut stiffness);
    let terms = absolute_energy(&partition.stiffness, psi.as_ref());
    let ratio = |(i, terms): (usize, f64)| {
        let uncondensed = partition.stiffness.get(n_i + i, n_i + i).copied().unwrap_or(0.0);
        if uncondensed > 0.0 { terms / uncondensed } else { 1.0 }
    };
    (stiffness, terms.into_iter().enumerate().map(ratio).fold(1.0, f64::max))
}
