//! The congruence TᵀAT of a symmetric sparse matrix, row by row and in parallel.

use rayon::prelude::*;

use super::transformation::{Transformation, TransformationRow};
use crate::model::make_symmetric;
use crate::sparse::SparseMatrix;

/// Rows of the result computed by one task; a fixed number, so that the work is cut the same way on every machine.
const ROWS_PER_TASK: usize = 512;

/// TᵀAT, n' × n', bitwise symmetric.
pub(super) fn congruence(matrix: &SparseMatrix, transformation: &Transformation) -> SparseMatrix {
    let n = transformation.dofs.len();
    let columns = columns_of(transformation, n);
    let tasks: Vec<Vec<Row>> = (0..n)
        .into_par_iter()
        .chunks(ROWS_PER_TASK)
        .map(|rows| rows.into_iter().map(|row| Row::new(matrix, transformation, &columns[row])).collect())
        .collect();
    let n_entries = tasks.iter().flatten().map(|row| row.columns.len()).sum();
    let mut pointers = Vec::with_capacity(n + 1);
    let (mut indices, mut values) = (Vec::with_capacity(n_entries), Vec::with_capacity(n_entries));
    pointers.push(0);
    for row in tasks.into_iter().flatten() {
        indices.extend_from_slice(&row.columns);
        values.extend_from_slice(&row.values);
        pointers.push(indices.len());
    }
    let mut product = SparseMatrix::new((n, n), pointers, indices, values);
    // The sums of a patch are taken in different orders above and below the diagonal; the mean makes the bits equal.
    make_symmetric(&mut product);
    product
}

/// T by columns: the rows that a dof of the partition moves, with their factors.
fn columns_of(transformation: &Transformation, n: usize) -> Vec<Vec<(u32, f64)>> {
    let mut columns = vec![Vec::new(); n];
    for (row, entries) in transformation.rows.iter().enumerate() {
        for (dof, factor) in entries.entries() {
            columns[dof as usize].push((row as u32, factor));
        }
    }
    columns
}

struct Row {
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Row {
    /// One row of TᵀAT: Σ over the rows this dof moves, expanded by T and merged by column.
    fn new(matrix: &SparseMatrix, transformation: &Transformation, moved: &[(u32, f64)]) -> Self {
        let mut entries: Vec<(u32, f64)> = Vec::new();
        for (row, factor) in moved {
            let Some(view) = matrix.outer_view(*row as usize) else {
                continue;
            };
            for (col, value) in view.iter() {
                let scaled = factor * value;
                let target = transformation.rows[col].entries();
                entries.extend(target.map(|(dof, lever)| (dof, scaled * lever)));
            }
        }
        // A stable sort keeps the terms of one column in the order of the model, so that their sum is always the same.
        entries.sort_by_key(|(col, _)| *col);
        let mut row = Self { columns: Vec::with_capacity(entries.len()), values: Vec::with_capacity(entries.len()) };
        for (col, value) in entries {
            if row.columns.last() == Some(&col) {
                if let Some(sum) = row.values.last_mut() {
                    *sum += value;
                }
            } else {
                row.columns.push(col);
                row.values.push(value);
            }
        }
        row
    }
}

/// The largest (|T|ᵀ|A||T|)_ii / (TᵀAT)_ii: how much larger the terms of a rigid node's stiffness are than their sum.
/// Rounding of the data reaches the node's row enlarged by this factor.
pub(super) fn cancellation(matrix: &SparseMatrix, product: &SparseMatrix, transformation: &Transformation) -> f64 {
    let mut sums: std::collections::BTreeMap<u32, f64> = std::collections::BTreeMap::new();
    for (row, entries) in transformation.rows.iter().enumerate() {
        let TransformationRow::Rigid(entries) = entries else {
            continue;
        };
        let Some(view) = matrix.outer_view(row) else { continue };
        for (col, value) in view.iter() {
            let TransformationRow::Rigid(others) = &transformation.rows[col] else {
                continue;
            };
            for (dof, factor) in entries {
                let lever = others.iter().find(|(other, _)| other == dof).map_or(0.0, |(_, lever)| *lever);
                *sums.entry(*dof).or_default() += (factor * value * lever).abs();
            }
        }
    }
    let ratio = |(dof, sum): (u32, f64)| {
        let left = product.get(dof as usize, dof as usize).copied().unwrap_or(0.0);
        if left > 0.0 { sum / left } else { 1.0 }
    };
    sums.into_iter().map(ratio).fold(1.0, f64::max)
}
