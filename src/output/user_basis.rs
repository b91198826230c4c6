//! The basis in the user's units.

use super::results::Results;

/// An entry of Ψ: of a dof of the partition and a reduced coordinate, displacements in the user's units per unit of the coordinate.
pub(super) fn psi<'a>(results: &'a Results<'_>) -> impl Fn(usize, usize) -> f64 + 'a {
    let (partition, basis) = (results.evidence.partition, results.evidence.basis);
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let shape = partition.scaling.shape_unit();
    move |dof, column| match (dof < n_i, column < n_b) {
        (true, true) => basis.constraint_modes[(dof, column)],
        (true, false) => shape * basis.dynamic_modes[(dof, column - n_b)],
        (false, _) => f64::from(u8::from(dof - n_i == column)),
    }
}
