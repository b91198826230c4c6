//! Loads: Matrix Market files of as many rows as the matrices have, one column for each load, or the load vectors of a superelement.

use std::path::Path;

use super::allowance::Allowance;
use super::file_start::FileStart;
use super::rectangular::{Content, RectangularFile};
use super::superelement_file;
use crate::error::{Error, Result};
use crate::regular_file::unchanged;

/// One column of a file of loads.
#[derive(Clone, Debug)]
pub struct LoadColumn {
    /// A force for every row of the files, in the units of the file.
    pub values: Vec<f64>,
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

/// Which column of a file is wanted, by whom, and how many rows it has to have.
#[derive(Clone, Copy, Debug)]
pub struct WantedColumn<'a> {
    /// The file.
    pub path: &'a Path,
    /// Name of the load.
    pub load: &'a str,
    /// Column from zero; the only one where absent.
    pub column: Option<usize>,
    /// Rows of the matrices as they are in their files.
    pub n_rows: usize,
}

/// Reads one column of a file of loads, plain or gzipped.
///
/// # Errors
/// A file that cannot be read or is neither a Matrix Market file of loads nor a superelement; [`Error::LoadRows`] and [`Error::LoadColumn`] where it has another size;
/// [`Error::Changed`] where it is written meanwhile; [`Error::MemoryRead`] for a superelement that `allowance` has no room for.
pub fn load_column(wanted: WantedColumn<'_>, allowance: &Allowance) -> Result<LoadColumn> {
    unchanged(wanted.path, || read(wanted, allowance))
}

fn read(wanted: WantedColumn<'_>, allowance: &Allowance) -> Result<LoadColumn> {
    if superelement_file::begins(&FileStart::of(wanted.path)?) {
        return of_superelement(wanted, allowance);
    }
    let file = RectangularFile::open(wanted.path, Content::Load { load: wanted.load, n_rows: wanted.n_rows })?;
    let column = column_of(file.n_columns, wanted)?;
    let mut values = vec![0.0; wanted.n_rows];
    let digest = file.read(|entry| {
        if entry.column == column {
            values[entry.row] += entry.value;
        }
        Ok(())
    })?;
    Ok(LoadColumn { values, digest })
}

/// A load vector that a superelement has.
fn of_superelement(wanted: WantedColumn<'_>, allowance: &Allowance) -> Result<LoadColumn> {
    let loads = superelement_file::load_vectors(wanted.path, allowance)?;
    let column = column_of(loads.columns.cols() as u64, wanted)? as usize;
    let values: Vec<f64> = (0..loads.columns.rows()).map(|row| loads.columns[(row, column)]).collect();
    if values.len() != wanted.n_rows {
        let (path, load, found) = (wanted.path.to_owned(), wanted.load.to_owned(), values.len() as u64);
        return Err(Error::LoadRows { path, load, found, n: wanted.n_rows });
    }
    Ok(LoadColumn { values, digest: loads.digest })
}

/// The column that is wanted, from zero.
fn column_of(n_columns: u64, wanted: WantedColumn<'_>) -> Result<u64> {
    let column = match (wanted.column, n_columns) {
        (None, 1) => Some(0),
        (None, _) => None,
        (Some(column), n_columns) => Some(column as u64).filter(|column| *column < n_columns),
    };
    column.ok_or_else(|| Error::LoadColumn {
        path: wanted.path.to_owned(),
        load: wanted.load.to_owned(),
        asked: wanted.column,
        n_columns,
    })
}
