//! The bytes of a superelement file, written and read.

use alloc::string::String;
use alloc::vec::Vec;

use crate::container::{self, Container};
use crate::error::Result;
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
    /// [`FileError::HeaderTooLarge`](crate::FileError::HeaderTooLarge) if the metadata exceed the 100 MB that readers of the format accept.
    pub fn to_bytes(&self) -> Result<SealedBytes> {
        let mut bytes = container::assemble(&document::write(self.metadata())?, &encoding::encode(self.tensors()))?;
        let digest = document::seal(&mut bytes)?;
        Ok(SealedBytes { bytes, digest })
    }

    /// A superelement from the bytes of its file, after every check of the format.
    ///
    /// # Errors
    ///
    /// One variant of [`FileError`](crate::FileError) for each way in which bytes can fail to be a superelement.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let mut container = Container::split(bytes)?;
        let document = document::parse(&container.take_metadata()?)?;
        let tensors = container.tensors()?;
        document::check_digest(bytes, container.header, &document.digest)?;
        Self::new(encoding::decode(&tensors)?, document.metadata()?)
    }
}

/// What the start of a file, up to the end of its header, shows to be wrong where `n_data` bytes follow: all that
/// [`Superelement::from_bytes`] would find before it looks at a number.
#[cfg(feature = "std")]
pub(crate) fn check_header(start: &[u8], n_data: u64) -> Result<()> {
    let mut container = Container::split(start)?;
    document::parse(&container.take_metadata()?)?;
    container.layout(n_data).map(drop)
}
