//! Loads in text: Matrix Market files of as many rows as the matrices have, one column for each load.
//!
//! `array` files list every value, column by column; `coordinate` files list `row column value`, and values at one place are added up.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::banner::{excerpt, is_comment};
use super::entries::number;
use super::source::{Source, read_error};
use crate::error::{Error, Result};
use crate::regular_file::unchanged;

/// The longest line.
const MAX_LINE_BYTES: u64 = 1 << 12;

const BANNERS: &str = "`%%MatrixMarket matrix array real general` or `%%MatrixMarket matrix coordinate real general`";

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

/// How a file lists its values.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Layout {
    Array,
    Coordinate,
}

/// What a file says of its size.
struct Size {
    n_columns: u64,
    n_entries: u64,
}

fn read(wanted: WantedColumn<'_>) -> Result<LoadColumn> {
    let mut lines = Lines::open(wanted.path)?;
    let layout = banner(&mut lines)?;
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
    Ok(LoadColumn { values, digest: lines.source.get_ref().digest() })
}

fn banner(lines: &mut Lines<'_>) -> Result<Layout> {
    let is_there = lines.advance_to_banner()?;
    let text = if is_there { lines.text().to_ascii_lowercase() } else { String::new() };
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    match words[..] {
        ["%%matrixmarket", "matrix", "array", "real" | "integer", "general"] => Ok(Layout::Array),
        ["%%matrixmarket", "matrix", "coordinate", "real" | "integer", "general"] => Ok(Layout::Coordinate),
        _ if !is_there => Err(Error::NoData { path: lines.path(), expected: "a load in Matrix Market form" }),
        _ => Err(lines.format_error(BANNERS)),
    }
}

fn size_line(lines: &mut Lines<'_>, layout: Layout, wanted: WantedColumn<'_>) -> Result<Size> {
    let expected = match layout {
        Layout::Array => "a size line of two whole numbers, `rows columns`",
        Layout::Coordinate => "a size line of three whole numbers, `rows columns entries`",
    };
    let numbers: Option<Vec<u64>> = match lines.advance()? {
        true => lines.text().split_ascii_whitespace().map(|field| field.parse().ok()).collect(),
        false => None,
    };
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

/// The lines of a text file that hold data.
struct Lines<'a> {
    file: &'a Path,
    source: BufReader<Source>,
    /// Number of the line that was read last, from 1.
    line: u64,
    bytes: Vec<u8>,
}

impl<'a> Lines<'a> {
    fn open(file: &'a Path) -> Result<Self> {
        Ok(Self { file, source: BufReader::new(Source::open(file)?), line: 0, bytes: Vec::new() })
    }

    fn path(&self) -> std::path::PathBuf {
        self.file.to_owned()
    }

    /// Reads the next line; false at the end of the file.
    fn next_line(&mut self) -> Result<bool> {
        self.bytes.clear();
        let read = self.source.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut self.bytes);
        let n_read = read.map_err(|error| read_error(self.file, error))? as u64;
        self.line += 1;
        if n_read == MAX_LINE_BYTES {
            return Err(Error::LineTooLong { path: self.path(), line: self.line, limit: MAX_LINE_BYTES as usize });
        }
        Ok(n_read > 0)
    }

    /// Goes to the next line with data; false at the end of the file.
    fn advance(&mut self) -> Result<bool> {
        while self.next_line()? {
            let text = self.bytes.trim_ascii();
            if !text.is_empty() && !is_comment(text) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Goes to the first line that is not blank, comment or banner.
    fn advance_to_banner(&mut self) -> Result<bool> {
        while self.next_line()? {
            if !self.bytes.trim_ascii().is_empty() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The line without blanks around it.
    fn text(&self) -> std::borrow::Cow<'_, str> {
        let text = self.bytes.strip_prefix(b"\xef\xbb\xbf".as_slice()).unwrap_or(&self.bytes);
        String::from_utf8_lossy(text.trim_ascii())
    }

    fn format_error(&self, expected: &'static str) -> Error {
        let found = match self.bytes.trim_ascii() {
            b"" => "end of file".to_owned(),
            text => excerpt(text),
        };
        Error::LoadFormat { path: self.path(), line: self.line, found, expected }
    }

    /// `row column value` with indices up to `sizes`, which are returned from zero.
    fn entry(&self, sizes: [u64; 2]) -> Result<(u64, u64, f64)> {
        let row = self.index(0, "row", sizes[0])?;
        let column = self.index(1, "column", sizes[1])?;
        Ok((row, column, self.value([row, column], 2)?))
    }

    fn field(&self, at: usize) -> &[u8] {
        self.bytes
            .trim_ascii()
            .split(u8::is_ascii_whitespace)
            .filter(|field| !field.is_empty())
            .nth(at)
            .unwrap_or_default()
    }

    fn index(&self, at: usize, field: &'static str, n: u64) -> Result<u64> {
        let text = self.field(at);
        let index = std::str::from_utf8(text).ok().and_then(|text| text.parse::<u64>().ok());
        let (path, line) = (self.path(), self.line);
        match index {
            Some(index) if (1..=n).contains(&index) => Ok(index - 1),
            Some(found) => Err(Error::EntryIndex { path, line, field, found, n }),
            None => {
                Err(Error::EntryField { path, line, field, found: excerpt(text), expected: "a whole number from 1" })
            }
        }
    }

    /// The number in the last field of the line, the entry at a place.
    fn value(&self, [row, column]: [u64; 2], at: usize) -> Result<f64> {
        let (path, line, text) = (self.path(), self.line, self.field(at));
        if !self.field(at + 1).is_empty() {
            return Err(Error::EntryExcess { path, line, found: excerpt(self.field(at + 1)) });
        }
        match number(text) {
            Some(value) if value.is_finite() => Ok(value),
            Some(_) => Err(Error::NonFinite { path, line, row: row + 1, col: column + 1, found: excerpt(text) }),
            None => Err(Error::EntryField { path, line, field: "value", found: excerpt(text), expected: "a number" }),
        }
    }
}
