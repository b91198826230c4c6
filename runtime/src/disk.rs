//! Superelement files on a disk.

use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::vec::Vec;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::atomic_file::StagedFile;
use crate::error::{FileError, Result};
use crate::file::SealedBytes;
use crate::superelement::Superelement;

impl Superelement {
    /// Writes the file so that it appears whole or not at all, and returns its digest.
    ///
    /// To check the written bytes before they get their name, use [`StagedFile`] with [`Superelement::to_bytes`].
    ///
    /// # Errors
    ///
    /// [`FileError::Write`] or [`FileError::NotAFile`]; what stood under the name before is then untouched.
    pub fn write(&self, path: &Path) -> Result<String> {
        let SealedBytes { bytes, digest } = self.to_bytes()?;
        StagedFile::write(path, &bytes)?.commit()?;
        Ok(digest)
    }

    /// Reads a file.
    ///
    /// # Errors
    ///
    /// [`FileError::Read`], [`FileError::NotAFile`], [`FileError::OutOfMemory`], and those of
    /// [`Superelement::from_bytes`].
    pub fn open(path: &Path) -> Result<Self> {
        Self::from_bytes(&read(path)?)
    }
}

/// The bytes of a regular file, never more than its size says.
fn read(path: &Path) -> Result<Vec<u8>> {
    let failed = |source| FileError::Read { path: path.to_owned(), source };
    // Asked before opening: to open a pipe would wait for its writer.
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(FileError::NotAFile { path: path.to_owned() });
    }
    let file = File::open(path).map_err(failed)?;
    let size = file.metadata().map_err(failed)?.len();
    let too_large = FileError::OutOfMemory { bytes: size };
    let mut bytes = Vec::new();
    if usize::try_from(size).ok().and_then(|size| bytes.try_reserve_exact(size).ok()).is_none() {
        return Err(too_large);
    }
    file.take(size).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}
