//! Tables of numbers in text with a header: comma, semicolon or tab between fields, plain or gzipped.

use std::cell::Cell;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::banner::excerpt;
use super::fortran::real;
use super::source::{Source, read_error};
use crate::error::{Error, Result};

/// The longest row.
const MAX_ROW_BYTES: u64 = 1 << 16;
/// Bytes that the parser of rows asks for at once.
const READ_AHEAD: usize = 1 << 13;

/// What stands between fields, the first of them that a header has.
const DELIMITERS: [u8; 3] = [b';', b'\t', b','];

/// A table being read, its header taken.
pub(super) struct Table {
    path: PathBuf,
    header: Vec<String>,
    rows: csv::Reader<Box<dyn Read>>,
    /// Where the text ends for the parser, in bytes from the first row, if no row ends before.
    end: Rc<Cell<u64>>,
    record: csv::StringRecord,
    n_header_lines: u64,
}

/// A row of a table and where it is.
pub(super) struct Row<'a> {
    path: &'a Path,
    header: &'a [String],
    record: &'a csv::StringRecord,
    /// Line number in the file, from 1.
    pub(super) line: u64,
}

/// The start of a text file: what stands before the first line of data, and that line.
pub(super) struct FirstLine {
    /// The first line that is neither blank nor a comment, without its end; it may be a header behind a `#`.
    pub(super) text: String,
    /// Its number, from 1.
    pub(super) line: u64,
    /// What follows.
    pub(super) rest: BufReader<Source>,
}

/// Opens a text file and reads up to its first line of data.
pub(super) fn open_first_line(path: &Path, expected: &'static str) -> Result<FirstLine> {
    let mut rest = BufReader::new(Source::open(path)?);
    let mut line = 0;
    loop {
        let mut bytes = Vec::new();
        let n_read = rest.by_ref().take(MAX_ROW_BYTES).read_until(b'\n', &mut bytes);
        line += 1;
        match n_read.map_err(|error| read_error(path, error))? as u64 {
            0 => {
                return Err(Error::NoData { path: path.to_owned(), expected });
            }
            MAX_ROW_BYTES => {
                return Err(Error::LineTooLong { path: path.to_owned(), line, limit: MAX_ROW_BYTES as usize });
            }
            _ => {}
        }
        let text = bytes.trim_ascii();
        let is_comment = match text.first() {
            None | Some(b'%') => true,
            Some(b'#') => !is_header(text, &mut rest).map_err(|error| read_error(path, error))?,
            Some(_) => false,
        };
        if !is_comment {
            return Ok(FirstLine { text: String::from_utf8_lossy(text).into_owned(), line, rest });
        }
    }
}

/// Whether a line behind a `#` is the header: it has several names, and a row of data follows it.
fn is_header(text: &[u8], rest: &mut impl BufRead) -> std::io::Result<bool> {
    if !text.iter().any(|byte| DELIMITERS.contains(byte)) {
        return Ok(false);
    }
    let next = rest.fill_buf()?.trim_ascii_start();
    let next = next.strip_prefix(b"\"").unwrap_or(next);
    Ok(next.first().is_none_or(|byte| byte.is_ascii_digit() || b"+-.".contains(byte)))
}

impl Table {
    /// A table whose header is the first line of data.
    pub(super) fn new(path: &Path, first: FirstLine) -> Self {
        let header_text = first.text.trim_start_matches('#');
        let delimiter = DELIMITERS.into_iter().find(|&mark| header_text.contains(char::from(mark)));
        let delimiter = delimiter.unwrap_or(b',');
        let header = header_text.split(char::from(delimiter)).map(|name| name.trim().trim_matches('"').to_owned());
        let end = Rc::new(Cell::new(0));
        // A line feed behind every row lets its number be told from where the next one starts.
        let rest = LineFeeds(first.rest).chain(b"\n".as_slice());
        let rest: Box<dyn Read> = Box::new(Fenced { text: rest, n_read: 0, end: Rc::clone(&end) });
        let rows = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .buffer_capacity(READ_AHEAD)
            .from_reader(rest);
        Self {
            path: path.to_owned(),
            header: header.collect(),
            rows,
            end,
            record: csv::StringRecord::new(),
            n_header_lines: first.line,
        }
    }

    /// Index of the column that a predicate on the lower-case name finds.
    pub(super) fn find(&self, is_wanted: impl Fn(&str) -> bool) -> Option<usize> {
        self.header.iter().position(|name| is_wanted(&name.to_lowercase()))
    }

    /// As [`Table::find`], for a column that must be there.
    pub(super) fn require(
        &self,
        column: &'static str,
        expected: &'static str,
        is_wanted: impl Fn(&str) -> bool,
    ) -> Result<usize> {
        self.find(is_wanted).ok_or_else(|| Error::TableColumn {
            path: self.path.clone(),
            column,
            found: excerpt(self.header.join(",").as_bytes()),
            expected,
        })
    }

    /// The names of the columns, as they are written.
    pub(super) fn header(&self) -> &[String] {
        &self.header
    }

    /// Name of a column, in lower case.
    pub(super) fn name(&self, column: usize) -> String {
        self.header.get(column).map(|name| name.to_lowercase()).unwrap_or_default()
    }

    /// The next row, or `None` at the end.
    pub(super) fn next_row(&mut self) -> Result<Option<Row<'_>>> {
        self.end.set(self.rows.position().byte() + MAX_ROW_BYTES + READ_AHEAD as u64);
        let is_row = self.rows.read_record(&mut self.record).map_err(|error| self.row_error(error))?;
        if !is_row {
            return Ok(None);
        }
        let line = self.n_header_lines + self.rows.position().line() - 1;
        let row = Row { path: &self.path, header: &self.header, record: &self.record, line };
        if row.record.len() != self.header.len() {
            let (found, expected) = (row.record.len() as u64, self.header.len() as u64);
            return Err(Error::TableRow { path: self.path.clone(), line, found, expected });
        }
        Ok(Some(row))
    }

    fn row_error(&self, error: csv::Error) -> Error {
        let path = self.path.clone();
        let line = self.n_header_lines + error.position().map_or(1, csv::Position::line);
        match error.into_kind() {
            csv::ErrorKind::Io(error) if error.get_ref().is_some_and(|error| error.is::<RowTooLong>()) => {
                let line = self.n_header_lines + self.rows.position().line();
                Error::LineTooLong { path, line, limit: MAX_ROW_BYTES as usize }
            }
            csv::ErrorKind::Io(error) => read_error(&path, error),
            _ => Error::TableField {
                path,
                line,
                column: "(all)".into(),
                found: "bytes that are not text".into(),
                expected: "UTF-8 text",
            },
        }
    }
}

impl Row<'_> {
    /// The text of a field.
    pub(super) fn text(&self, column: usize) -> &str {
        self.record.get(column).unwrap_or_default()
    }

    /// The error of a field that is not what it should be.
    pub(super) fn field_error(&self, column: usize, expected: &'static str) -> Error {
        Error::TableField {
            path: self.path.to_owned(),
            line: self.line,
            column: self.header.get(column).cloned().unwrap_or_default(),
            found: excerpt(self.text(column).as_bytes()),
            expected,
        }
    }

    /// A whole number, also one written as a real number: a table saved as one array has labels like `1.0e+01`.
    pub(super) fn integer(&self, column: usize) -> Result<i64> {
        let text = self.text(column);
        let whole = text.parse().ok().or_else(|| real(text.as_bytes()).and_then(whole_of));
        whole.ok_or_else(|| self.field_error(column, "a whole number"))
    }

    /// A finite number.
    pub(super) fn number(&self, column: usize) -> Result<f64> {
        let value = real(self.text(column).as_bytes()).filter(|value| value.is_finite());
        value.ok_or_else(|| self.field_error(column, "a finite number"))
    }
}

/// The whole number that a double is; beyond 2⁵³ a neighbour may have been meant.
fn whole_of(value: f64) -> Option<i64> {
    const LAST_EXACT: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;
    (value.fract() == 0.0 && value.abs() < LAST_EXACT).then_some(value as i64)
}

/// Text that may be read up to a mark, which moves on with every row: a row is held whole, quoted or not.
struct Fenced<R> {
    text: R,
    n_read: u64,
    end: Rc<Cell<u64>>,
}

/// A row goes on beyond the mark.
#[derive(Debug, thiserror::Error)]
#[error("a row of more than {MAX_ROW_BYTES} bytes")]
struct RowTooLong;

impl<R: Read> Read for Fenced<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let left = usize::try_from(self.end.get().saturating_sub(self.n_read)).unwrap_or(usize::MAX);
        if left == 0 {
            return Err(std::io::Error::other(RowTooLong));
        }
        let length = buffer.len().min(left);
        let n_read = self.text.read(&mut buffer[..length])?;
        self.n_read += n_read as u64;
        Ok(n_read)
    }
}

/// Text without carriage returns.
struct LineFeeds<R>(R);

impl<R: Read> Read for LineFeeds<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        loop {
            let n_read = self.0.read(buffer)?;
            let mut n_kept = 0;
            for at in 0..n_read {
                if buffer[at] != b'\r' {
                    buffer[n_kept] = buffer[at];
                    n_kept += 1;
                }
            }
            if n_kept > 0 || n_read == 0 {
                return Ok(n_kept);
            }
        }
    }
}

/// Names that a column of node labels has.
pub(super) fn is_node_column(name: &str) -> bool {
    matches!(name, "node" | "nodes" | "node_id" | "nodeid" | "node id" | "nid" | "grid" | "label" | "id")
}
