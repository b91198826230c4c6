//! OUTPUT4 in binary: records of Fortran, with words of four bytes or of eight.
//!
//! ```text
//! record   columns, rows, form, type, name of two words
//! record   column, first row, words; then the numbers     dense; first row 0 for a sparse column
//!          words + 1, row                                 before the numbers of a string in a big matrix
//!          (words + 1) · 65536 + row                      in any other
//! record   columns + 1, …                                 after the last column
//! ```

use std::io::{BufReader, Read};
use std::path::Path;

use super::head::{FORMAT, Head};
use super::matrices::Matrices;
use crate::error::{Error, Result};
use crate::input::raw_numbers::{self, Endian, Failure, Kind, fill};
use crate::input::source::{Source, read_error};

/// Bytes of the first record, with words of four bytes and of eight.
const HEADS: [u32; 2] = [24, 48];
/// Bytes of the marks around a record.
const MARK: usize = 4;

/// Whether a file begins as OUTPUT4 in binary does.
pub(super) fn begins(head: &[u8]) -> bool {
    words_of(head).is_some_and(|words| {
        let end = MARK + 6 * words.size();
        let closing = head.get(end..end + MARK).map(|bytes| words.mark(bytes));
        let is_closed = closing == Some(6 * words.size() as u64);
        is_closed && words.head(&head[MARK..end]).is_sound()
    })
}

/// How words are stored.
#[derive(Clone, Copy)]
struct Words {
    endian: Endian,
    is_wide: bool,
}

fn words_of(head: &[u8]) -> Option<Words> {
    let mark: [u8; MARK] = *head.first_chunk()?;
    let endians = [(Endian::Little, u32::from_le_bytes(mark)), (Endian::Big, u32::from_be_bytes(mark))];
    let (endian, length) = endians.into_iter().find(|(_, length)| HEADS.contains(length))?;
    Some(Words { endian, is_wide: length == HEADS[1] })
}

impl Words {
    fn size(self) -> usize {
        if self.is_wide { 8 } else { 4 }
    }

    fn mark(self, bytes: &[u8]) -> u64 {
        self.wholes(Kind::I32, &bytes[..MARK]).first().map_or(u64::MAX, |mark| mark.unsigned_abs())
    }

    fn kind(self) -> Kind {
        if self.is_wide { Kind::I64 } else { Kind::I32 }
    }

    fn wholes(self, kind: Kind, mut bytes: &[u8]) -> Vec<i64> {
        let n = (bytes.len() / kind.size()) as u64;
        raw_numbers::wholes(&mut bytes, (kind, self.endian), n).unwrap_or_default()
    }

    /// The head in the content of the first record.
    fn head(self, record: &[u8]) -> Head {
        let (numbers, name) = record.split_at(4 * self.size());
        let numbers = self.wholes(self.kind(), numbers);
        let number = |at: usize| numbers.get(at).copied().unwrap_or(-1);
        let name = String::from_utf8_lossy(name).trim_matches([' ', '\0']).replace([' ', '\0'], "");
        let (columns, rows, form, kind) = (number(0), number(1), number(2), number(3));
        Head { name, columns, rows, form, kind }
    }
}

/// A file that is read record by record.
pub(super) struct File<'a> {
    path: &'a Path,
    source: BufReader<Source>,
    words: Words,
    /// Bytes read so far.
    at: u64,
}

/// A record of a column, behind its three words.
struct Record {
    column: i64,
    first: i64,
    words: i64,
    /// Bytes that are left of it.
    left: u64,
}

impl<'a> File<'a> {
    pub(super) fn open(path: &'a Path) -> Result<Self> {
        let mut source = BufReader::with_capacity(1 << 16, Source::open(path)?);
        let head = std::io::BufRead::fill_buf(&mut source).map_err(|error| read_error(path, error))?;
        let words = words_of(head).unwrap_or(Words { endian: Endian::Little, is_wide: false });
        Ok(Self { path, source, words, at: 0 })
    }

    fn error(&self, found: String, expected: &str) -> Error {
        let (path, place, expected) = (self.path.to_owned(), format!("byte {}", self.at), expected.to_owned());
        Error::MatrixFormat { path, format: FORMAT, place, found, expected: expected.into() }
    }

    /// The next bytes; fewer at the end of the file.
    fn bytes(&mut self, n: usize) -> Result<Vec<u8>> {
        let mut bytes = vec![0; n];
        let n_read = fill(&mut self.source, &mut bytes).map_err(|error| read_error(self.path, error))?;
        self.at += n_read as u64;
        bytes.truncate(n_read);
        Ok(bytes)
    }

    fn exactly(&mut self, n: usize) -> Result<Vec<u8>> {
        let bytes = self.bytes(n)?;
        if bytes.len() < n { Err(self.error("the end of the file".to_owned(), "a record")) } else { Ok(bytes) }
    }

    fn skip_bytes(&mut self, n: u64) -> Result<()> {
        let n_skipped = std::io::copy(&mut self.source.by_ref().take(n), &mut std::io::sink());
        let n_skipped = n_skipped.map_err(|error| read_error(self.path, error))?;
        self.at += n_skipped;
        if n_skipped < n { Err(self.error("the end of the file".to_owned(), "a record")) } else { Ok(()) }
    }

    /// Words from the record.
    fn take_words(&mut self, record: &mut Record, n: usize) -> Result<Vec<i64>> {
        let n_bytes = n * self.words.size();
        self.take(record, n_bytes as u64)?;
        let bytes = self.exactly(n_bytes)?;
        Ok(self.words.wholes(self.words.kind(), &bytes))
    }

    /// Counts bytes of a record that are about to be read.
    fn take(&self, record: &mut Record, n_bytes: u64) -> Result<()> {
        match record.left.checked_sub(n_bytes) {
            Some(left) => {
                record.left = left;
                Ok(())
            }
            None => {
                Err(self
                    .error(format!("{} bytes left of the record", record.left), "the numbers that its head announces"))
            }
        }
    }

    /// The next record of a matrix, of a column or the one that ends it.
    fn record(&mut self, head: &Head) -> Result<Option<Record>> {
        let mark = self.exactly(MARK)?;
        let length = self.words.mark(&mark);
        let mut record = Record { column: 0, first: 0, words: 0, left: length };
        let words = self.take_words(&mut record, 3)?;
        (record.column, record.first, record.words) = (words[0], words[1], words[2]);
        if record.column == head.columns + 1 {
            self.close(&record, length)?;
            return Ok(None);
        }
        if !(1..=head.columns).contains(&record.column) || record.first < 0 || record.words < 0 {
            return Err(self.error(format!("column {}", record.column), &format!("a column up to {}", head.columns)));
        }
        Ok(Some(record))
    }

    /// Goes over the rest of a record and its closing mark.
    fn close(&mut self, record: &Record, length: u64) -> Result<()> {
        self.skip_bytes(record.left)?;
        let mark = self.exactly(MARK)?;
        let closing = self.words.mark(&mark);
        if closing != length && length != u64::MAX {
            return Err(self.error(format!("a record of {length} bytes that ends with {closing}"), "its length twice"));
        }
        Ok(())
    }

    fn kind(&self, head: &Head) -> Kind {
        if head.is_double() || self.words.is_wide { Kind::F64 } else { Kind::F32 }
    }

    /// Hands the next numbers of a record to `take`, each with its position.
    fn numbers(
        &mut self,
        (record, kind): (&mut Record, Kind),
        n: u64,
        mut take: impl FnMut(u64, f64) -> Result<()>,
    ) -> Result<()> {
        self.take(record, n.saturating_mul(kind.size() as u64))?;
        let stored = (kind, self.words.endian);
        let read = raw_numbers::each_real(&mut self.source, stored, n, |position, value| {
            take(position, value).map_err(|error| Failure::Refused(Box::new(error)))
        });
        match read {
            Ok(()) => {
                self.at += n * kind.size() as u64;
                Ok(())
            }
            Err(Failure::Refused(error)) => Err(*error),
            Err(Failure::Read(error)) => Err(read_error(self.path, error)),
            Err(Failure::Cut(n) | Failure::Value(n)) => {
                Err(self.error(format!("the end of the file after {n} numbers"), "a record"))
            }
        }
    }
}

impl<'a> Matrices<'a> for File<'a> {
    fn head(&mut self) -> Result<Option<Head>> {
        let mark = self.bytes(MARK)?;
        if mark.is_empty() {
            return Ok(None);
        }
        let length = 6 * self.words.size();
        if mark.len() < MARK || self.words.mark(&mark) != length as u64 {
            return Err(
                self.error("no record of that length".to_owned(), &format!("the head of a matrix, {length} bytes"))
            );
        }
        let record = self.exactly(length)?;
        let head = self.words.head(&record);
        self.exactly(MARK)?;
        if head.is_sound() {
            return Ok(Some(head));
        }
        let found = format!("{} columns, {} rows, form {}, type {}", head.columns, head.rows, head.form, head.kind);
        Err(self.error(found, "the head of a matrix"))
    }

    fn skip(&mut self, head: &Head) -> Result<()> {
        while let Some(record) = self.record(head)? {
            let length = record.left + 3 * self.words.size() as u64;
            self.close(&record, length)?;
        }
        Ok(())
    }

    fn entries(&mut self, head: &Head, take: &mut dyn FnMut(u32, u32, f64) -> Result<()>) -> Result<()> {
        let kind = self.kind(head);
        let words_per_number = (kind.size() / self.words.size()) as i64;
        let outside = format!("rows up to {}", head.n_rows());
        while let Some(mut record) = self.record(head)? {
            let length = record.left + 3 * self.words.size() as u64;
            let column = (record.column - 1) as u32;
            let is_dense = record.first > 0;
            let (mut left, mut first, mut words) = (record.words, record.first, record.words);
            while left > 0 {
                if !is_dense {
                    let own = if head.is_big() { 2 } else { 1 };
                    let found = self.take_words(&mut record, own)?;
                    (first, words) = match found[..] {
                        [length, row] => (row, length.saturating_sub(1)),
                        [packed] => (packed & 0xffff, (packed >> 16) - 1),
                        _ => (0, 0),
                    };
                    left -= own as i64;
                }
                let n = u64::try_from(words / words_per_number).unwrap_or(u64::MAX);
                let Some(row) = head.rows_of(first, n) else {
                    return Err(self.error(format!("{n} numbers from row {first} on"), &outside));
                };
                self.numbers((&mut record, kind), n, |position, value| take(row + position as u32, column, value))?;
                left -= words;
            }
            self.close(&record, length)?;
        }
        Ok(())
    }

    fn digest(mut self) -> Result<String> {
        std::io::copy(&mut self.source, &mut std::io::sink()).map_err(|error| read_error(self.path, error))?;
        Ok(self.source.get_ref().digest())
    }
}
