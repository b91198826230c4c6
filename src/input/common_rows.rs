//! K and M on the same rows: of one order, and where they name nodes and directions themselves, each row of one label.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::format::{OrderSource, ReadMatrix};
use super::row_label::RowLabel;
use super::{InputNote, MatrixInput};
use crate::dofs::{Direction, DofMap};
use crate::error::{Error, Result, Unnamed};
use crate::sparse::{Given, RowStorage, SparseMatrix, couples, filled, is_empty_row};

/// What each row of the files is; unknown for rows of which neither matrices nor a dof map say so.
#[derive(Clone, Debug, Default)]
pub struct RowLabels(Vec<Option<RowLabel>>);

impl RowLabels {
    /// Those of a dof map.
    pub(super) fn of_map(dofs: &DofMap) -> Self {
        let number = |direction| Direction::ALL.iter().zip(1u8..).find(|(other, _)| **other == direction);
        let label =
            |dof: &crate::dofs::Dof| number(dof.direction).map(|(_, component)| RowLabel { node: dof.node, component });
        Self(dofs.iter().map(|dof| dof.as_ref().and_then(label)).collect())
    }

    /// These with labels of scalar dofs, each of which is that of one row.
    ///
    /// # Errors
    /// [`Error::MatrixFormat`] for a label that two rows of the map at `path` have.
    pub(super) fn with_scalars(mut self, path: &Path, scalars: &[(usize, RowLabel)]) -> Result<Self> {
        let mut first_rows: HashMap<RowLabel, usize> = HashMap::new();
        for (row, label) in scalars {
            if let Some(first) = first_rows.insert(*label, *row) {
                let place = format!("row {}", row + 1);
                let found = format!("{label}, which is row {} too", first + 1);
                let (path, expected) = (path.to_owned(), "every scalar dof once".into());
                return Err(Error::MatrixFormat { path, format: "dof map", place, found, expected });
            }
            self.0[*row] = Some(*label);
        }
        Ok(self)
    }

    /// Label and direction of a row that belongs to no node, as a dof map has them.
    pub fn scalar_in_map(&self, row: usize) -> Option<String> {
        self.0.get(row).copied().flatten().filter(|label| label.dof().is_none()).map(RowLabel::in_map)
    }

    /// Those that a matrix names.
    pub(super) fn of_labels(labels: &[RowLabel]) -> Self {
        Self(labels.iter().copied().map(Some).collect())
    }

    /// The dof of each row; none where no row is known.
    pub(super) fn dof_map(&self) -> Option<DofMap> {
        (!self.0.is_empty()).then(|| self.0.iter().map(|label| (*label)?.dof()).collect())
    }

    /// The rows of a matrix that names its own among these, from zero.
    ///
    /// # Errors
    /// [`Error::RowsUnnamed`] where no row is known; [`Error::RowUnknown`] for a label that none has.
    fn rows_of(&self, path: &Path, labels: &[RowLabel]) -> Result<Vec<u32>> {
        if self.0.is_empty() {
            return Err(Error::RowsUnnamed { path: path.to_owned(), of: Unnamed::Model });
        }
        let numbered = self.0.iter().zip(0u32..).filter_map(|(label, row)| Some(((*label)?, row)));
        let rows: HashMap<RowLabel, u32> = numbered.collect();
        let missing: Vec<String> =
            labels.iter().filter(|label| !rows.contains_key(*label)).map(ToString::to_string).collect();
        if missing.is_empty() {
            return Ok(labels.iter().map(|label| rows[label]).collect());
        }
        Err(Error::RowUnknown { path: path.to_owned(), missing, n_rows: self.0.len() })
    }

    /// A matrix on these rows, where it names its own.
    ///
    /// # Errors
    /// Those of finding its rows.
    pub(super) fn placed(&self, read: ReadMatrix) -> Result<ReadMatrix> {
        let ReadMatrix { input, labels: Some(labels), last_line, .. } = read else { return Ok(read) };
        let rows = self.rows_of(&input.path, &labels)?;
        let matrix = renumbered(input.matrix, &rows, self.0.len());
        let input = MatrixInput { matrix, ..input };
        Ok(ReadMatrix { input, order: OrderSource::Labels, last_line, labels: None, frames: Ok(None) })
    }

    /// The rows that matrices name, where all do; those that a dof map names otherwise.
    ///
    /// # Errors
    /// [`Error::RowsUnnamed`] where one names its rows, another does not, and no map is there.
    pub(super) fn common(matrices: &[&ReadMatrix], (map, of): (Option<Self>, Unnamed)) -> Result<Self> {
        if matrices.iter().all(|matrix| matrix.labels.is_none()) {
            return Ok(Self::default());
        }
        if let Some(map) = map {
            return Ok(map);
        }
        let mut labels: Vec<RowLabel> = Vec::new();
        for matrix in matrices {
            let unnamed = || Error::RowsUnnamed { path: matrix.input.path.clone(), of };
            labels.extend(matrix.labels.as_ref().ok_or_else(unnamed)?);
        }
        let mut seen = HashSet::with_capacity(labels.len());
        let mut listed: Vec<(usize, RowLabel)> =
            labels.into_iter().filter(|label| seen.insert(*label)).enumerate().collect();
        match of {
            Unnamed::Reduced => listed.sort_by_key(|(at, label)| label.place_in_superelement(*at)),
            Unnamed::Model | Unnamed::Single => listed.sort_unstable_by_key(|(_, label)| *label),
        }
        Ok(Self(listed.into_iter().map(|(_, label)| Some(label)).collect()))
    }
}

/// A matrix of order n whose rows and columns have these numbers among its own.
fn renumbered(matrix: SparseMatrix, number: &[u32], n: usize) -> SparseMatrix {
    if number.len() == n && number.iter().zip(0..).all(|(number, row)| *number == row) {
        return matrix;
    }
    let mut old = vec![None; n];
    number.iter().enumerate().for_each(|(row, number)| old[*number as usize] = Some(row));
    let length = |row: &Option<usize>| row.and_then(|row| matrix.outer_view(row)).map_or(0, |row| row.nnz());
    let lengths: Vec<usize> = old.iter().map(length).collect();
    let RowStorage { pointers, indices, values } = filled(&lengths, Vec::new, |entries, row, indices, values| {
        let Some(view) = old[row].and_then(|row| matrix.outer_view(row)) else { return };
        entries.clear();
        entries.extend(view.iter().map(|(col, value)| (number[col], *value)));
        entries.sort_unstable_by_key(|(col, _)| *col);
        for ((index, value), (col, entry)) in indices.iter_mut().zip(values).zip(&*entries) {
            (*index, *value) = (*col, *entry);
        }
    });
    SparseMatrix::new((n, n), pointers, indices, values)
}

/// Brings K and M to one order, which only a matrix without a size line allows, and notes what each needed.
pub(super) fn fit_matrices(
    stiffness: ReadMatrix,
    mass: ReadMatrix,
    notes: &mut Vec<InputNote>,
) -> Result<(MatrixInput, MatrixInput)> {
    let (stiffness, stiffness_order) = take_notes(stiffness, notes);
    let (mass, mass_order) = take_notes(mass, notes);
    let (n_stiffness, n_mass) = (stiffness.matrix.rows(), mass.matrix.rows());
    if n_stiffness < n_mass && stiffness_order == OrderSource::LargestIndex {
        return Ok((extend(stiffness, n_mass, notes), mass));
    }
    if n_mass < n_stiffness && mass_order == OrderSource::LargestIndex {
        return Ok((stiffness, extend(mass, n_stiffness, notes)));
    }
    if n_stiffness != n_mass {
        let (stiffness, mass) = (stiffness.path, mass.path);
        return Err(Error::SizeMismatch { stiffness, n_stiffness, mass, n_mass });
    }
    Ok((stiffness, mass))
}

/// The matrix, where its order comes from, and what reading it needed.
pub(super) fn take_notes(matrix: ReadMatrix, notes: &mut Vec<InputNote>) -> (MatrixInput, OrderSource) {
    let ReadMatrix { input, order, last_line, .. } = matrix;
    if order == OrderSource::LargestIndex {
        notes.push(InputNote::OrderFromIndices { path: input.path.clone(), n: input.matrix.rows() });
    }
    if last_line == super::blocks::LastLine::Open {
        notes.push(InputNote::OpenLastLine { path: input.path.clone() });
    }
    if input.notes.n_duplicates > 0 {
        notes.push(InputNote::Duplicates { path: input.path.clone(), count: input.notes.n_duplicates });
    }
    if input.notes.given != Given::Whole {
        notes.push(InputNote::Mirrored { path: input.path.clone(), given: input.notes.given });
    }
    (input, order)
}

/// A mass without entries from some row on, where K couples one of these rows with others of them alone: an element without mass. A file that
/// states no size and was cut short looks so. Nodes that single springs and rigid parts have at the end of a model are coupled with others.
pub(super) fn ends_early(stiffness: &SparseMatrix, mass: &MatrixInput) -> Option<InputNote> {
    let n = stiffness.rows();
    let first = (0..n).rev().find(|row| !is_empty_row(&mass.matrix, *row)).map_or(0, |last| last + 1);
    let is_of_element =
        |row: usize| couples(stiffness, row, |other| other != row) && !couples(stiffness, row, |other| other < first);
    let (path, from, to) = (mass.path.clone(), first, n);
    (first..n).any(is_of_element).then_some(InputNote::MassEndsEarly { path, from, to })
}

/// Adds empty rows and columns up to the order n.
fn extend(input: MatrixInput, n: usize, notes: &mut Vec<InputNote>) -> MatrixInput {
    notes.push(InputNote::Extended { path: input.path.clone(), from: input.matrix.rows(), to: n });
    let (mut pointers, indices, data) = input.matrix.into_raw_storage();
    pointers.resize(n + 1, indices.len());
    MatrixInput { matrix: SparseMatrix::new((n, n), pointers, indices, data), ..input }
}
