//! Reads the matrix that is wanted of a file.

use super::head::{FORMAT, Form};
use super::matrices::Matrices;
use super::{binary, text};
use crate::error::{Error, Result};
use crate::input::assembled::Collector;
use crate::input::file_start::FileStart;
use crate::input::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use crate::input::named::chosen;
use crate::job::Layout;
use crate::sparse::Declared;

/// OUTPUT4 of Nastran.
pub(in crate::input) struct Op4;

impl Format for Op4 {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        let is_op4 = text::begins(&start.head) || binary::begins(&start.head);
        if is_op4 { Sureness::Certain } else { Sureness::Unlikely }
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

fn read<'a, F: Matrices<'a>>(
    source: &'a MatrixSource<'a>,
    open: fn(&'a std::path::Path) -> Result<F>,
) -> Result<ReadMatrix> {
    let path = source.file.as_path();
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
    let position = chosen(path, &listed, source.member.as_deref(), source.role)?;
    let mut file = open(path)?;
    for _ in 0..position {
        if let Some(head) = file.head()? {
            file.skip(&head)?;
        }
    }
    let Some(head) = file.head()? else { return Err(Error::Changed { path: path.to_owned() }) };
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
            let (path, matrix) = (path.to_owned(), head.name.clone());
            let (row, col) = (u64::from(row) + 1, u64::from(col) + 1);
            return Err(Error::MatrixNotFinite { path, matrix, row, col, value });
        }
        entries.push(row, col, value)
    })?;
    let mut input = entries.into_matrix(source, (n, declared), file.digest()?)?;
    input.digits = input.digits.at_most(head.digits());
    Ok(ReadMatrix::with_size(input))
}
