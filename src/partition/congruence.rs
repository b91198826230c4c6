//! The congruence TᵀAT of a symmetric sparse matrix, row by row and in parallel.
//!
//! Rows are counted first and then written where they stay: the result is the only memory of its size.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::transformation::{DofOrigin, Transformation, TransformationRow};
use crate::sparse::SparseMatrix;

/// Rows of the result computed by one task; a fixed number, so that the work is cut the same way on every machine.
const ROWS_PER_TASK: usize = 512;

/// TᵀAT, n' × n', bitwise symmetric for a bitwise symmetric A.
pub(super) fn congruence(matrix: &SparseMatrix, transformation: &Transformation) -> SparseMatrix {
    let n = transformation.dofs.len();
    let moved = Moved::by(transformation);
    let mut lengths = vec![0; n];
    lengths.par_chunks_mut(ROWS_PER_TASK).enumerate().for_each(|(task, lengths)| {
        let mut row = Row::default();
        for (at, length) in lengths.iter_mut().enumerate() {
            *length = row.gather(matrix, &moved, task * ROWS_PER_TASK + at).n_columns();
        }
    });
    let pointers: Vec<usize> = std::iter::once(0)
        .chain(lengths.iter().scan(0, |end, length| {
            *end += length;
            Some(*end)
        }))
        .collect();
    let (mut indices, mut values) = (vec![0; pointers[n]], vec![0.0; pointers[n]]);
    let tasks = cut(&pointers, &mut indices, &mut values);
    tasks.into_par_iter().enumerate().for_each(|(task, (indices, values))| {
        let mut row = Row::default();
        let mut places = indices.iter_mut().zip(values);
        for dof in (task * ROWS_PER_TASK..n).take(ROWS_PER_TASK) {
            let sums = row.gather(matrix, &moved, dof).sums();
            sums.zip(&mut places).for_each(|((col, sum), (index, value))| (*index, *value) = (col, sum));
        }
    });
    symmetrise(&pointers, &indices, &mut values, &moved);
    SparseMatrix::new((n, n), pointers, indices, values)
}

/// The rows of A that move with each dof.
struct Moved<'a> {
    transformation: &'a Transformation,
    /// Rows of A and factors for the dofs of rigid nodes; any other dof has one row, factor one.
    by_rigid_nodes: BTreeMap<usize, Vec<(u32, f64)>>,
}

impl<'a> Moved<'a> {
    fn by(transformation: &'a Transformation) -> Self {
        let mut by_rigid_nodes: BTreeMap<usize, Vec<(u32, f64)>> = BTreeMap::new();
        for (row, entries) in transformation.rows.iter().enumerate() {
            if let TransformationRow::Rigid(entries) = entries {
                for (dof, factor) in entries {
                    by_rigid_nodes.entry(*dof as usize).or_default().push((row as u32, *factor));
                }
            }
        }
        Self { transformation, by_rigid_nodes }
    }

    fn with(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> {
        let own = match self.transformation.dofs[dof].origin {
            DofOrigin::Row(row) => Some((row, 1.0)),
            DofOrigin::RigidNode(..) => None,
        };
        let several = self.by_rigid_nodes.get(&dof).into_iter().flatten();
        own.into_iter().chain(several.map(|(row, factor)| (*row as usize, *factor)))
    }
}

/// The terms of one row of TᵀAT, in memory used again for the next.
#[derive(Default)]
struct Row {
    /// Column of each term in the upper half, its place among the values in the lower: sorted, the terms of a column stay in
    /// the order of the model, so that their sum is always the same.
    keys: Vec<u64>,
    values: Vec<f64>,
    /// A single row of A, none of whose columns is a rigid node's: each term has its column to itself.
    is_permuted: bool,
}

impl Row {
    /// The rows that move with this dof, expanded by T.
    fn gather(&mut self, matrix: &SparseMatrix, moved: &Moved<'_>, dof: usize) -> &mut Self {
        self.keys.clear();
        self.values.clear();
        self.is_permuted = !moved.by_rigid_nodes.contains_key(&dof);
        for (row, factor) in moved.with(dof) {
            for (col, value) in matrix.outer_view(row).iter().flat_map(|row| row.iter()) {
                let targets = &moved.transformation.rows[col];
                self.is_permuted &= matches!(targets, TransformationRow::Dof(_));
                for (target, lever) in targets.entries() {
                    self.keys.push(u64::from(target) << 32 | self.values.len() as u64);
                    self.values.push(factor * value * lever);
                }
            }
        }
        self
    }

    fn n_columns(&mut self) -> usize {
        if self.is_permuted { self.keys.len() } else { self.sums().count() }
    }

    /// Columns in ascending order, and the sum of the terms of each.
    fn sums(&mut self) -> impl Iterator<Item = (u32, f64)> {
        self.keys.sort_unstable();
        let term = |key: &u64| self.values[(key & u64::from(u32::MAX)) as usize];
        let columns = self.keys.chunk_by(|left, right| left >> 32 == right >> 32);
        columns.map(move |keys| ((keys[0] >> 32) as u32, keys.iter().map(term).sum()))
    }
}

/// The parts of columns and values that belong to the rows of each task.
fn cut<'a>(pointers: &[usize], indices: &'a mut [u32], values: &'a mut [f64]) -> Vec<(&'a mut [u32], &'a mut [f64])> {
    let (mut indices, mut values) = (indices, values);
    let n = pointers.len() - 1;
    let mut part = |start: usize| {
        let length = pointers[(start + ROWS_PER_TASK).min(n)] - pointers[start];
        let take = "the pointers end where the entries do";
        (indices.split_off_mut(..length).expect(take), values.split_off_mut(..length).expect(take))
    };
    (0..n).step_by(ROWS_PER_TASK).map(&mut part).collect()
}

/// Replaces the entries of rigid nodes by the mean of the two sides of the diagonal: their sums are taken in different orders
/// there. All other entries are single terms.
fn symmetrise(pointers: &[usize], indices: &[u32], values: &mut [f64], moved: &Moved<'_>) {
    for dof in moved.by_rigid_nodes.keys() {
        for at in pointers[*dof]..pointers[dof + 1] {
            let other = indices[at] as usize;
            let row = pointers[other]..pointers[other + 1];
            let partner = indices[row.clone()].binary_search(&(*dof as u32)).expect("A has a symmetric pattern");
            let mean = 0.5 * (values[at] + values[row.start + partner]);
            values[at] = mean;
            values[row.start + partner] = mean;
        }
    }
}

/// The largest (|T|ᵀ|A||T|)_ii / (TᵀAT)_ii: how much larger the terms of a rigid node's stiffness are than their sum.
/// Rounding of the data reaches the node's row enlarged by this factor.
pub(super) fn cancellation(matrix: &SparseMatrix, product: &SparseMatrix, transformation: &Transformation) -> f64 {
    let mut sums: BTreeMap<u32, f64> = BTreeMap::new();
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
