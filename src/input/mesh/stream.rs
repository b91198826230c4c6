//! Numbers and words of a file, in text or binary, one after the other.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::input::banner::excerpt;
use crate::input::fortran;
use crate::input::source::{Source, read_error};

/// The longest word of a text and the longest line that is looked at.
const MAX_WORD_BYTES: usize = 1 << 12;
/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::input) enum Form {
    Text,
    LittleEndian,
    BigEndian,
}

/// A file from its beginning on.
pub(in crate::input) struct Stream {
    source: BufReader<Source>,
    path: PathBuf,
    /// How the numbers to come are written.
    pub(in crate::input) form: Form,
    /// Line ends passed.
    n_lines: u64,
    /// Bytes passed.
    offset: u64,
    word: Vec<u8>,
}

impl Stream {
    pub(in crate::input) fn open(path: &Path) -> Result<Self> {
        let source = BufReader::with_capacity(CHUNK, Source::open(path)?);
        Ok(Self { source, path: path.to_owned(), form: Form::Text, n_lines: 0, offset: 0, word: Vec::new() })
    }

    pub(in crate::input) fn path(&self) -> &Path {
        &self.path
    }

    /// Lines begun, or the byte where binary numbers are.
    pub(in crate::input) fn line(&self) -> u64 {
        self.n_lines + 1
    }

    /// The error of what was read last.
    pub(in crate::input) fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> Error {
        let (path, found, expected) = (self.path.clone(), found.into(), expected.into());
        match self.form {
            Form::Text => Error::MeshText { path, line: self.line(), found, expected },
            _ => Error::MeshBinary { path, offset: self.offset, found, expected },
        }
    }

    fn failed(&self, error: std::io::Error) -> Error {
        read_error(&self.path, error)
    }

    /// The rest of the line, without blanks around it and with its start alone where it is long; none at the end of the file.
    pub(in crate::input) fn rest_of_line(&mut self) -> Result<Option<Vec<u8>>> {
        Ok(self.raw_line()?.map(|line| line.trim_ascii().to_vec()))
    }

    /// The rest of the line with the blanks at its start, and with its start alone where it is long; none at the end of the file.
    pub(in crate::input) fn raw_line(&mut self) -> Result<Option<Vec<u8>>> {
        let mut line = Vec::new();
        let mut n_read = 0_u64;
        loop {
            let path = &self.path;
            let buffer = self.source.fill_buf().map_err(|error| read_error(path, error))?;
            if buffer.is_empty() {
                break;
            }
            let end = buffer.iter().position(|byte| *byte == b'\n');
            let length = end.map_or(buffer.len(), |end| end + 1);
            let kept = length.min(MAX_WORD_BYTES.saturating_sub(line.len()));
            line.extend_from_slice(&buffer[..kept]);
            self.source.consume(length);
            n_read += length as u64;
            if end.is_some() {
                self.n_lines += 1;
                break;
            }
        }
        self.offset += n_read;
        line.truncate(line.trim_ascii_end().len());
        Ok((n_read > 0).then_some(line))
    }

    /// The next line that is not blank.
    pub(in crate::input) fn next_line(&mut self, expected: &str) -> Result<Vec<u8>> {
        loop {
            match self.rest_of_line()? {
                Some(line) if line.is_empty() => {}
                Some(line) => return Ok(line),
                None => return Err(self.error("the end of the file", expected)),
            }
        }
    }

    /// The next word of a text; none at the end of the file.
    pub(in crate::input) fn word(&mut self) -> Result<Option<&[u8]>> {
        self.word.clear();
        loop {
            let path = &self.path;
            let buffer = self.source.fill_buf().map_err(|error| read_error(path, error))?;
            if buffer.is_empty() {
                break;
            }
            let mut at = 0;
            if self.word.is_empty() {
                at = buffer.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(buffer.len());
                self.n_lines += buffer[..at].iter().filter(|byte| **byte == b'\n').count() as u64;
            }
            let end = buffer[at..].iter().position(u8::is_ascii_whitespace).map_or(buffer.len(), |end| at + end);
            self.word.extend_from_slice(&buffer[at..end.min(at + MAX_WORD_BYTES)]);
            let is_whole = end < buffer.len();
            self.source.consume(end);
            self.offset += end as u64;
            if self.word.len() > MAX_WORD_BYTES {
                let limit = MAX_WORD_BYTES;
                return Err(Error::LineTooLong { path: self.path.clone(), line: self.line(), limit });
            }
            if is_whole && !self.word.is_empty() {
                break;
            }
        }
        Ok((!self.word.is_empty()).then_some(self.word.as_slice()))
    }

    /// Bytes of a binary part.
    pub(in crate::input) fn bytes<const N: usize>(&mut self, expected: &str) -> Result<[u8; N]> {
        let mut bytes = [0; N];
        match self.source.read_exact(&mut bytes) {
            Ok(()) => {
                self.offset += N as u64;
                Ok(bytes)
            }
            Err(error)
                if error.kind() == std::io::ErrorKind::UnexpectedEof && error.get_ref().is_none_or(is_plain_end) =>
            {
                Err(self.error("the end of the file", expected))
            }
            Err(error) => Err(self.failed(error)),
        }
    }

    /// A whole number; of 32 bits in a binary part.
    pub(in crate::input) fn int(&mut self, expected: &str) -> Result<i64> {
        match self.form {
            Form::Text => self.whole_number(expected),
            Form::LittleEndian => Ok(i32::from_le_bytes(self.bytes(expected)?).into()),
            Form::BigEndian => Ok(i32::from_be_bytes(self.bytes(expected)?).into()),
        }
    }

    /// A whole number; of 64 bits in a binary part.
    pub(in crate::input) fn long(&mut self, expected: &str) -> Result<i64> {
        match self.form {
            Form::Text => self.whole_number(expected),
            Form::LittleEndian => Ok(i64::from_le_bytes(self.bytes(expected)?)),
            Form::BigEndian => Ok(i64::from_be_bytes(self.bytes(expected)?)),
        }
    }

    /// A finite number; of 64 bits in a binary part.
    pub(in crate::input) fn real(&mut self, expected: &str) -> Result<f64> {
        let value = self.any_real(expected)?;
        if value.is_finite() { Ok(value) } else { Err(self.error(value.to_string(), expected)) }
    }

    /// A number; of 64 bits in a binary part.
    pub(in crate::input) fn any_real(&mut self, expected: &str) -> Result<f64> {
        match self.form {
            Form::Text => match self.word()? {
                Some(word) => {
                    let value = fortran::real(word);
                    value.ok_or_else(|| self.wrong_word(expected))
                }
                None => Err(self.error("the end of the file", expected)),
            },
            Form::LittleEndian => Ok(f64::from_le_bytes(self.bytes(expected)?)),
            Form::BigEndian => Ok(f64::from_be_bytes(self.bytes(expected)?)),
        }
    }

    /// How many of something come; a number that cannot be one is refused, one that is too large is not trusted.
    pub(in crate::input) fn count(&self, number: i64, expected: &str) -> Result<u64> {
        u64::try_from(number).map_err(|_| self.error(number.to_string(), expected))
    }

    /// Goes on behind these bytes, the first of which occurs in them once.
    pub(in crate::input) fn skip_past(&mut self, mark: &[u8]) -> Result<()> {
        let mut n_matched = 0;
        while n_matched < mark.len() {
            let path = &self.path;
            let buffer = self.source.fill_buf().map_err(|error| read_error(path, error))?;
            if buffer.is_empty() {
                return Err(self.error("the end of the file", excerpt(mark)));
            }
            let mut length = 0;
            for byte in buffer {
                length += 1;
                n_matched = match () {
                    () if *byte == mark[n_matched] => n_matched + 1,
                    () if *byte == mark[0] => 1,
                    () => 0,
                };
                if n_matched == mark.len() {
                    break;
                }
            }
            self.n_lines += buffer[..length].iter().filter(|byte| **byte == b'\n').count() as u64;
            self.source.consume(length);
            self.offset += length as u64;
        }
        Ok(())
    }

    fn whole_number(&mut self, expected: &str) -> Result<i64> {
        match self.word()? {
            Some(word) => {
                let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
                number.ok_or_else(|| self.wrong_word(expected))
            }
            None => Err(self.error("the end of the file", expected)),
        }
    }

    fn wrong_word(&self, expected: &str) -> Error {
        self.error(format!("`{}`", excerpt(&self.word)), expected)
    }
}

/// Whether an end of data is that of the file rather than of packed data.
fn is_plain_end(inner: &(dyn std::error::Error + Send + Sync + 'static)) -> bool {
    inner.to_string().contains("failed to fill whole buffer")
}
