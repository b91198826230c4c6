//! Entries of bulk data of one name, each with its continuations: small, large and free fields.

use std::path::Path;

use super::bulk_lines::{BulkLines, Place};
use crate::error::{Error, Result};

/// How wide the fields of a line are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Width {
    Small,
    Large,
}

impl Width {
    fn of(mark: Option<&u8>) -> Self {
        if mark == Some(&b'*') { Self::Large } else { Self::Small }
    }

    /// Fields of a line, the name not counted.
    fn n_fields(self) -> usize {
        match self {
            Self::Small => 8,
            Self::Large => 4,
        }
    }
}

const FORMAT: &str = "Nastran bulk data";

/// The last column of the fields; what follows names the continuation.
const END: usize = 72;

/// The entries of bulk data of one name.
pub(super) struct Cards<'a> {
    lines: BulkLines<'a>,
    name: &'static str,
    /// The line that was read is the first one of the next entry, or of something else.
    is_ahead: bool,
}

/// An entry with its fields, blanks cut off.
pub(super) struct Card {
    pub(super) fields: Vec<Vec<u8>>,
    /// Where its first line is.
    pub(super) place: Place,
}

impl Card {
    /// The name of the matrix.
    pub(super) fn name(&self) -> String {
        self.fields.first().map_or_else(String::new, |name| String::from_utf8_lossy(name).to_ascii_uppercase())
    }

    /// Whether it is the head of a matrix: the node of its column is 0.
    pub(super) fn is_head(&self) -> bool {
        self.fields.get(1).is_some_and(|field| field.as_slice() == b"0")
    }
}

impl<'a> Cards<'a> {
    pub(super) fn open(path: &'a Path, name: &'static str) -> Result<Self> {
        Ok(Self { lines: BulkLines::open(path)?, name, is_ahead: false })
    }

    /// The next entry of that name; none at the end of the deck.
    pub(super) fn advance(&mut self) -> Result<Option<Card>> {
        loop {
            if !self.is_ahead && !self.lines.advance()? {
                return Ok(None);
            }
            self.is_ahead = false;
            let Some(fields) = first_fields(self.lines.line(), self.name) else { continue };
            let mut card = Card { fields, place: self.lines.place() };
            while self.lines.advance()? {
                let line = self.lines.line();
                if line.starts_with(b"$") {
                    continue;
                }
                let Some(more) = continued_fields(line) else {
                    self.is_ahead = true;
                    break;
                };
                card.fields.extend(more);
            }
            return Ok(Some(card));
        }
    }

    /// BLAKE3 of the deck, with what it includes.
    pub(super) fn digest(self) -> Result<String> {
        self.lines.digest()
    }
}

/// The fields behind the name of an entry; none for another one.
fn first_fields(line: &[u8], name: &str) -> Option<Vec<Vec<u8>>> {
    let rest = line.get(name.len()..).filter(|_| line[..name.len()].eq_ignore_ascii_case(name.as_bytes()))?;
    let width = Width::of(rest.first());
    let mark = rest.strip_prefix(b"*").unwrap_or(rest);
    match mark.first() {
        Some(b',') => Some(free_fields(&mark[1..], width)),
        Some(b' ' | b'\t') => Some(fields(line, width)),
        _ => None,
    }
}

/// The fields of a line that continues an entry; none where it does not.
fn continued_fields(line: &[u8]) -> Option<Vec<Vec<u8>>> {
    let first = *line.first()?;
    let width = Width::of(Some(&first));
    let mark_end = line.iter().position(|byte| *byte == b',');
    match first {
        _ if line.trim_ascii().is_empty() => None,
        b',' => Some(free_fields(&line[1..], Width::Small)),
        b'+' | b'*' if mark_end.is_some_and(|at| at <= 8) => Some(free_fields(&line[mark_end? + 1..], width)),
        b' ' | b'+' | b'*' | b'\t' => Some(fields(line, width)),
        _ => None,
    }
}

/// Fields between commas, filled up to a whole line.
fn free_fields(text: &[u8], width: Width) -> Vec<Vec<u8>> {
    let n = width.n_fields();
    let mut fields: Vec<Vec<u8>> =
        text.split(|byte| *byte == b',').take(n).map(|field| field.trim_ascii().to_vec()).collect();
    fields.resize(n, Vec::new());
    fields
}

/// Fields of a fixed width behind the first eight columns.
fn fields(line: &[u8], width: Width) -> Vec<Vec<u8>> {
    let (n, width) = (width.n_fields(), 64 / width.n_fields());
    // A tab fills a field of eight columns.
    let mut text = Vec::with_capacity(END);
    for &byte in line.iter().take(END) {
        match byte {
            b'\t' => text.resize((text.len() / 8 + 1) * 8, b' '),
            byte => text.push(byte),
        }
    }
    text.resize(END, b' ');
    (0..n).map(|at| text[8 + at * width..8 + (at + 1) * width].trim_ascii().to_vec()).collect()
}

/// The error of a field.
pub(super) fn wrong(place: &Place, found: &[u8], expected: &str) -> Error {
    let found = format!("{:?}", String::from_utf8_lossy(found));
    let (path, place, expected) = (place.path.to_path_buf(), format!("line {}", place.line), expected.to_owned());
    Error::MatrixFormat { path, format: FORMAT, place, found, expected: expected.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(fields: Option<Vec<Vec<u8>>>) -> Vec<String> {
        fields.unwrap_or_default().into_iter().map(|field| String::from_utf8(field).expect("text")).collect()
    }

    #[test]
    fn fields_small_large_and_free() {
        let small = b"DMIG    KAAX           1       3               1       3   2.5+3            +C1";
        assert_eq!(texts(first_fields(small, "DMIG")), ["KAAX", "1", "3", "", "1", "3", "2.5+3", ""]);
        let large = b"DMIG*   KAAX                           1               3";
        assert_eq!(texts(first_fields(large, "DMIG")), ["KAAX", "1", "3", ""]);
        assert_eq!(texts(first_fields(b"dmig,k,1,2,,1,2,3.5", "DMIG")), ["k", "1", "2", "", "1", "2", "3.5", ""]);
        assert_eq!(
            texts(continued_fields(b"*                      1               3 6.788227013D+06")),
            ["1", "3", "6.788227013D+06", ""]
        );
        assert_eq!(texts(continued_fields(b"+,2,1,4.5,,3,1,5.5")), ["2", "1", "4.5", "", "3", "1", "5.5", ""]);
        assert_eq!(texts(continued_fields(b",2,1,4.5")), ["2", "1", "4.5", "", "", "", "", ""]);
        assert!(continued_fields(b"GRID    1").is_none() && continued_fields(b"  ").is_none());
        assert!(first_fields(b"DMIGX   A", "DMIG").is_none() && first_fields(b"DMI", "DMIG").is_none());
    }
}
