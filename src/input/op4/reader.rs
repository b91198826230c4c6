//! Reads the matrix that is wanted of a file, or modes in its columns.

use std::path::Path;

use super::head::{FORMAT, Form, Head};
use super::matrices::Matrices;
use super::{binary, text};
use crate::error::{Error, Result};
use crate::input::MatrixRole;
use crate::input::assembled::{Collector, complete};
use crate::input::file_start::FileStart;
use crate::input::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use crate::input::mode_format::{ModeSource, ReadModes};
use crate::input::mode_matrix::NUMBER;
use crate::input::named::chosen;
use crate::job::Layout;
use crate::sparse::Declared;

/// OUTPUT4 of Nastran.
pub(in crate::input) struct Op4;

impl Format for Op4 {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        if begins(start) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl MatrixFormat for Op4 {
    fn layout(&self) -> Layout {
        Layout::Op4
    }

    fn has_members(&self) -> bool {
        true
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let start = FileStart::of(&source.file)?;
        if binary::begins(&start.head) { read(source, binary::File::open) } else { read(source, text::File::open) }
    }
}

/// The matrix of a file that is wanted: its head, and the file behind that.
fn found<'a, F: Matrices<'a>>(
    path: &'a Path,
    open: fn(&'a Path) -> Result<F>,
    (member, role): (Option<&str>, MatrixRole),
) -> Result<(F, Head)> {
    let mut names = Vec::new();
    let mut file = open(path)?;
    while let Some(head) = file.head()? {
        file.skip(&head)?;
        names.push(head.name);
    }
    let listed: Vec<&str> = names.iter().map(String::as_str).collect();
    if listed.is_empty() {
        let expected = "matrices as Nastran writes them by OUTPUT4";
        return Err(Error::MatrixNone { path: path.to_owned(), format: FORMAT, holds: Vec::new(), expected });
    }
    let position = chosen(path, &listed, member, role)?;
    let mut file = open(path)?;
    for _ in 0..position {
        if let Some(head) = file.head()? {
            file.skip(&head)?;
        }
    }
    match file.head()? {
        Some(head) => Ok((file, head)),
        None => Err(Error::Changed { path: path.to_owned() }),
    }
}

fn read<'a, F: Matrices<'a>>(source: &'a MatrixSource<'a>, open: fn(&'a Path) -> Result<F>) -> Result<ReadMatrix> {
    let path = source.file.as_path();
    let (mut file, head) = found(path, open, (source.member.as_deref(), source.role))?;
    let form = head.form(path)?;
    let n = head.order(path)?;
    let declared = if form == Form::Symmetric { Declared::General } else { source.role.undeclared() };
    let mut entries = Collector::new(source, declared);
    file.entries(&head, &mut |row, col, value| {
        let col = if form == Form::Diagonal { row } else { col };
        if value == 0.0 {
            return Ok(());
        }
        if !value.is_finite() {
            return Err(not_finite(path, &head, (row, col, value)));
        }
        entries.push(row, col, value)
    })?;
    let mut input = entries.into_matrix(source, (n, declared), file.digest()?)?;
    if form == Form::Symmetric && source.triangle.is_none() {
        complete(&mut input)?;
    }
    input.digits = input.digits.at_most(head.digits());
    Ok(ReadMatrix::with_size(input))
}

/// The modes in the columns of a matrix, of a value for each row.
///
/// # Errors
/// As for matrices; [`Error::ModesRows`] and [`Error::ModesColumns`] for another size.
pub(in crate::input) fn modes(source: &ModeSource<'_>) -> Result<ReadModes> {
    let start = FileStart::of(&source.file)?;
    let columns = if binary::begins(&start.head) {
        columns(source, binary::File::open)
    } else {
        columns(source, text::File::open)
    };
    columns.map(ReadModes::of_columns)
}

/// Whether a file is one of the format.
pub(in crate::input) fn begins(start: &FileStart<'_>) -> bool {
    text::begins(&start.head) || binary::begins(&start.head)
}

fn columns<'a, F: Matrices<'a>>(source: &'a ModeSource<'a>, open: fn(&'a Path) -> Result<F>) -> Result<Vec<Vec<f64>>> {
    let (path, n_rows) = (source.file.as_path(), source.rows.n);
    let (mut file, head) = found(path, open, (source.member.as_deref(), MatrixRole::Further))?;
    head.form(path)?;
    if head.n_rows() != n_rows as u64 {
        return Err(Error::ModesRows { path: path.to_owned(), found: head.n_rows(), n: n_rows });
    }
    let n_columns = source.meaning.checked_count(path, head.columns.unsigned_abs(), n_rows)?;
    let claim = source.allowance.claim(path);
    // A column takes its memory when it gets its first value: a head may promise any number of them.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    file.entries(&head, &mut |row, col, value| {
        if !value.is_finite() {
            return Err(not_finite(path, &head, (row, col, value)));
        }
        let column = col as usize;
        if column >= columns.len() {
            columns.resize_with(column + 1, Vec::new);
        }
        if columns[column].is_empty() {
            claim.add(NUMBER * n_rows as u64)?;
            columns[column].resize(n_rows, 0.0);
        }
        columns[column][row as usize] = value;
        Ok(())
    })?;
    source.meaning.completed(columns, [n_rows, n_columns])
}

fn not_finite(path: &Path, head: &Head, (row, col, value): (u32, u32, f64)) -> Error {
    let (path, matrix) = (path.to_owned(), head.name.clone());
    let (row, col) = (u64::from(row) + 1, u64::from(col) + 1);
    Error::MatrixNotFinite { path, matrix, row, col, value }
}
