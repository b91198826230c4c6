//! Loads in text: Matrix Market files of as many rows as the matrices have, one column for each load.
//!
//! `array` files list every value, column by column; `coordinate` files list `row column value`, and values at one place are added up.

use std::path::Path;

use super::rectangular::{Content, Layout, Lines};
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
/// A file that cannot be read or is no Matrix Market file of loads; [`Error::LoadRows`] and [`Error::LoadColumn`] where it has another size;
/// [`Error::Changed`] where it is written meanwhile.
pub fn load_column(wanted: WantedColumn<'_>) -> Result<LoadColumn> {
    unchanged(wanted.path, || read(wanted))
}

/// What a file says of its size.
struct Size {
    n_columns: u64,
    n_entries: u64,
}

fn read(wanted: WantedColumn<'_>) -> Result<LoadColumn> {
    let mut lines = Lines::open(wanted.path, Content::Load)?;
    let layout = lines.banner()?;
    let size = size_line(&mut lines, layout, wanted)?;
    let column = column_of(&size, wanted)?;
    let n_rows = wanted.n_rows as u64;
    let mut values = vec![0.0; wanted.n_rows];
    let mut n_read = 0u64;
    while lines.advance()? {
        if n_read == size.n_entries {
            return Err(Error::EntriesSurplus { path: lines.path(), line: lines.line, declared: size.n_entries });
        }
        let (row, at, value) = match layout {
            Layout::Array => (n_read % n_rows, n_read / n_rows, lines.value([n_read % n_rows, n_read / n_rows], 0)?),
            Layout::Coordinate => lines.entry([n_rows, size.n_columns])?,
        };
        if at == column {
            values[row as usize] += value;
        }
        n_read += 1;
    }
    if n_read < size.n_entries {
        return Err(Error::EntryCount { path: lines.path(), declared: size.n_entries, found: n_read });
    }
    Ok(LoadColumn { values, digest: lines.digest() })
}

fn size_line(lines: &mut Lines<'_>, layout: Layout, wanted: WantedColumn<'_>) -> Result<Size> {
    let (expected, numbers) = lines.sizes(layout)?;
    let (rows, n_columns, declared) = match (layout, numbers.as_deref()) {
        (Layout::Array, Some([rows, columns])) => (*rows, *columns, None),
        (Layout::Coordinate, Some([rows, columns, entries])) => (*rows, *columns, Some(*entries)),
        _ => return Err(lines.format_error(expected)),
    };
    if rows != wanted.n_rows as u64 {
        let (load, n) = (wanted.load.to_owned(), wanted.n_rows);
        return Err(Error::LoadRows { path: lines.path(), load, found: rows, n });
    }
    let n_entries = declared.or_else(|| rows.checked_mul(n_columns));
    let n_entries = n_entries.ok_or_else(|| lines.format_error(expected))?;
    Ok(Size { n_columns, n_entries })
}

/// The column that is wanted, from zero.
fn column_of(size: &Size, wanted: WantedColumn<'_>) -> Result<u64> {
    let column = match (wanted.column, size.n_columns) {
        (None, 1) => Some(0),
        (None, _) => None,
        (Some(column), n_columns) => Some(column as u64).filter(|column| *column < n_columns),
    };
    column.ok_or_else(|| Error::LoadColumn {
        path: wanted.path.to_owned(),
        load: wanted.load.to_owned(),
        asked: wanted.column,
        n_columns: size.n_columns,
    })
}
