//! Rows of constraint multipliers in K: unknowns of the equations G u = 0, which a program appends to K to have them solved.
//!
//! ```text
//! [ K  Gᵀ ]        [ K    αGᵀ  αGᵀ ]
//! [ G  0  ]        [ αG   −α    α  ]        one multiplier for each constraint, or two
//!                  [ αG    α   −α  ]
//! ```
//! One multiplier has a zero on the diagonal. Two of one constraint have α on theirs, and between them its opposite; both are coupled
//! alike with the displacements, and neither has mass. With either sign of α such a pair makes K indefinite, so that no structure has
//! one.

use crate::dofs::RowNames;
use crate::error::{Error, Result};
use crate::sparse::{SparseMatrix, diagonal};

/// Refuses a K with rows of multipliers.
///
/// # Errors
/// [`Error::MultiplierRow`], with the first of them and how many there are.
pub(super) fn refuse(stiffness: &SparseMatrix, mass: &SparseMatrix, names: RowNames<'_>) -> Result<()> {
    let diagonal = diagonal(stiffness);
    let single = (0..diagonal.len()).filter(|row| diagonal[*row] == 0.0 && entries(stiffness, *row).next().is_some());
    let single: Vec<usize> = single.collect();
    let of_pairs: Vec<usize> = (0..diagonal.len())
        .filter_map(|row| partner(stiffness, mass, &diagonal, row).map(|partner| [row, partner]))
        .flatten()
        .collect();
    match single.iter().chain(&of_pairs).min() {
        None => Ok(()),
        Some(first) => Err(Error::MultiplierRow {
            n_single: single.len(),
            n_of_pairs: of_pairs.len(),
            row: names.number(*first),
            dof: names.bracketed(*first),
        }),
    }
}

/// The later row of the pair of multipliers that a row is the first of.
fn partner(stiffness: &SparseMatrix, mass: &SparseMatrix, diagonal: &[f64], row: usize) -> Option<usize> {
    let own = diagonal[row];
    let is_massless = |row: usize| entries(mass, row).next().is_none();
    if own == 0.0 || !is_massless(row) {
        return None;
    }
    let is_like = |other: usize| {
        let others = |of: usize| entries(stiffness, of).filter(move |(col, _)| *col != row && *col != other);
        is_massless(other) && others(row).next().is_some() && others(row).eq(others(other))
    };
    let mut opposite = entries(stiffness, row).filter(|(col, value)| *col > row && *value == -own);
    opposite.find(|(other, _)| diagonal[*other] == own && is_like(*other)).map(|(other, _)| other)
}

/// The entries of a row other than zero.
fn entries(matrix: &SparseMatrix, row: usize) -> impl Iterator<Item = (usize, f64)> {
    let (columns, values) = matrix.outer_view(row).map_or((&[][..], &[][..]), |view| view.into_raw_storage());
    columns.iter().zip(values).map(|(col, value)| (*col as usize, *value)).filter(|(_, value)| *value != 0.0)
}
