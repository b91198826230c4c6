//! A dense matrix in an array of NumPy.

use super::file_start::FileStart;
use super::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use super::npy_header::is_array;
use super::numpy_array::Array;
use super::source::Source;
use crate::error::Result;
use crate::job::Layout;
use crate::regular_file::digest;

/// `numpy.save` of a square array.
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

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let declared = source.role.undeclared();
        let array = Array::open(&source.file, "NumPy array", "the array", Source::open(&source.file)?)?;
        let (entries, n, stored) = array.dense(source, declared)?;
        let mut input = entries.into_matrix(source, (n, declared), digest(&source.file)?)?;
        input.digits = input.digits.at_most(stored);
        Ok(ReadMatrix::with_size(input))
    }
}
