//! Files as streams of bytes: unpacked where their first bytes say that they are packed, with a bound on what becomes of them, the digest
//! on the way.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use bzip2::bufread::MultiBzDecoder;

use super::gzip::GzipMembers;
use super::zstd::ZstdFrames;
use crate::error::{Error, Result};
use crate::regular_file;

/// Expansion that is always too much, as deflate itself ends at 1032:1.
const MAX_RATIO: u64 = 1000;
/// Expansion that is too much for large data. A line `row column value` costs deflate two bytes at least, so that
/// tables of numbers stay below 30:1.
const MAX_RATIO_LARGE: u64 = 100;
/// Unpacked bytes below which no ratio is judged.
const MIN_JUDGED_BYTES: u64 = 1 << 20;
/// Unpacked bytes above which the strict ratio holds.
const LARGE: u64 = 1 << 30;
/// Bytes asked of the system at once.
const READ_AHEAD: usize = 1 << 17;

/// How a file is packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Packing {
    Gzip,
    Bzip2,
    Zstd,
}

impl Packing {
    /// The packing of a file that begins with these bytes; none where it is not packed.
    pub(super) fn of(head: &[u8]) -> Option<Self> {
        const MAGIC: [(&[u8], Packing); 3] =
            [(b"\x1f\x8b", Packing::Gzip), (b"BZh", Packing::Bzip2), (b"\x28\xb5\x2f\xfd", Packing::Zstd)];
        MAGIC.into_iter().find(|(magic, _)| head.starts_with(magic)).map(|(_, packing)| packing)
    }

    /// What messages call data of it.
    fn data(self) -> &'static str {
        match self {
            Self::Gzip => "gzipped data",
            Self::Bzip2 => "data packed by bzip2",
            Self::Zstd => "data packed by zstd",
        }
    }
}

/// The bytes of a file, unpacked where they are packed, in one or several members.
///
/// A byte order mark of UTF-8 at the beginning is left out: editors put it there, and no format that is read begins with these bytes.
pub(super) struct Source {
    stream: Stream,
    unpacked: u64,
    /// The first bytes, as far as they have not been handed on; none before anything was read.
    first: Option<Vec<u8>>,
}

/// The byte order mark of UTF-8.
const MARK: &[u8] = b"\xef\xbb\xbf";

enum Stream {
    Plain(Box<BufReader<DigestReader>>),
    Gzip(Box<GzipMembers<BufReader<DigestReader>>>),
    Bzip2(Box<MultiBzDecoder<BufReader<DigestReader>>>),
    Zstd(Box<ZstdFrames<BufReader<DigestReader>>>),
}

impl Source {
    /// Opens a regular file.
    pub(super) fn open(path: &Path) -> Result<Self> {
        let failed = |source| Error::Read { path: path.to_owned(), source };
        let file = regular_file::open(path)?;
        let n_bytes = file.metadata().map_err(failed)?.len();
        let digest = DigestReader { file, hasher: blake3::Hasher::new(), n_read: 0 };
        let mut reader = BufReader::with_capacity(READ_AHEAD, digest);
        let stream = match Packing::of(reader.fill_buf().map_err(failed)?) {
            None => Stream::Plain(Box::new(reader)),
            Some(Packing::Gzip) => Stream::Gzip(Box::new(GzipMembers::new(reader))),
            Some(Packing::Bzip2) => Stream::Bzip2(Box::new(MultiBzDecoder::new(reader))),
            Some(Packing::Zstd) => {
                // A window is memory that a header asks for: no more than what may become of the file.
                let window = n_bytes.saturating_mul(MAX_RATIO).max(MIN_JUDGED_BYTES);
                Stream::Zstd(Box::new(ZstdFrames::new(reader, window)))
            }
        };
        Ok(Self { stream, unpacked: 0, first: None })
    }

    /// How the file is packed; none where it is not.
    pub(super) fn packing(&self) -> Option<Packing> {
        match self.stream {
            Stream::Plain(_) => None,
            Stream::Gzip(_) => Some(Packing::Gzip),
            Stream::Bzip2(_) => Some(Packing::Bzip2),
            Stream::Zstd(_) => Some(Packing::Zstd),
        }
    }

    /// BLAKE3 of the file's bytes that were read, in lower-case hexadecimal; of the whole file once it is at its end.
    pub(super) fn digest(&self) -> String {
        self.file().hasher.finalize().to_hex().to_string()
    }

    fn file(&self) -> &DigestReader {
        match &self.stream {
            Stream::Plain(reader) => reader.get_ref(),
            Stream::Gzip(decoder) => decoder.get_ref().get_ref(),
            Stream::Bzip2(decoder) => decoder.get_ref().get_ref(),
            Stream::Zstd(decoder) => decoder.get_ref().get_ref(),
        }
    }

    fn check_expansion(&self, packing: Packing) -> std::io::Result<()> {
        let packed = self.file().n_read;
        let limit = if self.unpacked > LARGE { MAX_RATIO_LARGE } else { MAX_RATIO };
        if self.unpacked > MIN_JUDGED_BYTES && self.unpacked / limit > packed {
            return Err(std::io::Error::other(Expansion { packing, packed, unpacked: self.unpacked, limit }));
        }
        Ok(())
    }
}

impl Read for Source {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.first.is_none() {
            let mut first = Vec::with_capacity(MARK.len());
            while first.len() < MARK.len() {
                let mut byte = [0];
                match self.read_on(&mut byte) {
                    Ok(0) => break,
                    Ok(_) => first.extend(byte),
                    Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                    Err(error) => return Err(error),
                }
            }
            self.first = Some(if first == MARK { Vec::new() } else { first });
        }
        match &mut self.first {
            Some(first) if !first.is_empty() => {
                let n_first = buffer.len().min(first.len());
                buffer[..n_first].copy_from_slice(&first[..n_first]);
                first.drain(..n_first);
                // Readers of binary formats look at more than these at once.
                match self.read_on(&mut buffer[n_first..]) {
                    Err(error) if error.kind() == std::io::ErrorKind::Interrupted => Ok(n_first),
                    read => Ok(n_first + read?),
                }
            }
            _ => self.read_on(buffer),
        }
    }
}

impl Source {
    /// Reads what follows the first bytes.
    fn read_on(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let (packing, read) = match &mut self.stream {
            Stream::Plain(reader) => return reader.read(buffer),
            Stream::Gzip(decoder) => (Packing::Gzip, decoder.read(buffer)),
            Stream::Bzip2(decoder) => (Packing::Bzip2, decoder.read(buffer)),
            Stream::Zstd(decoder) => (Packing::Zstd, decoder.read(buffer)),
        };
        let n_read = read.map_err(|error| damage(packing.data(), self.unpacked, error))?;
        self.unpacked += n_read as u64;
        self.check_expansion(packing)?;
        Ok(n_read)
    }
}

/// Marks what the decoder found wrong in the data, as opposed to what the system said.
pub(super) fn damage(data: &'static str, unpacked: u64, error: std::io::Error) -> std::io::Error {
    use std::io::ErrorKind::{InvalidData, InvalidInput, UnexpectedEof};
    match error.kind() {
        InvalidData | InvalidInput | UnexpectedEof => std::io::Error::other(Damage { data, unpacked, source: error }),
        _ => error,
    }
}

/// The error of reading `path` that an I/O error of a [`Source`] stands for.
pub(super) fn read_error(path: &Path, error: std::io::Error) -> Error {
    let path: PathBuf = path.to_owned();
    match error.downcast::<Expansion>() {
        Ok(Expansion { packing, packed, unpacked, limit }) => {
            Error::PackedExpansion { path, data: packing.data(), packed, unpacked, limit }
        }
        Err(error) => match error.downcast::<Damage>() {
            Ok(Damage { data, unpacked, source }) => Error::PackedDamaged { path, data, unpacked, source },
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

/// Packed data that expand beyond reason.
#[derive(Debug, thiserror::Error)]
#[error("{packed} bytes become {unpacked}")]
struct Expansion {
    packing: Packing,
    packed: u64,
    unpacked: u64,
    limit: u64,
}

/// Packed data that the decoder refuses.
#[derive(Debug, thiserror::Error)]
#[error("{source}")]
struct Damage {
    data: &'static str,
    /// Bytes that were unpacked before it.
    unpacked: u64,
    source: std::io::Error,
}
