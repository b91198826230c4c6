//! Modes as the columns of a matrix of numbers: how many there may be, how they lie, and whether all are numbers.

use std::path::Path;

use crate::error::{Error, Result};

/// Bytes of a number.
pub(super) const NUMBER: u64 = 8;

/// What the numbers of a file are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// A mode in each column, none of them zero everywhere.
    Shapes,
    /// A number of each of so many modes, in a column or in a row. Zeros are those of rigid-body motion.
    Values { n_modes: usize },
}

impl Meaning {
    /// The number of columns of a file.
    pub(super) fn checked_count(self, path: &Path, found: u64, n_rows: usize) -> Result<usize> {
        match self {
            Self::Shapes => checked_count(path, found, n_rows),
            Self::Values { n_modes } => checked_count(path, found, n_modes),
        }
    }

    /// All of the columns, where those without a number in the file are missing or empty.
    pub(super) fn completed(
        self,
        mut columns: Vec<Vec<f64>>,
        [n_rows, n_columns]: [usize; 2],
    ) -> Result<Vec<Vec<f64>>> {
        columns.resize_with(n_columns, Vec::new);
        if self == Self::Shapes
            && let Some(mode) = columns.iter().position(Vec::is_empty)
        {
            return Err(Error::ModesNothing { mode: mode + 1, found: "zero everywhere" });
        }
        columns.iter_mut().filter(|column| column.is_empty()).for_each(|column| column.resize(n_rows, 0.0));
        Ok(columns)
    }
}

/// The number of columns of a file: one at least, and no more than rows, which independent ones cannot be.
pub(super) fn checked_count(path: &Path, found: u64, n_rows: usize) -> Result<usize> {
    let count = usize::try_from(found).ok().filter(|count| (1..=n_rows).contains(count));
    count.ok_or_else(|| Error::ModesColumns { path: path.to_owned(), found, n_rows })
}

/// The columns of numbers that lie one after the other, row by row or column by column.
pub(super) fn columns_of(values: &[f64], [n_rows, n_columns]: [usize; 2], order: Order) -> Vec<Vec<f64>> {
    match order {
        Order::ByColumns => values.chunks_exact(n_rows).map(<[f64]>::to_vec).collect(),
        Order::ByRows => {
            (0..n_columns).map(|column| values.iter().skip(column).step_by(n_columns).copied().collect()).collect()
        }
    }
}

/// How the numbers of a matrix lie one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Row by row, as in C.
    ByRows,
    /// Column by column, as in Fortran.
    ByColumns,
}

/// Refuses the first number that is NaN or infinite, by its row and column from one.
///
/// # Errors
/// [`Error::ModesFormat`].
pub(super) fn refuse_not_finite(path: &Path, columns: &[Vec<f64>]) -> Result<()> {
    for (column, values) in columns.iter().enumerate() {
        if let Some(row) = values.iter().position(|value| !value.is_finite()) {
            let found = format!("`{}` in row {}, column {}", values[row], row + 1, column + 1);
            return Err(Error::ModesFormat { path: path.to_owned(), line: None, found, expected: "finite numbers" });
        }
    }
    Ok(())
}
