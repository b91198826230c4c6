//! Paths that name a matrix in a file after a colon: `model.h5:/K`, `model.op4:KAA`.

use std::path::{Path, PathBuf};

use super::file_start::has_extension;

/// Extensions of files that hold several matrices, so that a missing one of them is missed by its own name.
const CONTAINERS: [&str; 15] =
    ["supel", "h5", "hdf5", "hdf", "mat", "h5ad", "he5", "op4", "pch", "bdf", "nas", "dat", "npz", "jld2", "punch"];

/// The file of a path, and the matrix in it that follows a colon.
pub(super) fn split_member(path: &Path) -> (PathBuf, Option<String>) {
    if let Some((file, member)) = path.to_str().and_then(|text| text.rsplit_once(':'))
        && !member.is_empty()
        && !path.exists()
        && (has_extension(Path::new(file), &CONTAINERS) || Path::new(file).is_file())
    {
        return (file.into(), Some(member.to_owned()));
    }
    (path.to_owned(), None)
}
