//! Compressed rows or columns as they were read, and their checks.

use std::path::Path;

use crate::error::{Error, Result};
use crate::number::counted;
use crate::sparse::Triplets;

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
    indices: Vec<i64>,
    values: Vec<f64>,
    /// Paths in the file of pointers, indices and values.
    names: [String; 3],
}

impl Compressed {
    pub(super) fn new(
        major: Major,
        shape: [u64; 2],
        pointers: Vec<i64>,
        indices: Vec<i64>,
        values: Vec<f64>,
        names: [String; 3],
    ) -> Self {
        Self { major, shape, pointers, indices, values, names }
    }

    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The number of rows, once shape, lengths and pointers are certain to fit together.
    pub(super) fn check(&self, path: &Path, group: &str) -> Result<usize> {
        let [n_rows, n_cols] = self.shape;
        let (file, group) = (path.to_owned(), group.to_owned());
        let n = match u32::try_from(n_rows) {
            Ok(n) if n_rows == n_cols => n as usize,
            _ => {
                return Err(Error::Hdf5NotSquare { path: file, group, n_rows, n_cols });
            }
        };
        if n == 0 {
            return Err(Error::Hdf5EmptyMatrix { path: file, group });
        }
        if self.pointers.len() != n + 1 {
            let expected = format!("{} values, one more than the {n} rows or columns", n + 1);
            return Err(self.wrong_length(path, 0, self.pointers.len(), expected));
        }
        if self.indices.len() != self.values.len() {
            let expected = format!("{} values, as many as {}", self.values.len(), self.names[2]);
            return Err(self.wrong_length(path, 1, self.indices.len(), expected));
        }
        self.check_pointers(path)?;
        Ok(n)
    }

    /// The entries; indices and values are checked on the way.
    pub(super) fn into_triplets(self, path: &Path) -> Result<Triplets> {
        let n = self.pointers.len().saturating_sub(1);
        let majors = majors(&self.pointers);
        let minors = self
            .indices
            .iter()
            .enumerate()
            .map(|(position, &index)| match u32::try_from(index) {
                Ok(minor) if (minor as usize) < n => Ok(minor),
                _ => Err(Error::Hdf5Index {
                    path: path.to_owned(),
                    dataset: self.names[1].clone(),
                    position,
                    found: index,
                    first: 0,
                    last: n as i64 - 1,
                }),
            })
            .collect::<Result<Vec<u32>>>()?;
        let (rows, cols) = match self.major {
            Major::Rows => (majors, minors),
            Major::Columns => (minors, majors),
        };
        if let Some(entry) = self.values.iter().position(|v| !v.is_finite()) {
            let (row, col, value) = (rows[entry], cols[entry], self.values[entry]);
            let dataset = self.names[2].clone();
            return Err(Error::Hdf5NotFinite { path: path.to_owned(), dataset, row, col, value });
        }
        Ok(Triplets { rows, cols, values: self.values })
    }

    fn check_pointers(&self, path: &Path) -> Result<()> {
        let n_entries = self.values.len() as i64;
        let wrong = |position: usize, found: i64, expected: String| {
            let (path, dataset) = (path.to_owned(), self.names[0].clone());
            Err(Error::Hdf5Pointer { path, dataset, position, found, expected })
        };
        let mut previous = 0;
        for (position, &pointer) in self.pointers.iter().enumerate() {
            if position == 0 && pointer != 0 {
                return wrong(position, pointer, "0".to_owned());
            }
            if pointer < previous {
                return wrong(position, pointer, format!("at least {previous}, the pointer before it"));
            }
            previous = pointer;
        }
        if previous != n_entries {
            let expected = format!("{n_entries}, the number of values in {}", self.names[2]);
            return wrong(self.pointers.len() - 1, previous, expected);
        }
        Ok(())
    }

    fn wrong_length(&self, path: &Path, dataset: usize, found: usize, expected: String) -> Error {
        let (path, object) = (path.to_owned(), self.names[dataset].clone());
        Error::Hdf5Shape { path, object, found: counted(found, "value", "values"), expected }
    }
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
