//! K and M given in each other's place.

use crate::dofs::Dof;
use crate::error::{Error, Result};
use crate::sparse::SparseMatrix;

/// K and M exchanged: a unit translation makes no force at most rows of a stiffness, held or free, and inertia at every
/// row of a mass (catalogue I-02).
pub(super) fn refuse(stiffness: &SparseMatrix, mass: &SparseMatrix, dofs: Option<&[Option<Dof>]>) -> Result<()> {
    // Rows near a support or with rotations do not cancel in K; rows of M never do, since translations carry mass.
    const MIN_CANCELLING_IN_MASS: f64 = 0.5;
    const MAX_CANCELLING_IN_STIFFNESS: f64 = 0.05;
    let (in_stiffness, in_mass) = rayon::join(|| cancelling_rows(stiffness, dofs), || cancelling_rows(mass, dofs));
    if in_mass > MIN_CANCELLING_IN_MASS && in_stiffness < MAX_CANCELLING_IN_STIFFNESS {
        return Err(Error::Swapped { in_stiffness, in_mass });
    }
    Ok(())
}

/// The share of translation rows whose entries, those of the same direction, add up to nothing.
fn cancelling_rows(matrix: &SparseMatrix, dofs: Option<&[Option<Dof>]>) -> f64 {
    // Text of six digits leaves 10⁻⁶ of a sum that should vanish; a row of M leaves all of it.
    const NOTHING: f64 = 1e-4;
    let direction = |row: usize| dofs.map(|dofs| dofs[row].map(|dof| dof.direction));
    let is_translation =
        |row: usize| direction(row).is_none_or(|direction| direction.is_some_and(|direction| !direction.is_rotation()));
    let (mut cancelling, mut total) = (0usize, 0usize);
    for (row, view) in matrix.outer_iterator().enumerate() {
        if !is_translation(row) {
            continue;
        }
        let (mut sum, mut magnitude) = (0.0f64, 0.0f64);
        for (_, value) in view.iter().filter(|(col, _)| direction(row) == direction(*col)) {
            sum += value;
            magnitude += value.abs();
        }
        total += 1;
        cancelling += usize::from(magnitude > 0.0 && sum.abs() <= NOTHING * magnitude);
    }
    if total > 0 { cancelling as f64 / total as f64 } else { 0.0 }
}
