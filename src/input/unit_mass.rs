//! A mass at every row of K, in the place of one that nothing asked depends on.
//!
//! Stages measure motions in the mass. Where statics is all that is asked any metric serves, and nothing of it reaches a result. Every
//! translation weighs one, so that no direction differs from another; rotations weigh as much more as they are stiffer, which is the square of
//! a length; and rows of unknown meaning weigh what they are stiff. A row that K does not have gets none, and is refused as one without
//! stiffness and mass.

use std::path::PathBuf;

use super::{Digits, MatrixInput};
use crate::dofs::Dof;
use crate::sparse::{AssemblyNotes, SparseMatrix, diagonal};

/// The mass of rows whose meaning a map may tell.
pub(super) fn of(stiffness: &SparseMatrix, dofs: Option<&[Option<Dof>]>) -> MatrixInput {
    let n = stiffness.rows();
    let sizes = diagonal(stiffness);
    let turns = |row: usize| dofs.and_then(|dofs| dofs[row]).map(|dof| dof.direction.is_rotation());
    let median = |of: bool| {
        let mut found: Vec<f64> =
            (0..n).filter(|row| turns(*row) == Some(of) && sizes[*row] > 0.0).map(|row| sizes[row]).collect();
        let middle = found.len() / 2;
        if found.is_empty() { 1.0 } else { *found.select_nth_unstable_by(middle, f64::total_cmp).1 }
    };
    let of_rotation = near(median(true) / median(false));
    let weight = |row: usize| match turns(row) {
        Some(false) => 1.0,
        Some(true) => of_rotation,
        None => near(sizes[row]),
    };
    let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for (row, size) in sizes.iter().enumerate() {
        if *size > 0.0 {
            columns.push(row as u32);
            values.push(weight(row));
        }
        pointers.push(columns.len());
    }
    let matrix = SparseMatrix::new((n, n), pointers, columns, values);
    let (path, digest) = (PathBuf::new(), String::new());
    MatrixInput { matrix, notes: AssemblyNotes::default(), digits: Digits::DOUBLE, path, layout: None, digest }
}

/// The power of two below a positive number.
fn near(size: f64) -> f64 {
    size.log2().floor().exp2()
}
