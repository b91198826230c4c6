//! NumPy archives: sparse matrices of `scipy.sparse.save_npz`, and dense ones by name of `numpy.savez`.

use std::path::Path;

use super::archive::Archive;
use super::assembled::Collector;
use super::compressed::{Compressed, Major, order};
use super::file_start::FileStart;
use super::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use super::indices::Indices;
use super::mode_format::{ModeSource, ReadModes};
use super::mode_matrix::Order;
use super::named::chosen;
use super::numpy_array::{Array, Reals};
use super::{MatrixInput, MatrixRole};
use crate::error::{Error, Result};
use crate::job::Layout;
use crate::regular_file::digest;
use crate::sparse::Triplets;

const FORMAT: &str = "NumPy archive";
const EXPECTED: &str =
    "a sparse matrix of scipy.sparse.save_npz (csr, csc, coo, bsr or dia), or square arrays of numpy.savez";

/// `scipy.sparse.save_npz` and `numpy.savez`.
pub(super) struct Npz;

impl Format for Npz {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        if begins(start) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl MatrixFormat for Npz {
    fn layout(&self) -> Layout {
        Layout::Npz
    }

    fn has_members(&self) -> bool {
        true
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let reading = Reading { source, archive: Archive::open(&source.file, FORMAT)? };
        let input = if reading.archive.has("format.npy") { reading.sparse() } else { reading.dense() };
        input.map(ReadMatrix::with_size)
    }
}

/// The modes in the columns of an array of an archive.
///
/// # Errors
/// As for matrices, and those of [`Array::modes`].
pub(super) fn modes(source: &ModeSource<'_>) -> Result<ReadModes> {
    let path = source.file.as_path();
    let archive = Archive::open(path, FORMAT)?;
    let names: Vec<&str> = archive.names().filter_map(|name| name.strip_suffix(".npy")).collect();
    if names.is_empty() {
        let holds = archive.names().map(str::to_owned).collect();
        return Err(Error::MatrixNone {
            path: path.to_owned(),
            format: FORMAT,
            holds,
            expected: "an array of numpy.savez",
        });
    }
    let name = format!("{}.npy", names[chosen(path, &names, source.member.as_deref(), MatrixRole::Further)?]);
    Array::open(path, FORMAT, &name, archive.member(&name)?)?.modes(source)
}

/// Whether a file is one of the format.
pub(super) fn begins(start: &FileStart<'_>) -> bool {
    start.packing.is_none() && start.head.starts_with(b"PK") && start.holds(b".npy")
}

struct Reading<'a> {
    source: &'a MatrixSource<'a>,
    archive: Archive<'a>,
}

impl Reading<'_> {
    fn path(&self) -> &Path {
        &self.source.file
    }

    /// The only matrix of an archive of SciPy.
    fn sparse(&self) -> Result<MatrixInput> {
        if let Some(name) = self.source.member.clone() {
            return Err(Error::MatrixName { path: self.source.file.clone(), name, holds: Vec::new() });
        }
        let format = self.array("format.npy")?.text()?;
        let [rows, columns] = self.shape()?;
        match format.as_str() {
            "csr" => self.compressed(Major::Rows, [rows, columns]),
            "csc" => self.compressed(Major::Columns, [rows, columns]),
            "coo" => self.coordinate([rows, columns]),
            "bsr" => self.blocks([rows, columns]),
            "dia" => self.diagonals([rows, columns]),
            _ => Err(Error::MatrixUnread {
                path: self.source.file.clone(),
                format: FORMAT,
                place: "format.npy".to_owned(),
                found: format!("a matrix in the form {format:?}"),
                expected: EXPECTED,
            }),
        }
    }

    /// One of the square arrays.
    fn dense(&self) -> Result<MatrixInput> {
        let names: Vec<&str> = self.archive.names().filter_map(|name| name.strip_suffix(".npy")).collect();
        if names.is_empty() {
            let (path, holds) = (self.source.file.clone(), self.archive.names().map(str::to_owned).collect());
            return Err(Error::MatrixNone { path, format: FORMAT, holds, expected: EXPECTED });
        }
        let MatrixSource { member, role, .. } = self.source;
        let name = format!("{}.npy", names[chosen(self.path(), &names, member.as_deref(), *role)?]);
        let declared = role.undeclared();
        let (entries, n, stored) = self.array(&name)?.dense(self.source, declared)?;
        let mut input = entries.into_matrix(self.source, (n, declared), digest(self.path())?)?;
        input.digits = input.digits.at_most(stored);
        Ok(input)
    }

    fn array<'s>(&'s self, name: &'s str) -> Result<Array<'s, impl std::io::Read + 's>> {
        Array::open(self.path(), FORMAT, name, self.archive.member(name)?)
    }

    fn shape(&self) -> Result<[u64; 2]> {
        let sizes = self.array("shape.npy")?.wholes()?;
        let counts: Vec<u64> = sizes.iter().filter_map(|size| u64::try_from(*size).ok()).collect();
        counts.try_into().map_err(|_| self.wrong("shape.npy", format!("{sizes:?}"), "two numbers, rows and columns"))
    }

    fn wrong(&self, place: &str, found: String, expected: &str) -> Error {
        let (path, place, expected) = (self.source.file.clone(), place.to_owned(), expected.to_owned());
        Error::MatrixFormat { path, format: FORMAT, place, found, expected: expected.into() }
    }

    fn compressed(&self, major: Major, shape: [u64; 2]) -> Result<MatrixInput> {
        let pointers = self.array("indptr.npy")?.wholes()?;
        let indices = self.array("indices.npy")?.indices()?;
        let Reals { values, digits } = self.array("data.npy")?.reals()?;
        let names = ["indptr.npy", "indices.npy", "data.npy"].map(str::to_owned);
        let compressed = Compressed::new(major, shape, pointers, indices, values, names).without_reserve();
        compressed.into_matrix(self.source, "the matrix", (self.source.role.undeclared(), digits))
    }

    fn coordinate(&self, shape: [u64; 2]) -> Result<MatrixInput> {
        let n = order(self.path(), "the matrix", shape)?;
        let [rows, columns] = if self.archive.has("coords.npy") {
            let coords = self.array("coords.npy")?;
            let order = coords.header.order;
            let mut rows = coords.indices()?;
            match order {
                Order::ByRows => {
                    let columns = rows.split_off(rows.len() / 2);
                    [rows, columns]
                }
                Order::ByColumns => rows.into_alternating(),
            }
        } else {
            [self.array("row.npy")?.indices()?, self.array("col.npy")?.indices()?]
        };
        let Reals { values, digits } = self.array("data.npy")?.reals()?;
        if rows.len() != values.len() || columns.len() != values.len() {
            let found = format!("{} values for {} rows and {} columns", values.len(), rows.len(), columns.len());
            return Err(self.wrong("data.npy", found, "as many of each"));
        }
        let (rows, cols) = (self.below(n, "row.npy", rows)?, self.below(n, "col.npy", columns)?);
        let is_bad = values.iter().position(|value| !value.is_finite());
        if let Some(at) = is_bad {
            return Err(self.not_finite([rows[at], cols[at]], values[at]));
        }
        let mut entries = self.collector();
        entries.append(Triplets { rows, cols, values })?;
        self.finished(entries, n, digits)
    }

    /// Blocks of rows and columns, compressed by rows.
    fn blocks(&self, shape: [u64; 2]) -> Result<MatrixInput> {
        let n = order(self.path(), "the matrix", shape)?;
        let pointers = self.array("indptr.npy")?.wholes()?;
        let indices = self.array("indices.npy")?.indices()?;
        let data = self.array("data.npy")?;
        let shape = data.header.shape.clone();
        let Reals { values, digits } = data.reals()?;
        let [high, wide] = match shape[..] {
            [n_blocks, high, wide] if high > 0 && wide > 0 && n_blocks == indices.len() as u64 => [high, wide],
            _ => return Err(self.wrong("data.npy", format!("the shape {shape:?}"), "blocks, one for each index")),
        };
        let order = u64::from(n);
        if order % high != 0 || order % wide != 0 {
            let found = format!("blocks of {high} rows and {wide} columns");
            return Err(self.wrong("data.npy", found, "divisors of the order of the matrix"));
        }
        let n_blocks = [order / high, order / wide];
        // The blocks as entries of a matrix of blocks: its pointers and indices are checked there.
        let positions = (0..indices.len()).map(|at| at as f64).collect();
        let names = ["indptr.npy", "indices.npy", "data.npy"].map(str::to_owned);
        let of_blocks = Compressed::new(Major::Rows, n_blocks, pointers, indices, positions, names).without_reserve();
        of_blocks.check_parts(self.path(), n_blocks[0] as usize)?;
        let mut entries = self.collector();
        let [high, wide] = [high as usize, wide as usize];
        for (block_row, block_col, position) in of_blocks.into_triplets(self.path())?.iter() {
            let block = &values[position as usize * high * wide..][..high * wide];
            for (at, value) in block.iter().enumerate().filter(|(_, value)| **value != 0.0) {
                let (row, col) = (block_row as usize * high + at / wide, block_col as usize * wide + at % wide);
                self.push(&mut entries, [row as u32, col as u32], *value)?;
            }
        }
        drop(values);
        self.finished(entries, n, digits)
    }

    /// Diagonals: the value in column j of row d belongs to column j of the matrix and to the row j − offset.
    fn diagonals(&self, shape: [u64; 2]) -> Result<MatrixInput> {
        let n = order(self.path(), "the matrix", shape)?;
        let offsets = self.array("offsets.npy")?.wholes()?;
        let data = self.array("data.npy")?;
        let shape = data.header.shape.clone();
        let Reals { values, digits } = data.reals()?;
        let length = match shape[..] {
            [n_diagonals, length] if n_diagonals == offsets.len() as u64 => length,
            _ => return Err(self.wrong("data.npy", format!("the shape {shape:?}"), "a row for each offset")),
        };
        let mut entries = self.collector();
        for (diagonal, offset) in offsets.iter().enumerate() {
            for col in 0..length.min(n.into()) {
                let row = (col as i64).checked_sub(*offset).and_then(|row| u32::try_from(row).ok());
                let value = values[diagonal * length as usize + col as usize];
                if let Some(row) = row.filter(|row| *row < n && value != 0.0) {
                    self.push(&mut entries, [row, col as u32], value)?;
                }
            }
        }
        drop(values);
        self.finished(entries, n, digits)
    }

    fn collector(&self) -> Collector<'_> {
        Collector::new(self.source, self.source.role.undeclared())
    }

    fn push(&self, entries: &mut Collector<'_>, [row, col]: [u32; 2], value: f64) -> Result<()> {
        if value.is_finite() {
            return entries.push(row, col, value);
        }
        Err(self.not_finite([row, col], value))
    }

    fn not_finite(&self, [row, col]: [u32; 2], value: f64) -> Error {
        let (path, matrix) = (self.source.file.clone(), "data.npy".to_owned());
        let (row, col) = (u64::from(row) + 1, u64::from(col) + 1);
        Error::MatrixNotFinite { path, matrix, row, col, value }
    }

    /// The indices of an array of this name.
    fn below(&self, n: u32, array: &str, indices: Indices) -> Result<Vec<u32>> {
        indices.below(n.into()).map_err(|(position, found)| {
            let (path, array, last) = (self.source.file.clone(), array.to_owned(), i64::from(n) - 1);
            Error::MatrixIndex { path, array, position, found, first: 0, last }
        })
    }

    fn finished(&self, entries: Collector<'_>, n: u32, stored: u32) -> Result<MatrixInput> {
        let declared = self.source.role.undeclared();
        let mut input = entries.into_matrix(self.source, (n, declared), digest(self.path())?)?;
        input.digits = input.digits.at_most(stored);
        Ok(input)
    }
}
