//! Rectangular matrices in Matrix Market form: loads and modes in columns, quantities and constraints in rows.
//!
//! `array` files list every value, column by column; `coordinate` files list `row column value`, and values at one place are added up.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use super::banner::{excerpt, is_comment};
use super::fortran::{Values, real};
use super::source::{Source, read_error};
use crate::error::{Error, Result};

/// The longest line.
const MAX_LINE_BYTES: u64 = 1 << 12;

const BANNERS: &str = "`%%MatrixMarket matrix array real general` or `%%MatrixMarket matrix coordinate real general`";

/// What a file is read for, and which size that asks of it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Content<'a> {
    /// The load of this name, of a value for each row of the matrices.
    Load { load: &'a str, n_rows: usize },
    /// The modes of a reduction, of a value for each row of the matrices.
    Modes { n_rows: usize },
    /// A row for each name of a quantity, a column for each row of the matrices.
    Quantities { n_names: usize, n_rows: usize },
    /// A row for each constraint, a column for each row of the matrices.
    Constraints { n_rows: usize },
}

impl Content<'_> {
    fn expected(self) -> &'static str {
        match self {
            Self::Load { .. } => "a load in Matrix Market form",
            Self::Modes { .. } => "modes in Matrix Market form",
            Self::Quantities { .. } => "rows of quantities in Matrix Market form",
            Self::Constraints { .. } => "constraints in Matrix Market form",
        }
    }

    /// The error of a line that is none of the format.
    fn format_error(self, path: PathBuf, line: u64, (found, expected): (String, &'static str)) -> Error {
        match self {
            Self::Load { .. } => Error::LoadFormat { path, line, found, expected },
            Self::Modes { .. } => Error::ModesFormat { path, line: Some(line), found: format!("`{found}`"), expected },
            Self::Quantities { .. } => Error::QuantityFormat { path, line, found, expected },
            Self::Constraints { .. } => Error::ConstraintFormat { path, line, found, expected },
        }
    }

    /// Refuses rows and columns of a file that do not fit the matrices or the names.
    fn refuse_other_sizes(self, path: PathBuf, [rows, columns]: [u64; 2]) -> Result<()> {
        match self {
            Self::Load { load, n_rows: n } if rows != n as u64 => {
                Err(Error::LoadRows { path, load: load.to_owned(), found: rows, n })
            }
            Self::Modes { n_rows: n } if rows != n as u64 => Err(Error::ModesRows { path, found: rows, n }),
            Self::Quantities { n_names, n_rows } if [rows, columns] != [n_names as u64, n_rows as u64] => {
                Err(Error::QuantitySize { path, rows, columns, n_names: n_names as u64, n: n_rows as u64 })
            }
            Self::Constraints { n_rows: n } if columns != n as u64 => {
                Err(Error::ConstraintSize { path, columns, n: n as u64 })
            }
            Self::Load { .. } | Self::Modes { .. } | Self::Quantities { .. } | Self::Constraints { .. } => Ok(()),
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
pub(super) struct RectangularFile<'a> {
    lines: Lines<'a>,
    layout: Layout,
    /// Rows that the size line says.
    pub(super) n_rows: u64,
    /// Columns that the size line says.
    pub(super) n_columns: u64,
    n_entries: u64,
}

/// How a file lists its values.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Layout {
    Array,
    Coordinate,
}

impl<'a> RectangularFile<'a> {
    /// Opens a file, plain or gzipped, and reads its banner and its size line.
    ///
    /// # Errors
    /// A file that cannot be read, is no rectangular matrix in Matrix Market form, or has another size than its content asks.
    pub(super) fn open(path: &'a Path, content: Content<'a>) -> Result<Self> {
        let mut lines = Lines::open(path, content)?;
        let layout = lines.banner()?;
        let (expected, numbers) = lines.sizes(layout)?;
        let (n_rows, n_columns, declared) = match (layout, numbers.as_deref()) {
            (Layout::Array, Some([rows, columns])) => (*rows, *columns, rows.checked_mul(*columns)),
            (Layout::Coordinate, Some([rows, columns, entries])) => (*rows, *columns, Some(*entries)),
            _ => return Err(lines.format_error(expected)),
        };
        content.refuse_other_sizes(lines.path(), [n_rows, n_columns])?;
        let n_entries = declared.ok_or_else(|| lines.format_error(expected))?;
        Ok(Self { lines, layout, n_rows, n_columns, n_entries })
    }

    /// Hands every entry to `take`, and gives the BLAKE3 digest of the file.
    ///
    /// # Errors
    /// A line that is no entry, entries that are missing or too many; those of `take`.
    pub(super) fn read(mut self, mut take: impl FnMut(Entry) -> Result<()>) -> Result<String> {
        let mut n_read = 0u64;
        while self.lines.advance()? {
            if n_read == self.n_entries {
                let (path, line) = (self.lines.path(), self.lines.line);
                return Err(Error::EntriesSurplus { path, line, declared: self.n_entries });
            }
            let (row, column, value) = match self.layout {
                Layout::Array => {
                    let at = [n_read % self.n_rows, n_read / self.n_rows];
                    (at[0], at[1], self.lines.value(at, 0)?)
                }
                Layout::Coordinate => self.lines.entry([self.n_rows, self.n_columns])?,
            };
            take(Entry { row: row as usize, column, value })?;
            n_read += 1;
        }
        if n_read < self.n_entries {
            let (path, line) = (self.lines.path(), self.lines.line.saturating_sub(1));
            return Err(Error::EntryCount { path, line, declared: self.n_entries, found: n_read });
        }
        Ok(self.lines.source.get_ref().digest())
    }
}

/// The lines of a text file that hold data.
struct Lines<'a> {
    content: Content<'a>,
    file: &'a Path,
    source: BufReader<Source>,
    /// Number of the line that was read last, from 1.
    line: u64,
    bytes: Vec<u8>,
}

impl<'a> Lines<'a> {
    fn open(file: &'a Path, content: Content<'a>) -> Result<Self> {
        Ok(Self { content, file, source: BufReader::new(Source::open(file)?), line: 0, bytes: Vec::new() })
    }

    fn path(&self) -> PathBuf {
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

    /// Reads the banner.
    fn banner(&mut self) -> Result<Layout> {
        let is_there = self.advance_to_banner()?;
        let text = if is_there { self.text().to_ascii_lowercase() } else { String::new() };
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words[..] {
            ["%%matrixmarket", "matrix", layout @ ("array" | "coordinate"), field, "general"]
                if Values::of_banner(field).is_some() =>
            {
                Ok(if layout == "array" { Layout::Array } else { Layout::Coordinate })
            }
            _ if !is_there => Err(Error::NoData { path: self.path(), expected: self.content.expected() }),
            _ => Err(self.format_error(BANNERS)),
        }
    }

    /// Reads the size line: what it should be, and its numbers where they are whole.
    fn sizes(&mut self, layout: Layout) -> Result<(&'static str, Option<Vec<u64>>)> {
        let expected = match layout {
            Layout::Array => "a size line of two whole numbers, `rows columns`",
            Layout::Coordinate => "a size line of three whole numbers, `rows columns entries`",
        };
        let numbers = match self.advance()? {
            true => self.text().split_ascii_whitespace().map(|field| field.parse().ok()).collect(),
            false => None,
        };
        Ok((expected, numbers))
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
        String::from_utf8_lossy(self.bytes.trim_ascii())
    }

    fn format_error(&self, expected: &'static str) -> Error {
        let found = match self.bytes.trim_ascii() {
            b"" => "end of file".to_owned(),
            text => excerpt(text),
        };
        self.content.format_error(self.path(), self.line, (found, expected))
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
        match real(text) {
            Some(value) if value.is_finite() => Ok(value),
            Some(_) => Err(Error::NonFinite { path, line, row: row + 1, col: column + 1, found: excerpt(text) }),
            None => Err(Error::EntryField { path, line, field: "value", found: excerpt(text), expected: "a number" }),
        }
    }
}
