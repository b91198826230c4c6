//! Modes in a dataset of an HDF5 file.

use std::path::Path;

use super::file::{H5, with_memory};
use super::group::Group;
use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::mode_matrix::{Order, checked_count, columns_of, refuse_not_finite};

/// The modes of a dataset. Its extents are rows and modes, or modes and rows as MATLAB and Fortran write a matrix of one mode a
/// column: the rows of the matrices tell which.
///
/// # Errors
/// [`Error::ModesRows`] and [`Error::ModesColumns`] for another size, [`Error::ModesFormat`] for other extents, a path that the file
/// does not have, or numbers that are none; those of reading the file.
pub(crate) fn mode_columns(
    path: &Path,
    dataset: Option<&str>,
    n_rows: usize,
    allowance: &Allowance,
) -> Result<Vec<Vec<f64>>> {
    let wrong = |found: String, expected| Error::ModesFormat { path: path.to_owned(), line: None, found, expected };
    let Some(name) = dataset else {
        return Err(wrong("an HDF5 file".to_owned(), "a dataset of it as well, as in `model.h5:/V`"));
    };
    with_memory(path, || {
        let h5 = H5::open(path, allowance)?;
        let dataset = Group::root(&h5)?.dataset(name.trim_start_matches('/'))?;
        let shape = dataset.shape()?;
        let (n_columns, order) = match shape[..] {
            [rows] if rows == n_rows => (1, Order::ByColumns),
            [rows, columns] if rows == n_rows => (columns, Order::ByRows),
            [columns, rows] if rows == n_rows => (columns, Order::ByColumns),
            [rows] | [rows, _] => {
                return Err(Error::ModesRows { path: path.to_owned(), found: rows as u64, n: n_rows });
            }
            _ => return Err(wrong(format!("a dataset of extents {shape:?}"), "rows and modes")),
        };
        let n_columns = checked_count(path, n_columns as u64, n_rows)?;
        let values = dataset.reals()?.values;
        let columns = columns_of(&values, [n_rows, n_columns], order);
        refuse_not_finite(path, &columns)?;
        Ok(columns)
    })
}

/// Reads the numbers of a dataset and discards them.
///
/// # Errors
/// A file that cannot be read or has no such dataset.
pub(crate) fn rehearse_dataset(path: &Path, name: &str, allowance: &Allowance) -> Result<()> {
    let h5 = H5::open(path, allowance)?;
    Group::root(&h5)?.dataset(name.trim_start_matches('/'))?.reals().map(drop)
}
