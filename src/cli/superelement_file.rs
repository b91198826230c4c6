//! A superelement file that a command reads.

use std::path::Path;

use supel_runtime::{Superelement, file_bytes};

use crate::error::{Error, Result};
use crate::regular_file;

/// The superelement in a file, and the bytes of that.
///
/// # Errors
/// A file that cannot be read, is none or holds none.
pub(super) fn read(path: &Path) -> Result<(Superelement, Vec<u8>)> {
    let failed = |error| Error::of_superelement(path, error);
    regular_file::open(path).map(drop)?;
    let bytes = file_bytes(path).map_err(failed)?;
    let superelement = Superelement::from_bytes(&bytes).map_err(failed)?;
    Ok((superelement, bytes))
}
