//! Modes in a dataset of an HDF5 file.

use std::path::Path;

use super::dataset::Dataset;
use super::file::{H5, with_memory};
use super::group::{Group, Member};
use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::mode_format::ReadModes;
use crate::input::mode_matrix::{Order, checked_count, columns_of, refuse_not_finite};
use crate::input::value_unit::ValueUnit;

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
    let Some(name) = dataset else { return Err(dataset_missing(path)) };
    with_memory(path, || {
        let h5 = H5::open(path, allowance)?;
        columns_of_dataset(path, &Group::root(&h5)?.dataset(name.trim_start_matches('/'))?, n_rows)
    })
}

/// Modes and eigenvalues as the class `FEMinterface` of Exudyn saves them in HDF5: `modeBasis/matrix`, a mode in each column, and
/// `eigenValues` in (rad/s)², where it has computed them.
///
/// # Errors
/// Those of [`mode_columns`]; [`Error::ModesFormat`] for a file without such modes.
pub(in crate::input) fn feminterface_modes(path: &Path, n_rows: usize, allowance: &Allowance) -> Result<ReadModes> {
    with_memory(path, || {
        let h5 = H5::open(path, allowance)?;
        let root = Group::root(&h5)?;
        if root.member("modeBasis")? != Some(Member::Group) {
            return Err(dataset_missing(path));
        }
        let columns = columns_of_dataset(path, &root.dataset("modeBasis/matrix")?, n_rows)?;
        // Without eigenvalues Exudyn writes an empty list, which is a group.
        let values = match root.member("eigenValues")? {
            Some(Member::Dataset) => {
                Some(root.dataset("eigenValues")?.reals()?.values).filter(|values| !values.is_empty())
            }
            _ => None,
        };
        let values = values.map(|values| (ValueUnit::Eigenvalue, values));
        Ok(ReadModes { values, program: Some("Exudyn"), ..ReadModes::of_columns(columns) })
    })
}

/// Reads what [`feminterface_modes`] would, and discards it.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn rehearse_feminterface(path: &Path, allowance: &Allowance) -> Result<()> {
    let h5 = H5::open(path, allowance)?;
    let root = Group::root(&h5)?;
    for name in ["modeBasis/matrix", "eigenValues"] {
        let folder = name.split_once('/').map_or("", |(folder, _)| folder);
        let is_there = folder.is_empty() || root.member(folder)? == Some(Member::Group);
        if is_there && root.group(folder)?.member(name.rsplit('/').next().unwrap_or(name))? == Some(Member::Dataset) {
            root.dataset(name)?.reals()?;
        }
    }
    Ok(())
}

fn dataset_missing(path: &Path) -> Error {
    let (found, expected) = ("an HDF5 file".to_owned(), "a dataset of it as well, as in `model.h5:/V`");
    Error::ModesFormat { path: path.to_owned(), line: None, found, expected }
}

fn columns_of_dataset(path: &Path, dataset: &Dataset<'_>, n_rows: usize) -> Result<Vec<Vec<f64>>> {
    let shape = dataset.shape()?;
    let (n_columns, order) = match shape[..] {
        [rows] if rows == n_rows => (1, Order::ByColumns),
        [rows, columns] if rows == n_rows => (columns, Order::ByRows),
        [columns, rows] if rows == n_rows => (columns, Order::ByColumns),
        [rows] | [rows, _] => {
            return Err(Error::ModesRows { path: path.to_owned(), found: rows as u64, n: n_rows });
        }
        _ => {
            let (found, expected) = (format!("a dataset of extents {shape:?}"), "rows and modes");
            return Err(Error::ModesFormat { path: path.to_owned(), line: None, found, expected });
        }
    };
    let n_columns = checked_count(path, n_columns as u64, n_rows)?;
    let values = dataset.reals()?.values;
    let columns = columns_of(&values, [n_rows, n_columns], order);
    refuse_not_finite(path, &columns)?;
    Ok(columns)
}

/// Reads the numbers of a dataset and discards them.
///
/// # Errors
/// A file that cannot be read or has no such dataset.
pub(crate) fn rehearse_dataset(path: &Path, name: &str, allowance: &Allowance) -> Result<()> {
    let h5 = H5::open(path, allowance)?;
    Group::root(&h5)?.dataset(name.trim_start_matches('/'))?.reals().map(drop)
}
