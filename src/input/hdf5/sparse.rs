//! Sparse matrices in HDF5 groups, by the conventions of the programs that write them.

use std::path::Path;

use supel_runtime::Symmetry;

use super::convention::{Convention, Told};
use super::dataset::Dataset;
use super::file::{H5, with_memory};
use super::nastran;
use super::numbers::Reals;
use super::search::find_matrix;
use crate::error::{Error, Result};
use crate::input::compressed::{Compressed, Major};
use crate::input::file_start::FileStart;
use crate::input::further_matrix::first_breach;
use crate::input::hdf5::group::Group;
use crate::input::indices::Indices;
use crate::input::unsupported_format::{self, Wanted};
use crate::input::{Allowance, MatrixInput, MatrixRole, digits_of};
use crate::regular_file::digest;
use crate::sparse::{Declared, ENTRY_BYTES, Given, ROW_BYTES, TRIPLET_BYTES};

/// Reads a square sparse matrix from an HDF5 file: MATLAB v7.3 and PETSc (`MATLAB_sparse`, `jc`, `ir`, `data`), anndata,
/// h5sparse, Exudyn, Octave, Julia, Binsparse, the tables of MSC Nastran, or plain `data`, `indices`, `indptr`.
///
/// `group` is the path of the matrix in the file, or of a group below which it lies. Without it the whole file is
/// searched: the only matrix is taken, or the only one whose name says `role`. Where one triangle is stored it is
/// mirrored, which the notes tell; a further matrix is taken as it is stored.
///
/// # Errors
///
/// The file cannot be read or is not HDF5, holds no matrix or several that could be meant, or the matrix is not square,
/// its pointers or indices are wrong or a value is not finite.
pub fn read_matrix(path: &Path, group: Option<&str>, role: MatrixRole) -> Result<MatrixInput> {
    unsupported_format::refuse(&FileStart::of(path)?, Wanted::Matrix)?;
    read_matrix_within(path, group, role, &Allowance::of(None))
}

/// [`read_matrix`] in the memory that is allowed, of a file that is no other known format.
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
    let h5 = H5::open(path, allowance)?;
    let root = Group::root(&h5)?;
    let found = match nastran::tables(&root)? {
        Some(tables) => {
            let (compressed, name, told) = nastran::read(&tables, group, role)?;
            Found { compressed, name, digits: u32::MAX, told }
        }
        None => match group.map(|name| root.find_dense(name)).transpose()?.flatten() {
            Some(dataset) => Found::dense(&dataset)?,
            None => Found::in_groups(root, group, role)?,
        },
    };
    let declared = found.declared(role);
    let Found { compressed, name, digits, told } = found;
    let digits = digits_of(compressed.values()).at_most(digits);
    let n = compressed.check(h5.path(), &name)?;
    h5.hold((TRIPLET_BYTES + ENTRY_BYTES) * compressed.values().len() as u64 + ROW_BYTES * n as u64)?;
    let (matrix, mut notes) = compressed.into_triplets(h5.path())?.assemble(n, declared, h5.path())?;
    // It would be another matrix with its rows taken for columns; a reduced one is symmetric to rounding, or judged for that.
    let is_ambiguous =
        role.takes_any() && role != MatrixRole::Reduced && !matches!(told, Told::Columns | Told::Symmetric);
    if is_ambiguous && first_breach(&matrix, Symmetry::Symmetric).is_some() {
        return Err(Error::Hdf5Orientation { path: h5.path().to_owned(), group: name });
    }
    if told == Told::Symmetric {
        notes.given = Given::Whole;
    }
    h5.keep(ENTRY_BYTES * matrix.nnz() as u64 + ROW_BYTES * n as u64)?;
    Ok(MatrixInput { matrix, notes, digits, path: path.to_owned(), layout: None, digest: digest(path)? })
}

/// A matrix as its group or table has it.
struct Found {
    compressed: Compressed,
    name: String,
    /// Digits that its values have room for.
    digits: u32,
    told: Told,
}

impl Found {
    /// The entries of a dataset of as many rows as columns that are not zero. Nothing says whether it is stored by rows or by columns.
    fn dense(dataset: &Dataset<'_>) -> Result<Self> {
        let shape = dataset.shape()?;
        let [n_rows, n_columns] = shape[..] else {
            return Err(dataset.wrong_shape(format!("extents {shape:?}"), "rows and columns".to_owned()));
        };
        let Reals { values, digits } = dataset.reals()?;
        let mut pointers = vec![0];
        let (mut indices, mut entries) = (Indices::default(), Vec::new());
        for row in values.chunks_exact(n_columns.max(1)) {
            for (value, col) in row.iter().zip(0..).filter(|(value, _)| **value != 0.0) {
                indices.push(col);
                entries.push(*value);
            }
            pointers.push(indices.len() as i64);
        }
        let name = dataset.name().to_owned();
        let sizes = [n_rows as u64, n_columns as u64];
        let names = [name.clone(), name.clone(), name.clone()];
        let compressed = Compressed::new(Major::Rows, sizes, pointers, indices, entries, names);
        Ok(Self { compressed, name, digits, told: Told::Nothing })
    }

    /// The matrix of a group, by the conventions of the programs that write one.
    fn in_groups(root: Group<'_>, group: Option<&str>, role: MatrixRole) -> Result<Self> {
        let start = root.group(group.unwrap_or("/"))?;
        let stated = if group.is_some() { Convention::of(&start, &start.members()?)? } else { None };
        let (group, convention) = match stated {
            Some(convention) => (start, convention),
            None => find_matrix(start, role)?,
        };
        let (compressed, digits) = convention.read(&group)?;
        Ok(Self { compressed, name: group.name().to_owned(), digits, told: convention.tells() })
    }

    /// What its entries stand for. A triangle with a diagonal is half of a symmetric matrix where the text that says so is not read: a skew
    /// one has no diagonal.
    fn declared(&self, role: MatrixRole) -> Declared {
        let may_be_half = role == MatrixRole::Conversion && self.told == Told::InText && self.compressed.has_diagonal();
        if may_be_half || self.told == Told::Symmetric { Declared::General } else { role.undeclared() }
    }
}
