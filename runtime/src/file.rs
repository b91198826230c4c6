//! Writing and reading superelement files.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::atomic_file::StagedFile;
use crate::container::{self, Container};
use crate::error::{FileError, Result};
use crate::superelement::Superelement;
use crate::{document, encoding};

/// The bytes of a superelement file and the digest they carry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SealedBytes {
    /// The whole file.
    pub bytes: Vec<u8>,
    /// BLAKE3 over the file with the digest's own 64 characters taken as zeros, lower-case hexadecimal.
    pub digest: String,
}

impl Superelement {
    /// The file as bytes: the same superelement gives the same bytes.
    ///
    /// # Errors
    ///
    /// [`FileError::HeaderTooLarge`] if the metadata exceed the 100 MB that readers of the format accept.
    pub fn to_bytes(&self) -> Result<SealedBytes> {
        let mut bytes = container::assemble(&document::write(self.metadata())?, &encoding::encode(self.tensors()))?;
        let digest = document::seal(&mut bytes)?;
        Ok(SealedBytes { bytes, digest })
    }

    /// A superelement from the bytes of its file, after every check of the format.
    ///
    /// # Errors
    ///
    /// One variant of [`FileError`] for each way in which bytes can fail to be a superelement.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let mut container = Container::split(bytes)?;
        let document = document::parse(&container.take_metadata()?)?;
        let tensors = container.tensors()?;
        document::check_digest(bytes, container.header, &document.digest)?;
        Self::new(encoding::decode(&tensors)?, document.metadata()?)
    }

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
