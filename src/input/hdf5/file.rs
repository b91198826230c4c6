//! An HDF5 file opened for reading.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use hdf5_metno::{LinkType, MajorErrorCode, MinorErrorCode};

use crate::error::{Error, Result};
use crate::heap;
use crate::input::allowance::{Allowance, Claim};
use crate::regular_file;

/// The first bytes of every HDF5 superblock.
const SIGNATURE: [u8; 8] = *b"\x89HDF\r\n\x1a\n";

/// The links of a group by their names.
pub(super) type Links = BTreeMap<String, LinkType>;

/// An open HDF5 file.
pub(super) struct H5<'a> {
    pub(super) file: hdf5_metno::File,
    pub(super) path: PathBuf,
    n_bytes: u64,
    /// What was read takes so much.
    claim: Claim<'a>,
    /// Links of the groups that were looked into, by path: the library looks from the first link on for every name.
    pub(super) links: RefCell<HashMap<String, Rc<Links>>>,
}

impl<'a> H5<'a> {
    /// Opens a file after looking at its signature, which gives a clearer refusal than the library does.
    pub(super) fn open(path: &Path, allowance: &'a Allowance) -> Result<Self> {
        let n_bytes = check_signature(path)?;
        start()?;
        let file = hdf5_metno::File::open(path)
            .map_err(|e| no_memory(&e).unwrap_or(Error::Hdf5Open { path: path.to_owned(), reason: e.to_string() }))?;
        let (claim, links) = (allowance.claim(path), RefCell::default());
        Ok(Self { file, path: path.to_owned(), n_bytes, claim, links })
    }

    /// Claims bytes that are about to be held.
    pub(super) fn hold(&self, bytes: u64) -> Result<()> {
        self.claim.add(bytes)
    }

    /// What stays of everything that was read takes so much.
    pub(super) fn keep(&self, bytes: u64) -> Result<()> {
        self.claim.set(bytes)
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn n_bytes(&self) -> u64 {
        self.n_bytes
    }

    pub(super) fn read_error(&self, object: &str, error: &hdf5_metno::Error) -> Error {
        let damaged =
            || Error::Hdf5Read { path: self.path.clone(), object: object.to_owned(), reason: error.to_string() };
        no_memory(error).unwrap_or_else(damaged)
    }
}

/// Starts the library, quietly. It does not survive a lack of memory while it starts, so that some is asked for before.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(crate) fn start() -> Result<()> {
    /// Many times what the library takes.
    const ROOM: usize = 8 << 20;
    heap::fallibly(|| Vec::<u8>::new().try_reserve_exact(ROOM)).map_err(|_| NO_MEMORY)?;
    hdf5_metno::silence_errors(true);
    Ok(())
}

/// The error of the library where it had no memory: its own words do not tell that from a damaged file.
fn no_memory(error: &hdf5_metno::Error) -> Option<Error> {
    is_out_of_memory(error).then_some(NO_MEMORY)
}

/// Whether the library failed because it had no memory.
pub(super) fn is_out_of_memory(error: &hdf5_metno::Error) -> bool {
    error.contains_minor(MinorErrorCode::NoSpace) || error.contains_major(MajorErrorCode::Resource)
}

const NO_MEMORY: Error = Error::OutOfMemory { what: "what the HDF5 library needs to read the input" };

/// Reads a file by `read`, and where the library says that it has no memory finds out whether there is none: a damaged file may ask for
/// any amount of it.
///
/// # Errors
/// [`Error::OutOfMemory`] where there is no memory; [`Error::Hdf5Open`] where there is, and the library fails all the same; those of
/// `read`.
pub(super) fn with_memory<T>(path: &Path, read: impl Fn() -> Result<T>) -> Result<T> {
    /// More than the library needs for a sound file besides the values, which are ours.
    const OF_LIBRARY: u64 = 64 << 20;
    let is_out = |outcome: &Result<T>| matches!(outcome, Err(Error::OutOfMemory { .. }));
    let first = read();
    if !is_out(&first) {
        return first;
    }
    let needed = OF_LIBRARY.saturating_add(std::fs::metadata(path).map_or(0, |file| file.len()));
    let is_there = heap::fallibly(|| Vec::<u8>::new().try_reserve_exact(usize::try_from(needed).unwrap_or(usize::MAX)));
    if is_there.is_err() {
        return first;
    }
    let second = read();
    if is_out(&second) {
        let reason = "it asks for more memory than there is, and no sound file of its size does".to_owned();
        return Err(Error::Hdf5Open { path: path.to_owned(), reason });
    }
    second
}

/// Length of a file that carries the HDF5 signature at 0, 512, 1024, 2048 and so on (MATLAB writes 512 bytes before it).
fn check_signature(path: &Path) -> Result<u64> {
    let read = |source| Error::Read { path: path.to_owned(), source };
    let mut file = regular_file::open(path)?;
    let length = file.metadata().map_err(read)?.len();
    let mut offset = 0;
    while offset < length {
        let mut bytes = Vec::with_capacity(SIGNATURE.len());
        file.seek(SeekFrom::Start(offset)).map_err(read)?;
        file.by_ref().take(SIGNATURE.len() as u64).read_to_end(&mut bytes).map_err(read)?;
        if bytes == SIGNATURE {
            return Ok(length);
        }
        offset = if offset == 0 { 512 } else { offset.saturating_mul(2) };
    }
    file.seek(SeekFrom::Start(0)).map_err(read)?;
    let mut head = Vec::with_capacity(32);
    file.take(32).read_to_end(&mut head).map_err(read)?;
    let (found, advice) = looks_like(&head);
    Err(Error::Hdf5Signature { path: path.to_owned(), found, advice })
}

/// What a file that is not HDF5 is, judged by its first bytes, and what to do about it.
fn looks_like(head: &[u8]) -> (&'static str, &'static str) {
    const KINDS: [(&[u8], &str, &str); 5] = [
        (b"\xc0\xa8\xa3\xa9", "a CGNS file in ADF", "convert it with adf2hdf"),
        (b"@(#)ADF", "a CGNS file in ADF", "convert it with adf2hdf"),
        (b"\x1f\x8b", "a gzip file", "unpack it"),
        (b"CDF", "a classic netCDF file", "convert it with nccopy -k netCDF-4"),
        (b"%%MatrixMarket", "a Matrix Market file", "give it the name .mtx"),
    ];
    if head.is_empty() {
        return ("an empty file", "write it again");
    }
    KINDS
        .iter()
        .find(|(magic, ..)| head.starts_with(magic))
        .map_or(("other bytes", "check the name of the file"), |&(_, found, advice)| (found, advice))
}
