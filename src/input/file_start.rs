//! The first bytes of a file and its name, by which formats are recognised.

use std::io::Read;
use std::path::Path;

use super::source::{Packing, Source, read_error};
use crate::error::Result;

/// Bytes from which a format is recognised.
const HEAD: u64 = 1 << 12;

/// The first bytes of a file, unpacked where they are packed, and its name.
pub(super) struct FileStart<'a> {
    pub(super) path: &'a Path,
    pub(super) head: Vec<u8>,
    /// How the file is packed; none where it is not.
    pub(super) packing: Option<Packing>,
}

impl<'a> FileStart<'a> {
    /// # Errors
    /// The errors of opening and reading the file.
    pub(super) fn of(path: &'a Path) -> Result<Self> {
        let source = Source::open(path)?;
        let packing = source.packing();
        let mut head = Vec::new();
        match source.take(HEAD).read_to_end(&mut head) {
            // What was unpacked before the damage tells the format; reading the file finds the damage again.
            Err(_) if packing.is_some() => {}
            read => read.map(drop).map_err(|error| read_error(path, error))?,
        }
        Ok(Self { path, head, packing })
    }

    /// Whether the name ends in one of these extensions, in whatever case.
    pub(super) fn has_extension(&self, known: &[&str]) -> bool {
        has_extension(self.path, known)
    }

    /// Whether it starts as HDF5 does, or does so behind the block of 512 bytes that MATLAB puts first. The library cannot read packed files.
    pub(super) fn is_hdf5(&self) -> bool {
        self.packing.is_none() && self.begins_as_hdf5()
    }

    /// Whether it is HDF5, packed or not.
    pub(super) fn begins_as_hdf5(&self) -> bool {
        const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
        [0, 512].iter().any(|at| self.head.get(*at..).is_some_and(|rest| rest.starts_with(SIGNATURE)))
    }

    /// Whether the first character that is not a blank opens a tag.
    #[cfg(feature = "hdf5")]
    pub(super) fn is_xml(&self) -> bool {
        self.head.trim_ascii_start().starts_with(b"<")
    }

    pub(super) fn holds(&self, word: &[u8]) -> bool {
        self.head.windows(word.len()).any(|window| window == word)
    }

    /// The lines of a text with neither space nor line end around them; empty ones are left out.
    pub(super) fn lines(&self) -> impl Iterator<Item = &[u8]> {
        self.head.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii).filter(|line| !line.is_empty())
    }
}

/// Whether a name ends in one of these extensions, in whatever case.
pub(super) fn has_extension(path: &Path, known: &[&str]) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    known.iter().any(|name| extension.eq_ignore_ascii_case(name))
}
