//! Superelement files on a disk.

use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::vec::Vec;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::atomic_file::StagedFile;
use crate::container::{PREFIX, header_length};
use crate::error::{FileError, Result};
use crate::file::{SealedBytes, check_header};
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
    /// The errors of [`file_bytes`] and of [`Superelement::from_bytes`].
    pub fn open(path: &Path) -> Result<Self> {
        Self::from_bytes(&file_bytes(path)?)
    }
}

/// The bytes of a superelement file, for [`Superelement::from_bytes`]. Header and length are checked before the numbers are read,
/// so that a large file of another kind costs nothing.
///
/// # Errors
///
/// [`FileError::Read`], [`FileError::NotAFile`], [`FileError::OutOfMemory`], and what the header already shows to be no superelement.
pub fn file_bytes(path: &Path) -> Result<Vec<u8>> {
    let failed = |source| FileError::Read { path: path.to_owned(), source };
    // Checked before opening: opening a pipe would wait for its writer.
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(FileError::NotAFile { path: path.to_owned() });
    }
    let file = File::open(path).map_err(failed)?;
    let size = file.metadata().map_err(failed)?.len();
    // Never read more than the size says: files that the kernel makes up have size zero, and reading them may block.
    let mut file = file.take(size);
    let mut bytes = Vec::new();
    file.by_ref().take(PREFIX as u64).read_to_end(&mut bytes).map_err(failed)?;
    let n_header = header_length(&bytes)?;
    file.by_ref().take(n_header).read_to_end(&mut bytes).map_err(failed)?;
    check_header(&bytes, size.saturating_sub(bytes.len() as u64))?;
    if usize::try_from(size).ok().and_then(|size| bytes.try_reserve_exact(size - bytes.len()).ok()).is_none() {
        return Err(FileError::OutOfMemory { bytes: size });
    }
    file.read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}
