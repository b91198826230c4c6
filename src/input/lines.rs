//! Text line by line, whatever its packing, with the number of each line.

use std::borrow::Cow;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use super::source::{Source, read_error};
use crate::error::{Error, Result};

/// The longest line: those of the formats that are read so are far shorter.
const MAX_LINE_BYTES: usize = 1 << 12;

/// The lines of a file.
pub(super) struct Lines<'a> {
    path: Cow<'a, Path>,
    source: BufReader<Source>,
    number: u64,
    bytes: Vec<u8>,
}

impl<'a> Lines<'a> {
    /// Before the first line.
    pub(super) fn open(path: impl Into<Cow<'a, Path>>) -> Result<Self> {
        let path = path.into();
        let source = BufReader::with_capacity(1 << 16, Source::open(&path)?);
        Ok(Self { path, source, number: 0, bytes: Vec::new() })
    }

    pub(super) fn path(&self) -> PathBuf {
        self.path.clone().into_owned()
    }

    /// Number of the line that was read last, from 1.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// The line that was read last, without its end.
    pub(super) fn line(&self) -> &[u8] {
        let line = self.bytes.strip_suffix(b"\n").unwrap_or(&self.bytes);
        line.strip_suffix(b"\r").unwrap_or(line)
    }

    /// Whether the line that was read last has no end.
    pub(super) fn is_open(&self) -> bool {
        !self.bytes.ends_with(b"\n")
    }

    /// Reads the next line; false at the end of the file.
    ///
    /// # Errors
    /// [`Error::LineTooLong`]; those of reading the file.
    pub(super) fn advance(&mut self) -> Result<bool> {
        self.bytes.clear();
        let read = self.source.by_ref().take(MAX_LINE_BYTES as u64 + 1).read_until(b'\n', &mut self.bytes);
        let n_read = read.map_err(|error| read_error(&self.path, error))?;
        self.number += 1;
        if n_read > MAX_LINE_BYTES {
            return Err(Error::LineTooLong { path: self.path(), line: self.number, limit: MAX_LINE_BYTES });
        }
        Ok(n_read > 0)
    }

    /// BLAKE3 of the file, whose rest is read.
    pub(super) fn digest(mut self) -> Result<String> {
        std::io::copy(&mut self.source, &mut std::io::sink()).map_err(|error| read_error(&self.path, error))?;
        Ok(self.source.get_ref().digest())
    }
}
