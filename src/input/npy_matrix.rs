//! A dense matrix in an array of NumPy.

use super::file_start::FileStart;
use super::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use super::npy_header::is_array;
use super::npy_series;
use super::numpy_array::Array;
use super::source::Source;
use crate::error::Result;
use crate::job::Layout;
use crate::regular_file::digest;

/// `numpy.save` of a square array, or one of several that Exudyn saves.
pub(super) struct NpyMatrix;

impl Format for NpyMatrix {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        if is_array(&start.head) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl MatrixFormat for NpyMatrix {
    fn layout(&self) -> Layout {
        Layout::Npy
    }

    fn has_members(&self) -> bool {
        true
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let declared = source.role.undeclared();
        let path = source.file.as_path();
        let (entries, n, stored) = match &source.member {
            Some(name) => npy_series::array(path, name)?.dense(source, declared)?,
            None => Array::open(path, "NumPy array", "the array", Source::open(path)?)?.dense(source, declared)?,
        };
        let mut input = entries.into_matrix(source, (n, declared), digest(&source.file)?)?;
        input.digits = input.digits.at_most(stored);
        Ok(ReadMatrix::with_size(input))
    }
}
