//! How a group stores a sparse matrix, and reading it.

use super::attribute;
use super::group::{Group, Member};
use crate::error::{Error, Result};
use crate::input::compressed::{Compressed, Major};
use crate::input::indices::Indices;

/// How a group stores a sparse matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Convention {
    /// Compressed columns `jc`, `ir`, `data`; the attribute `MATLAB_sparse` is the number of rows.
    Matlab,
    /// `data`, `indices`, `indptr`, with the shape in this attribute.
    ShapeAttribute(&'static str),
    /// `data`, `indices`, `indptr`, with the shape in a dataset `shape` or, without one, square.
    ShapeDataset,
    /// Datasets of these names.
    Named(NamedParts),
}

/// What a file says of its entries next to where they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Told {
    /// Whether rows or columns are compressed.
    Columns,
    /// That, and that the matrix is symmetric: one triangle stands for both.
    Symmetric,
    /// Nothing.
    Nothing,
    /// In a text, which is not read, whether rows or columns are compressed, and whether one triangle stands for both.
    InText,
}

/// Names of the parts of compressed columns or rows, one dataset each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct NamedParts {
    /// Pointers, indices, values.
    parts: [&'static str; 3],
    /// Rows and columns; none for a square matrix.
    sizes: Option<[&'static str; 2]>,
    /// The first index.
    base: i64,
    /// Whether columns are compressed, not rows or either.
    tells_columns: bool,
}

/// Octave, Julia (a group with the fields of `SparseMatrixCSC`) and Binsparse.
const NAMED: [NamedParts; 3] = [
    NamedParts { parts: ["cidx", "ridx", "data"], sizes: Some(["nr", "nc"]), base: 0, tells_columns: true },
    NamedParts { parts: ["colptr", "rowval", "nzval"], sizes: Some(["m", "n"]), base: 1, tells_columns: true },
    NamedParts { parts: ["pointers_to_1", "indices_1", "values"], sizes: None, base: 0, tells_columns: false },
];

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
        let has_all =
            |parts: &NamedParts| parts.parts.iter().chain(parts.sizes.iter().flatten()).all(|name| has_dataset(name));
        if let Some(named) = NAMED.into_iter().find(has_all) {
            return Ok(Some(Self::Named(named)));
        }
        if !["data", "indices", "indptr"].into_iter().all(has_dataset) {
            return Ok(None);
        }
        Ok(Some(if has("shape") { Self::ShapeAttribute("shape") } else { Self::ShapeDataset }))
    }

    /// What a file of this convention says of its entries.
    pub(super) fn tells(self) -> Told {
        match self {
            Self::Named(parts) if !parts.tells_columns => Told::InText,
            Self::Matlab | Self::Named(_) => Told::Columns,
            Self::ShapeAttribute(_) | Self::ShapeDataset => Told::Nothing,
        }
    }

    /// Reads the group, and the digits its values are stored with.
    pub(super) fn read(self, group: &Group<'_>) -> Result<(Compressed, u32)> {
        match self {
            Self::Matlab => read_matlab(group),
            Self::Named(parts) => read_named(group, parts),
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
        (None, None) => (Indices::default(), None),
        _ => (group.dataset("ir")?.indices(0)?, Some(group.dataset("data")?.reals_of_matlab()?)),
    };
    let pointers = pointers.integers()?;
    let n_cols = pointers.len().saturating_sub(1) as u64;
    let digits = reals.as_ref().map_or(u32::MAX, |r| r.digits);
    let values = reals.map_or_else(Vec::new, |r| r.values);
    let names = ["jc", "ir", "data"].map(|name| group.child_name(name));
    let shape = [n_rows, n_cols];
    Ok((Compressed::new(Major::Columns, shape, pointers, indices, values, names), digits))
}

fn read_named(group: &Group<'_>, named: NamedParts) -> Result<(Compressed, u32)> {
    let [pointers, indices, values] = named.parts;
    let size = |name: &str| -> Result<u64> {
        let sizes = counts(group.dataset(name)?.integers()?);
        Ok(sizes.first().copied().unwrap_or(u64::MAX))
    };
    let pointers = group.dataset(pointers)?.integers()?;
    let pointers: Vec<i64> = pointers.into_iter().map(|number| number.saturating_sub(named.base)).collect();
    let indices = group.dataset(indices)?.indices(named.base)?;
    let n_major = pointers.len().saturating_sub(1) as u64;
    let shape = match named.sizes {
        Some([rows, columns]) => [size(rows)?, size(columns)?],
        None => [n_major; 2],
    };
    let reals = group.dataset(values)?.reals()?;
    let names = named.parts.map(|name| group.child_name(name));
    let major = if named.tells_columns { Major::Columns } else { Major::Rows };
    let compressed = Compressed::new(major, shape, pointers, indices, reals.values, names).counted_from(named.base);
    Ok((compressed, reals.digits))
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
    let indices = group.dataset("indices")?.indices(0)?;
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
