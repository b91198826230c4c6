//! The entries of K by their sizes, in which equal numbers round equally.

use rayon::prelude::*;

use super::transformation::{DofOrigin, Transformation};
use super::transformation_row::TransformationRow;
use crate::cache::Key;
use crate::sparse::{Rounding, SparseMatrix, diagonal, ends};

/// Entries of a unit of parallel work, at least: fixed, so that sums never depend on the number of threads.
const ENTRIES_PER_TASK: usize = 1 << 16;

/// Entries of the model that a patch or a constraint has taken up: those of rows that follow dofs, and of dofs that others follow.
#[derive(Debug)]
pub(super) struct PatchEntries {
    /// How these rows follow the dofs of the partition.
    pub(super) rows: Vec<Box<[(u32, f64)]>>,
    /// Entries with at least one such row, one of each pair: places in the extended motion, and the value.
    pub(super) entries: Vec<Entry>,
}

impl PatchEntries {
    /// Goes on with a key.
    pub(super) fn key(&self, key: Key) -> Key {
        let Self { rows, entries } = self;
        let key = rows.iter().fold(key.numbers(&[rows.len()]), |key, row| key.shown(row));
        let places: Vec<u32> = entries.iter().flat_map(|entry| [entry.row, entry.col]).collect();
        let values: Vec<f64> = entries.iter().map(|entry| entry.value).collect();
        key.numbers(&places).numbers(&values)
    }
}

/// An entry of the upper triangle: its place in the motion extended by the rows of patches, and its value, or what stands for the size
/// of its parts where it was added up from such.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) row: u32,
    pub(super) col: u32,
    pub(super) value: f64,
}

impl PatchEntries {
    /// The entries of patches in a matrix of the model.
    pub(super) fn of(matrix: &SparseMatrix, transformation: &Transformation, rounding: Rounding) -> Self {
        /// The place of a row at rest, whose entries do no work.
        const NOWHERE: u32 = u32::MAX;
        let n = transformation.dofs.len();
        let mut place = Vec::with_capacity(transformation.rows.len());
        let mut rows: Vec<Box<[(u32, f64)]>> = Vec::new();
        let followed = transformation.followed();
        for row in &transformation.rows {
            match row {
                TransformationRow::Dof(dof) if followed[*dof as usize] => {
                    place.push((n + rows.len()) as u32);
                    rows.push([(*dof, 1.0)].into());
                }
                TransformationRow::Dof(dof) => place.push(*dof),
                TransformationRow::Tied(entries) => {
                    place.push((n + rows.len()) as u32);
                    rows.push(entries.clone());
                }
                TransformationRow::Held => place.push(NOWHERE),
            }
        }
        let size = Sizes::of(matrix, rounding);
        let mut entries = Vec::new();
        let moves = |row: usize| place[row] != NOWHERE;
        let is_patch = |row: usize| moves(row) && place[row] as usize >= n;
        for row in (0..place.len()).filter(|row| is_patch(*row)) {
            let view = matrix.outer_view(row);
            for (col, value) in view.iter().flat_map(|view| view.iter()).filter(|(col, _)| moves(*col)) {
                if !is_patch(col) || col <= row {
                    entries.push(Entry { row: place[row], col: place[col], value: size.of_entry(*value, row, col) });
                }
            }
        }
        Self { rows, entries }
    }
}

impl PatchEntries {
    /// Adds A x̃, times a factor for each column, at the rows of patches: `moved` has x̃ at the dofs of the partition and behind them at
    /// those rows.
    pub(super) fn add_forces<const W: usize>(&self, moved: &[[f64; W]], factors: &[f64; W], forces: &mut [[f64; W]]) {
        let n = moved.len() - self.rows.len();
        let mut add = |row: u32, col: u32, value: f64| {
            if let Some(force) = (row as usize).checked_sub(n).and_then(|at| forces.get_mut(at)) {
                let columns = force.iter_mut().zip(&moved[col as usize]).zip(factors);
                columns.for_each(|((force, x), factor)| *force += factor * value * x);
            }
        };
        for Entry { row, col, value } in &self.entries {
            add(*row, *col, *value);
            if row != col {
                add(*col, *row, *value);
            }
        }
    }
}

/// The entries of a matrix of a partition, one of each pair, without those that patches and constraints have taken up.
pub(super) fn own_entries(matrix: &SparseMatrix, transformation: &Transformation) -> Vec<Entry> {
    let (dofs, followed) = (&transformation.dofs, transformation.followed());
    let is_own = |dof: usize| matches!(dofs[dof].origin, DofOrigin::Row(_)) && !followed[dof];
    let mut entries = Vec::new();
    for row in (0..dofs.len()).filter(|row| is_own(*row)) {
        let view = matrix.outer_view(row);
        let upper = view.iter().flat_map(|view| view.iter()).filter(|(col, _)| *col <= row && is_own(*col));
        entries.extend(upper.map(|(col, value)| Entry { row: row as u32, col: col as u32, value: *value }));
    }
    entries
}

/// What the roundings of the entries of a matrix are relative to.
struct Sizes {
    rounding: Rounding,
    /// The diagonal, where entries are sums of parts.
    diagonal: Vec<f64>,
}

impl Sizes {
    fn of(matrix: &SparseMatrix, rounding: Rounding) -> Self {
        Self { rounding, diagonal: if rounding.is_of_parts { diagonal(matrix) } else { Vec::new() } }
    }

    fn of_entry(&self, value: f64, row: usize, col: usize) -> f64 {
        if self.diagonal.is_empty() { value } else { self.rounding.size_of(value, ends(&self.diagonal, row, col)) }
    }
}

/// The entries of K or M in the order of their sizes.
#[derive(Debug)]
pub(super) struct Roundings {
    entries: Vec<Entry>,
}

impl Roundings {
    /// The entries of a matrix of a partition, without those that patches and constraints have taken up, and these as the model has them.
    pub(super) fn of(
        matrix: &SparseMatrix,
        transformation: &Transformation,
        patches: &PatchEntries,
        rounding: Rounding,
    ) -> Self {
        let size = Sizes::of(matrix, rounding);
        let mut entries = own_entries(matrix, transformation);
        for Entry { row, col, value } in &mut entries {
            *value = size.of_entry(*value, *row as usize, *col as usize);
        }
        entries.extend_from_slice(&patches.entries);
        // A zero in fixed point is a small number that was rounded.
        entries.retain(|entry| entry.value != 0.0 || rounding.absolute > 0.0);
        entries.par_sort_unstable_by(|a, b| {
            let size = |entry: &Entry| (entry.row, entry.col);
            a.value.abs().total_cmp(&b.value.abs()).then_with(|| size(a).cmp(&size(b)))
        });
        Self { entries }
    }

    /// Ranges of entries that are worked on together; none cuts the entries of one size.
    pub(super) fn tasks(&self) -> Vec<&[Entry]> {
        let mut rest = self.entries.as_slice();
        let mut tasks = Vec::new();
        while rest.len() > ENTRIES_PER_TASK {
            let size = rest[ENTRIES_PER_TASK].value.abs();
            let n_smaller = rest.partition_point(|entry| entry.value.abs() < size);
            let end = if n_smaller > 0 { n_smaller } else { rest.partition_point(|entry| entry.value.abs() <= size) };
            let (task, after) = rest.split_at(end);
            tasks.push(task);
            rest = after;
        }
        tasks.push(rest);
        tasks
    }
}
