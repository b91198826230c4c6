//! Expansion modes of a file: one in each column, a value for every row of the matrices.
//!
//! Matrix Market (`array` or `coordinate`), NumPy (`.npy`) and datasets of HDF5 files are told apart by their content.

use std::path::Path;

use super::Allowance;
use super::allowance::Claim;
use super::file_start::FileStart;
use super::hdf5_format;
use super::member::split_member;
use super::mode_matrix::{Meaning, NUMBER};
use super::npy;
use super::npy_header::is_array;
use super::rectangular::{Content, RectangularFile};
use crate::error::Result;
use crate::regular_file::{digest, unchanged};

/// The modes of a file.
#[derive(Clone, Debug)]
pub struct ModeColumns {
    /// For each mode a value for every row of the files, in the units of the file.
    pub columns: Vec<Vec<f64>>,
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

/// Reads the modes of a file, for matrices of `n_rows` rows in their files, in the memory that is allowed.
///
/// # Errors
/// A file that cannot be read or has no modes; [`ModesRows`](crate::error::Error::ModesRows) and
/// [`ModesColumns`](crate::error::Error::ModesColumns) where it has another size; [`MemoryRead`](crate::error::Error::MemoryRead);
/// [`Changed`](crate::error::Error::Changed) where it is written meanwhile.
pub fn mode_columns(path: &Path, n_rows: usize, allowance: &Allowance) -> Result<ModeColumns> {
    columns_of_numbers(path, (n_rows, Meaning::Shapes), allowance)
}

/// Reads the columns of a file, whatever its numbers mean.
///
/// # Errors
/// What [`mode_columns`] returns.
pub(super) fn columns_of_numbers(
    path: &Path,
    (n_rows, meaning): (usize, Meaning),
    allowance: &Allowance,
) -> Result<ModeColumns> {
    let (file, dataset) = split_member(path);
    unchanged(&file, || {
        let start = FileStart::of(&file)?;
        if start.is_hdf5() {
            let columns = hdf5_format::mode_columns(&file, dataset.as_deref(), n_rows, allowance)?;
            return Ok(ModeColumns { columns, digest: digest(&file)? });
        }
        let claim = allowance.claim(&file);
        if start.packing.is_none() && is_array(&start.head) {
            let columns = npy::columns(&file, (n_rows, meaning), &claim)?;
            return Ok(ModeColumns { columns, digest: digest(&file)? });
        }
        in_text(&file, (n_rows, meaning), &claim)
    })
}

fn in_text(path: &Path, (n_rows, meaning): (usize, Meaning), claim: &Claim<'_>) -> Result<ModeColumns> {
    let file = RectangularFile::open(path, Content::Modes { n_rows })?;
    let n_columns = meaning.checked_count(path, file.n_columns, n_rows)?;
    // A column takes its memory when it gets its first value: a head may promise any number of them.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let digest = file.read(|entry| {
        let column = entry.column as usize;
        if column >= columns.len() {
            columns.resize_with(column + 1, Vec::new);
        }
        let values = &mut columns[column];
        if values.is_empty() {
            claim.add(NUMBER * n_rows as u64)?;
            values.resize(n_rows, 0.0);
        }
        values[entry.row] += entry.value;
        Ok(())
    })?;
    let columns = meaning.completed(columns, [n_rows, n_columns])?;
    Ok(ModeColumns { columns, digest })
}
