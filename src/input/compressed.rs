//! Compressed rows or columns as they were read, and their checks.

use std::path::Path;

use super::MatrixInput;
use super::assembled::{Found, assembled, bytes_of_entry};
use super::digits::digits_of;
use super::format::MatrixSource;
use super::gathering::Gathered;
use super::indices::Indices;
use crate::error::{Error, Result};
use crate::number::counted;
use crate::regular_file::digest;
use crate::sparse::{Declared, MAX_ORDER, Triplets};

/// What the pointers count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Major {
    /// Compressed rows.
    Rows,
    /// Compressed columns.
    Columns,
}

/// A sparse matrix in compressed rows or columns, not yet trusted.
pub(super) struct Compressed {
    major: Major,
    /// Rows and columns as stated.
    shape: [u64; 2],
    pointers: Vec<i64>,
    indices: Indices,
    values: Vec<f64>,
    /// What messages call pointers, indices and values, by where they are in the file.
    names: [String; 3],
    /// What pointers and indices count from in the file, as messages show them.
    first: i64,
}

impl Compressed {
    pub(super) fn new(
        major: Major,
        shape: [u64; 2],
        pointers: Vec<i64>,
        indices: Indices,
        values: Vec<f64>,
        names: [String; 3],
    ) -> Self {
        Self { major, shape, pointers, indices, values, names, first: 0 }
    }

    /// Of pointers and indices that the file counts from `first`.
    #[cfg(feature = "hdf5")]
    pub(super) fn counted_from(self, first: i64) -> Self {
        Self { first, ..self }
    }

    /// Without what is reserved behind the last entry, which has no meaning: SciPy keeps it until a matrix is pruned.
    pub(super) fn without_reserve(mut self) -> Self {
        let n_entries = self.pointers.last().and_then(|last| usize::try_from(*last).ok());
        if let Some(n_entries) = n_entries.filter(|_| self.indices.len() == self.values.len()) {
            self.indices.truncate(n_entries);
            self.values.truncate(n_entries);
        }
        self
    }

    #[cfg(feature = "hdf5")]
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Whether an entry on the diagonal is not zero, as far as pointers and indices can be followed.
    #[cfg(feature = "hdf5")]
    pub(super) fn has_diagonal(&self) -> bool {
        self.pointers.windows(2).zip(0..).any(|(ends, major)| {
            let [first, last] = [ends[0], ends[1]].map(|end| usize::try_from(end).unwrap_or(usize::MAX));
            let entries = self
                .indices
                .numbers()
                .get(first..last)
                .unwrap_or_default()
                .iter()
                .zip(self.values.get(first..last).unwrap_or_default());
            entries.into_iter().any(|(minor, value)| i64::from(*minor) == major && *value != 0.0)
        })
    }

    /// The number of rows of the matrix of this name, once shape, lengths and pointers are certain to fit together.
    pub(super) fn check(&self, path: &Path, matrix: &str) -> Result<usize> {
        let n = order(path, matrix, self.shape)? as usize;
        self.check_parts(path, n)?;
        Ok(n)
    }

    /// Makes sure that lengths and pointers fit together, for so many rows, or columns where those are compressed.
    pub(super) fn check_parts(&self, path: &Path, n: usize) -> Result<()> {
        if self.pointers.len() != n + 1 {
            let expected = format!("{} values, one more than the {n} rows or columns", n + 1);
            return Err(self.wrong_length(path, 0, self.pointers.len(), expected));
        }
        if self.indices.len() != self.values.len() {
            let expected = format!("{} values, as many as {}", self.values.len(), self.names[2]);
            return Err(self.wrong_length(path, 1, self.indices.len(), expected));
        }
        self.check_pointers(path)
    }

    /// The matrix of this name, of entries that are declared, with values stored in so many digits at most.
    ///
    /// # Errors
    /// Those of [`Compressed::check`], [`Compressed::into_triplets`] and [`assembled`].
    pub(super) fn into_matrix(
        self,
        source: &MatrixSource<'_>,
        matrix: &str,
        (declared, stored_digits): (Declared, u32),
    ) -> Result<MatrixInput> {
        let path = source.file.as_path();
        let n = self.check(path, matrix)? as u32;
        let claim = source.allowance.claim(path);
        claim.set(bytes_of_entry(declared) * self.values.len() as u64)?;
        let digits = digits_of(&self.values).at_most(stored_digits);
        let triplets = self.into_triplets(path)?.into();
        let entries = Gathered { triplets, n_merged: 0, most_merged: 0, digits };
        assembled(Found { n, declared, entries, written: None, digest: digest(path)? }, source, &claim)
    }

    /// The entries; indices and values are checked on the way.
    pub(super) fn into_triplets(self, path: &Path) -> Result<Triplets> {
        let n = match self.major {
            Major::Rows => self.shape[1],
            Major::Columns => self.shape[0],
        };
        let majors = majors(&self.pointers);
        let minors = self.indices.below(n).map_err(|(position, found)| Error::MatrixIndex {
            path: path.to_owned(),
            array: self.names[1].clone(),
            position,
            found: found.saturating_add(self.first),
            first: self.first,
            last: n as i64 - 1 + self.first,
        })?;
        let (rows, cols) = match self.major {
            Major::Rows => (majors, minors),
            Major::Columns => (minors, majors),
        };
        if let Some(entry) = self.values.iter().position(|v| !v.is_finite()) {
            let (row, col, value) = (u64::from(rows[entry]) + 1, u64::from(cols[entry]) + 1, self.values[entry]);
            return Err(Error::MatrixNotFinite {
                path: path.to_owned(),
                matrix: self.names[2].clone(),
                row,
                col,
                value,
            });
        }
        Ok(Triplets { rows, cols, values: self.values })
    }

    fn check_pointers(&self, path: &Path) -> Result<()> {
        let n_entries = self.values.len() as i64;
        let wrong = |position: usize, found: i64, expected: String| {
            let (path, array) = (path.to_owned(), self.names[0].clone());
            Err(Error::MatrixPointer { path, array, position, found: found.saturating_add(self.first), expected })
        };
        let mut previous = 0;
        for (position, &pointer) in self.pointers.iter().enumerate() {
            if position == 0 && pointer != 0 {
                return wrong(position, pointer, self.first.to_string());
            }
            if pointer < previous {
                return wrong(position, pointer, format!("at least {}, the pointer before it", previous + self.first));
            }
            previous = pointer;
        }
        if previous != n_entries {
            let more = if self.first == 0 { "" } else { "one more than " };
            let expected = format!("{}, {more}the number of values in {}", n_entries + self.first, self.names[2]);
            return wrong(self.pointers.len() - 1, previous, expected);
        }
        Ok(())
    }

    fn wrong_length(&self, path: &Path, array: usize, found: usize, expected: String) -> Error {
        let (path, array) = (path.to_owned(), self.names[array].clone());
        Error::MatrixLength { path, array, found: counted(found, "value", "values"), expected }
    }
}

/// The order of a matrix of this many rows and columns, which must be square.
///
/// # Errors
/// [`Error::MatrixSize`].
pub(super) fn order(path: &Path, matrix: &str, [n_rows, n_cols]: [u64; 2]) -> Result<u32> {
    let limit = MAX_ORDER as u64;
    let n = u32::try_from(n_rows).ok().filter(|_| n_rows == n_cols && (1..=limit).contains(&n_rows));
    n.ok_or_else(|| Error::MatrixSize { path: path.to_owned(), matrix: matrix.to_owned(), n_rows, n_cols, limit })
}

/// The row or column of every entry, from checked pointers.
fn majors(pointers: &[i64]) -> Vec<u32> {
    let mut majors = Vec::new();
    for (major, pair) in pointers.windows(2).enumerate() {
        // Checked: pointers rise from zero to the number of entries, and the size fits 32 bits.
        majors.resize(pair[1] as usize, major as u32);
    }
    majors
}
