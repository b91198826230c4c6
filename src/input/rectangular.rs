//! The lines of a rectangular matrix in Matrix Market form: loads, or rows of quantities.
//!
//! `array` files list every value, column by column; `coordinate` files list `row column value`.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::banner::{excerpt, is_comment};
use super::entries::number;
use super::source::{Source, read_error};
use crate::error::{Error, Result};

/// The longest line.
const MAX_LINE_BYTES: u64 = 1 << 12;

const BANNERS: &str = "`%%MatrixMarket matrix array real general` or `%%MatrixMarket matrix coordinate real general`";

/// How a file lists its values.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    Array,
    Coordinate,
}

/// What a file is read for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Content {
    Load,
    Quantities,
}

impl Content {
    fn expected(self) -> &'static str {
        match self {
            Self::Load => "a load in Matrix Market form",
            Self::Quantities => "rows of quantities in Matrix Market form",
        }
    }
}

/// The lines of a text file that hold data.
pub(super) struct Lines<'a> {
    content: Content,
    file: &'a Path,
    source: BufReader<Source>,
    /// Number of the line that was read last, from 1.
    pub(super) line: u64,
    bytes: Vec<u8>,
}

impl<'a> Lines<'a> {
    pub(super) fn open(file: &'a Path, content: Content) -> Result<Self> {
        Ok(Self { content, file, source: BufReader::new(Source::open(file)?), line: 0, bytes: Vec::new() })
    }

    pub(super) fn path(&self) -> std::path::PathBuf {
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

    /// BLAKE3 of the file's bytes, once all of it was read.
    pub(super) fn digest(&self) -> String {
        self.source.get_ref().digest()
    }

    /// Reads the banner.
    pub(super) fn banner(&mut self) -> Result<Layout> {
        let is_there = self.advance_to_banner()?;
        let text = if is_there { self.text().to_ascii_lowercase() } else { String::new() };
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words[..] {
            ["%%matrixmarket", "matrix", "array", "real" | "integer", "general"] => Ok(Layout::Array),
            ["%%matrixmarket", "matrix", "coordinate", "real" | "integer", "general"] => Ok(Layout::Coordinate),
            _ if !is_there => Err(Error::NoData { path: self.path(), expected: self.content.expected() }),
            _ => Err(self.format_error(BANNERS)),
        }
    }

    /// Reads the size line: what it should be, and its numbers where they are whole.
    pub(super) fn sizes(&mut self, layout: Layout) -> Result<(&'static str, Option<Vec<u64>>)> {
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
    pub(super) fn advance(&mut self) -> Result<bool> {
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

    pub(super) fn format_error(&self, expected: &'static str) -> Error {
        let found = match self.bytes.trim_ascii() {
            b"" => "end of file".to_owned(),
            text => excerpt(text),
        };
        let (path, line) = (self.path(), self.line);
        match self.content {
            Content::Load => Error::LoadFormat { path, line, found, expected },
            Content::Quantities => Error::QuantityFormat { path, line, found, expected },
        }
    }

    /// `row column value` with indices up to `sizes`, which are returned from zero.
    pub(super) fn entry(&self, sizes: [u64; 2]) -> Result<(u64, u64, f64)> {
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
    pub(super) fn value(&self, [row, column]: [u64; 2], at: usize) -> Result<f64> {
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
