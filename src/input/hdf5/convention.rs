//! How a group stores a sparse matrix, and reading it.

use super::attribute;
use super::compressed::{Compressed, Major};
use super::group::{Group, Member};
use crate::error::{Error, Result};

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

    /// Whether a file of this convention says if rows or columns are compressed.
    pub(super) fn tells_rows_from_columns(self) -> bool {
        matches!(self, Self::Matlab)
    }

    /// Reads the group, and the digits its values are stored with.
    pub(super) fn read(self, group: &Group<'_>) -> Result<(Compressed, u32)> {
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

/// Whether rows or columns are compressed stands in a text that is not read (see [`attribute`]); stiffness and mass are symmetric, for
/// which both are the same, and of further matrices only symmetric ones are taken from such a file.
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
