//! Columns of numbers in text: Matrix Market files of as many rows as the matrices have.
//!
//! `array` files list every value, column by column; `coordinate` files list `row column value`, and values at one place are added up.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::banner::{excerpt, is_comment};
use super::entries::number;
use super::source::{Source, read_error};
use crate::error::{Error, Result};

/// The longest line.
const MAX_LINE_BYTES: u64 = 1 << 12;

const BANNERS: &str = "`%%MatrixMarket matrix array real general` or `%%MatrixMarket matrix coordinate real general`";

/// What the columns of a file are wanted for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose<'a> {
    /// The load of this name.
    Load(&'a str),
    /// The modes of a reduction.
    Modes,
}

impl Purpose<'_> {
    fn expected(self) -> &'static str {
        match self {
            Self::Load(_) => "a load in Matrix Market form",
            Self::Modes => "modes in Matrix Market form",
        }
    }

    fn format_error(self, path: &Path, line: u64, (found, expected): (String, &'static str)) -> Error {
        let path = path.to_owned();
        match self {
            Self::Load(_) => Error::LoadFormat { path, line, found, expected },
            Self::Modes => Error::ModesFormat { path, line: Some(line), found: format!("`{found}`"), expected },
        }
    }

    /// The error of a file that has another number of rows than the matrices.
    fn rows_error(self, path: &Path, found: u64, n: usize) -> Error {
        let path = path.to_owned();
        match self {
            Self::Load(load) => Error::LoadRows { path, load: load.to_owned(), found, n },
            Self::Modes => Error::ModesRows { path, found, n },
        }
    }
}

/// A number of a file with its row and column, both from zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) row: usize,
    pub(super) column: u64,
    pub(super) value: f64,
}

/// A file whose head has been read.
pub(super) struct ColumnFile<'a> {
    lines: Lines<'a>,
    layout: Layout,
    n_rows: usize,
    pub(super) n_columns: u64,
    n_entries: u64,
}

/// How a file lists its values.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Layout {
    Array,
    Coordinate,
}

impl<'a> ColumnFile<'a> {
    /// Opens a file, plain or gzipped, and reads its banner and its size line.
    ///
    /// # Errors
    /// A file that cannot be read, is no Matrix Market file of columns, or has another number of rows.
    pub(super) fn open(path: &'a Path, purpose: Purpose<'a>, n_rows: usize) -> Result<Self> {
        let mut lines = Lines::open(path, purpose)?;
        let layout = banner(&mut lines)?;
        let [n_columns, n_entries] = size_line(&mut lines, layout, n_rows)?;
        Ok(Self { lines, layout, n_rows, n_columns, n_entries })
    }

    /// Hands every entry to `take`, and gives the digest of the file.
    ///
    /// # Errors
    /// A line that is no entry, entries that are missing or too many; those of `take`.
    pub(super) fn read(mut self, mut take: impl FnMut(Entry) -> Result<()>) -> Result<String> {
        let n_rows = self.n_rows as u64;
        let mut n_read = 0u64;
        while self.lines.advance()? {
            if n_read == self.n_entries {
                let (path, line) = (self.lines.path(), self.lines.line);
                return Err(Error::EntriesSurplus { path, line, declared: self.n_entries });
            }
            let (row, column, value) = match self.layout {
                Layout::Array => {
                    let at = [n_read % n_rows, n_read / n_rows];
                    (at[0], at[1], self.lines.value(at, 0)?)
                }
                Layout::Coordinate => self.lines.entry([n_rows, self.n_columns])?,
            };
            take(Entry { row: row as usize, column, value })?;
            n_read += 1;
        }
        if n_read < self.n_entries {
            return Err(Error::EntryCount { path: self.lines.path(), declared: self.n_entries, found: n_read });
        }
        Ok(self.lines.source.get_ref().digest())
    }
}

fn banner(lines: &mut Lines<'_>) -> Result<Layout> {
    let is_there = lines.advance_to_banner()?;
    let text = if is_there { lines.text().to_ascii_lowercase() } else { String::new() };
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    match words[..] {
        ["%%matrixmarket", "matrix", "array", "real" | "integer", "general"] => Ok(Layout::Array),
        ["%%matrixmarket", "matrix", "coordinate", "real" | "integer", "general"] => Ok(Layout::Coordinate),
        _ if !is_there => Err(Error::NoData { path: lines.path(), expected: lines.purpose.expected() }),
        _ => Err(lines.format_error(BANNERS)),
    }
}

/// Columns and entries of the file.
fn size_line(lines: &mut Lines<'_>, layout: Layout, n_rows: usize) -> Result<[u64; 2]> {
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
    if rows != n_rows as u64 {
        return Err(lines.purpose.rows_error(lines.file, rows, n_rows));
    }
    let n_entries = declared.or_else(|| rows.checked_mul(n_columns));
    Ok([n_columns, n_entries.ok_or_else(|| lines.format_error(expected))?])
}

/// The lines of a text file that hold data.
struct Lines<'a> {
    file: &'a Path,
    purpose: Purpose<'a>,
    source: BufReader<Source>,
    /// Number of the line that was read last, from 1.
    line: u64,
    bytes: Vec<u8>,
}

impl<'a> Lines<'a> {
    fn open(file: &'a Path, purpose: Purpose<'a>) -> Result<Self> {
        Ok(Self { file, purpose, source: BufReader::new(Source::open(file)?), line: 0, bytes: Vec::new() })
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
        self.purpose.format_error(self.file, self.line, (found, expected))
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
