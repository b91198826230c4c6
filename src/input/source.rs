//! Files as streams of bytes: gzip by its magic bytes, a bound on inflation, the digest on the way.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use flate2::bufread::MultiGzDecoder;

use crate::error::{Error, Result};
use crate::regular_file;

/// Inflation that is always too much, as deflate itself ends at 1032:1.
const MAX_RATIO: u64 = 1000;
/// Inflation that is too much for large data. A line `row column value` costs deflate two bytes at least, so that
/// tables of numbers stay below 30:1.
const MAX_RATIO_LARGE: u64 = 100;
/// Inflated bytes below which no ratio is judged.
const MIN_JUDGED_BYTES: u64 = 1 << 20;
/// Inflated bytes above which the strict ratio holds.
const LARGE: u64 = 1 << 30;
/// Bytes asked of the system at once.
const READ_AHEAD: usize = 1 << 17;

/// The bytes of a file, inflated where they are gzipped, in one or several members.
pub(super) struct Source {
    stream: Stream,
    inflated: u64,
}

enum Stream {
    Plain(Box<BufReader<DigestReader>>),
    Gzip(Box<MultiGzDecoder<BufReader<DigestReader>>>),
}

impl Source {
    /// Opens a regular file.
    pub(super) fn open(path: &Path) -> Result<Self> {
        let read_error = |source| Error::Read { path: path.to_owned(), source };
        let file = regular_file::open(path)?;
        let digest = DigestReader { file, hasher: blake3::Hasher::new(), n_read: 0 };
        let mut reader = BufReader::with_capacity(READ_AHEAD, digest);
        let is_gzip = reader.fill_buf().map_err(read_error)?.starts_with(&[0x1f, 0x8b]);
        let stream =
            if is_gzip { Stream::Gzip(Box::new(MultiGzDecoder::new(reader))) } else { Stream::Plain(Box::new(reader)) };
        Ok(Self { stream, inflated: 0 })
    }

    /// BLAKE3 of the file's bytes that were read, in lower-case hexadecimal; of the whole file once it is at its end.
    pub(super) fn digest(&self) -> String {
        self.file().hasher.finalize().to_hex().to_string()
    }

    fn file(&self) -> &DigestReader {
        match &self.stream {
            Stream::Plain(reader) => reader.get_ref(),
            Stream::Gzip(decoder) => decoder.get_ref().get_ref(),
        }
    }

    fn check_inflation(&self) -> std::io::Result<()> {
        let compressed = self.file().n_read;
        let limit = if self.inflated > LARGE { MAX_RATIO_LARGE } else { MAX_RATIO };
        if self.inflated > MIN_JUDGED_BYTES && self.inflated / limit > compressed {
            let inflation = Inflation { compressed, inflated: self.inflated, limit };
            return Err(std::io::Error::other(inflation));
        }
        Ok(())
    }
}

impl Read for Source {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        match &mut self.stream {
            Stream::Plain(reader) => reader.read(buffer),
            Stream::Gzip(decoder) => {
                let n_read = decoder.read(buffer).map_err(damage)?;
                self.inflated += n_read as u64;
                self.check_inflation()?;
                Ok(n_read)
            }
        }
    }
}

/// Marks what the decoder found wrong in the data, as opposed to what the system said.
fn damage(error: std::io::Error) -> std::io::Error {
    use std::io::ErrorKind::{InvalidData, InvalidInput, UnexpectedEof};
    match error.kind() {
        InvalidData | InvalidInput | UnexpectedEof => std::io::Error::other(Damage(error)),
        _ => error,
    }
}

/// The error of reading `path` that an I/O error of a [`Source`] stands for.
pub(super) fn read_error(path: &Path, error: std::io::Error) -> Error {
    let path: PathBuf = path.to_owned();
    match error.downcast::<Inflation>() {
        Ok(Inflation { compressed, inflated, limit }) => Error::GzipInflation { path, compressed, inflated, limit },
        Err(error) => match error.downcast::<Damage>() {
            Ok(Damage(source)) => Error::GzipDamaged { path, source },
            Err(source) => Error::Read { path, source },
        },
    }
}

/// Reads a file and digests what was read.
struct DigestReader {
    file: File,
    hasher: blake3::Hasher,
    n_read: u64,
}

impl Read for DigestReader {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let n_read = self.file.read(buffer)?;
        self.hasher.update(&buffer[..n_read]);
        self.n_read += n_read as u64;
        Ok(n_read)
    }
}

/// Gzipped data that inflate beyond reason.
#[derive(Debug, thiserror::Error)]
#[error("{compressed} bytes inflate to {inflated}")]
struct Inflation {
    compressed: u64,
    inflated: u64,
    limit: u64,
}

/// Gzipped data that the decoder refuses.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
struct Damage(std::io::Error);
