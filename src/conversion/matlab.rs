//! MATLAB v7.3: compressed columns in a group of an HDF5 file, behind the block of 512 bytes by which MATLAB knows its files.

use std::path::Path;

use supel_runtime::StagedWriter;

use super::by_columns::ByColumns;
#[cfg(not(feature = "hdf5"))]
use crate::error::Error;
use crate::error::Result;

/// Writes a matrix into the file that `out` is, with the HDF5 library.
#[cfg(feature = "hdf5")]
pub(super) fn write(name: &str, matrix: &ByColumns<'_>, path: &Path, out: &mut StagedWriter) -> Result<()> {
    use std::io::Write;

    use crate::error::Error;

    let failed =
        |error: hdf5_metno::Error| Error::Write { path: path.to_owned(), source: std::io::Error::other(error) };
    crate::input::start_hdf5()?;
    let temporary = out.path().to_owned();
    library::write(&temporary, name, matrix).map_err(failed)?;
    // The library leaves this block alone.
    out.write_all(&block()).map_err(|source| Error::Write { path: path.to_owned(), source })
}

#[cfg(not(feature = "hdf5"))]
pub(super) fn write(_: &str, _: &ByColumns<'_>, path: &Path, _: &mut StagedWriter) -> Result<()> {
    Err(Error::FeatureMissing { path: path.to_owned(), feature: "hdf5" })
}

/// Bytes of the block.
#[cfg(feature = "hdf5")]
const BLOCK: usize = 512;

/// Text of 116 bytes, eight that mean nothing, the version and the order of bytes.
#[cfg(feature = "hdf5")]
fn block() -> Vec<u8> {
    let text = format!(
        "MATLAB 7.3 MAT-file, written by {} {}, HDF5 schema 1.00 .",
        env!("CARGO_PKG_NAME"),
        env!("CARGO_PKG_VERSION")
    );
    let mut block = format!("{text:116}").into_bytes();
    block.extend_from_slice(&[0; 8]);
    block.extend_from_slice(b"\x00\x02IM");
    block.resize(BLOCK, 0);
    block
}

#[cfg(feature = "hdf5")]
mod library {
    use std::path::Path;

    use hdf5_metno::types::FixedAscii;
    use hdf5_metno::{FileBuilder, H5Type, Result};

    use super::BLOCK;
    use crate::conversion::by_columns::ByColumns;

    pub(super) fn write(path: &Path, name: &str, matrix: &ByColumns<'_>) -> Result<()> {
        let mut builder = FileBuilder::new();
        builder.with_fcpl(|properties| properties.userblock(BLOCK as u64));
        let file = builder.create(path)?;
        let group = file.create_group(name)?;
        let class = FixedAscii::<6>::from_ascii(b"double").map_err(|error| error.to_string())?;
        group.new_attr::<FixedAscii<6>>().create("MATLAB_class")?.write_scalar(&class)?;
        group.new_attr::<u64>().create("MATLAB_sparse")?.write_scalar(&(matrix.order() as u64))?;
        dataset(&group, "jc", &matrix.pointers())?;
        // MATLAB leaves both out of a matrix without entries.
        if !matrix.values().is_empty() {
            let rows: Vec<u64> = matrix.rows().iter().map(|row| u64::from(*row)).collect();
            dataset(&group, "ir", &rows)?;
            drop(rows);
            dataset(&group, "data", matrix.values())?;
        }
        file.flush()
    }

    /// An array without the time of its making, so that the bytes are those of any day.
    fn dataset<T: H5Type>(group: &hdf5_metno::Group, name: &str, values: &[T]) -> Result<()> {
        let builder = group.new_dataset_builder().obj_track_times(false);
        builder.with_data(values).create(name).map(drop)
    }
}
