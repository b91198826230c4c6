//! Sparse matrices in HDF5 groups, by the conventions of the programs that write them.

use std::path::Path;

use super::attribute;
use super::compressed::{Compressed, Major};
use super::file::{Group, H5, Member, with_memory};
use super::search::{MatrixRole, find_matrix};
use crate::error::{Error, Result};
use crate::input::foreign::{self, Wanted};
use crate::input::regular::digest;
use crate::input::{Allowance, MatrixInput, significant_digits};
use crate::sparse::Declared;

/// Bytes of an entry before it is in its row: row, column, value.
const TRIPLET: u64 = 16;
/// Bytes of an entry of the assembled matrix: column and value.
const ENTRY: u64 = 12;
/// Bytes of a row of the assembled matrix.
const ROW: u64 = 8;

/// Reads a square sparse matrix from an HDF5 file: MATLAB v7.3 and PETSc (`MATLAB_sparse`, `jc`, `ir`, `data`), anndata,
/// h5sparse, Exudyn, or plain `data`, `indices`, `indptr`.
///
/// `group` is the path of the matrix in the file, or of a group below which it lies. Without it the whole file is
/// searched: the only matrix is taken, or the only one whose name says `role`. Where one triangle is stored it is
/// mirrored, which the notes tell.
///
/// # Errors
///
/// The file cannot be read or is not HDF5, holds no matrix or several that could be meant, or the matrix is not square,
/// its pointers or indices are wrong or a value is not finite.
pub fn read_matrix(path: &Path, group: Option<&str>, role: MatrixRole) -> Result<MatrixInput> {
    read_matrix_within(path, group, role, &Allowance::of(None))
}

/// [`read_matrix`] in the memory that is allowed.
///
/// # Errors
///
/// [`Error::MemoryRead`] and those of [`read_matrix`].
pub(crate) fn read_matrix_within(
    path: &Path,
    group: Option<&str>,
    role: MatrixRole,
    allowance: &Allowance,
) -> Result<MatrixInput> {
    with_memory(path, || read_matrix_once(path, group, role, allowance))
}

fn read_matrix_once(path: &Path, group: Option<&str>, role: MatrixRole, allowance: &Allowance) -> Result<MatrixInput> {
    foreign::refuse(path, Wanted::Matrix)?;
    let h5 = H5::open(path, allowance)?;
    let start = h5.root()?.group(group.unwrap_or("/"))?;
    let stated = if group.is_some() { Convention::of(&start, &start.members()?)? } else { None };
    let (group, convention) = match stated {
        Some(convention) => (start, convention),
        None => find_matrix(start, role)?,
    };
    let (compressed, stored_digits) = convention.read(&group)?;
    let digits = significant_digits(compressed.values()).min(stored_digits);
    let n = compressed.check(h5.path(), group.name())?;
    h5.hold((TRIPLET + ENTRY) * compressed.values().len() as u64 + ROW * n as u64)?;
    let (matrix, notes) = compressed.into_triplets(h5.path())?.assemble(n, Declared::General, h5.path())?;
    h5.keep(ENTRY * matrix.nnz() as u64 + ROW * n as u64)?;
    Ok(MatrixInput { matrix, notes, digits, path: path.to_owned(), digest: digest(path)? })
}

/// How a group stores a sparse matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Convention {
    /// Compressed columns `jc`, `ir`, `data`; the attribute `MATLAB_sparse` is the number of rows.
    Matlab,
    /// `data`, `indices`, `indptr`, with the shape in this attribute.
    ShapeAttribute(&'static str),
    /// `data`, `indices`, `indptr`, with the shape in a dataset `shape` or, without one, square.
    ShapeDataset,
}

impl Convention {
    /// The convention of a group, judged by the names of its attributes and members.
    pub(super) fn of(group: &Group<'_>, members: &[(String, Member)]) -> Result<Option<Self>> {
        let names = group.location().attr_names().map_err(|e| group.h5().read_error(group.name(), &e))?;
        let has = |name: &str| names.iter().any(|n| n == name);
        if has("MATLAB_sparse") {
            return Ok(Some(Self::Matlab));
        }
        if has("h5sparse_shape") {
            return Ok(Some(Self::ShapeAttribute("h5sparse_shape")));
        }
        let has_dataset = |name: &str| members.iter().any(|(n, m)| n == name && *m != Member::Group);
        if !["data", "indices", "indptr"].into_iter().all(has_dataset) {
            return Ok(None);
        }
        Ok(Some(if has("shape") { Self::ShapeAttribute("shape") } else { Self::ShapeDataset }))
    }

    /// Reads the group, and the digits its values are stored with.
    fn read(self, group: &Group<'_>) -> Result<(Compressed, u32)> {
        match self {
            Self::Matlab => read_matlab(group),
            Self::ShapeAttribute(name) => read_compressed(group, shape_attribute(group, name)?),
            Self::ShapeDataset => {
                let shape = group.find_dataset("shape")?.map(|d| d.integers()).transpose()?;
                read_compressed(group, shape.map(counts))
            }
        }
    }
}

/// MATLAB leaves `data` and `ir` away where a matrix has no entry.
fn read_matlab(group: &Group<'_>) -> Result<(Compressed, u32)> {
    let n_rows = shape_attribute(group, "MATLAB_sparse")?.and_then(|v| v.first().copied()).unwrap_or(0);
    let pointers = group.dataset("jc")?;
    let (indices, reals) = match (group.find_dataset("ir")?, group.find_dataset("data")?) {
        (None, None) => (Vec::new(), None),
        _ => (group.dataset("ir")?.integers()?, Some(group.dataset("data")?.reals()?)),
    };
    let pointers = pointers.integers()?;
    let n_cols = pointers.len().saturating_sub(1) as u64;
    let digits = reals.as_ref().map_or(u32::MAX, |r| r.digits);
    let values = reals.map_or_else(Vec::new, |r| r.values);
    let names = ["jc", "ir", "data"].map(|name| group.child_name(name));
    let shape = [n_rows, n_cols];
    Ok((Compressed::new(Major::Columns, shape, pointers, indices, values, names), digits))
}

/// Whether rows or columns are compressed stands in a text that is not read (see [`attribute`]); the matrices wanted are
/// symmetric, for which both are the same.
fn read_compressed(group: &Group<'_>, stated: Option<Vec<u64>>) -> Result<(Compressed, u32)> {
    let pointers = group.dataset("indptr")?.integers()?;
    let n_major = pointers.len().saturating_sub(1) as u64;
    let shape = match stated.as_deref() {
        None => [n_major, n_major],
        Some(&[n_rows, n_cols]) => [n_rows, n_cols],
        Some(other) => {
            let (path, object) = (group.h5().path().to_owned(), group.child_name("shape"));
            let found = format!("{other:?}");
            return Err(Error::Hdf5Shape { path, object, found, expected: "two numbers, rows and columns".to_owned() });
        }
    };
    let indices = group.dataset("indices")?.integers()?;
    let reals = group.dataset("data")?.reals()?;
    let names = ["indptr", "indices", "data"].map(|name| group.child_name(name));
    Ok((Compressed::new(Major::Rows, shape, pointers, indices, reals.values, names), reals.digits))
}

/// Numbers of rows and columns in an attribute.
fn shape_attribute(group: &Group<'_>, name: &str) -> Result<Option<Vec<u64>>> {
    Ok(attribute::integers(group.h5(), group.location(), group.name(), name)?.map(counts))
}

/// A negative count becomes one that no pointer array can match.
fn counts(values: Vec<i64>) -> Vec<u64> {
    values.into_iter().map(|v| u64::try_from(v).unwrap_or(u64::MAX)).collect()
}
