//! Reads the matrix that is wanted of a file.

use super::element::{Array, Class, Content};
use super::file::endian;
use super::picked::{Candidate, picked};
use crate::error::{Error, Result};
use crate::input::assembled::Collector;
use crate::input::compressed::{Compressed, Major, order};
use crate::input::file_start::FileStart;
use crate::input::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use crate::input::named::role_stated_by;
use crate::job::Layout;

/// MATLAB level 5, plain or compressed.
pub(in crate::input) struct Matlab5;

/// Whether a file is one of the format.
pub(in crate::input) fn begins(start: &FileStart<'_>) -> bool {
    endian(&start.head).is_some()
}

impl Format for Matlab5 {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        if begins(start) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl MatrixFormat for Matlab5 {
    fn layout(&self) -> Layout {
        Layout::Matlab5
    }

    fn has_members(&self) -> bool {
        true
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let candidate = |array: &Array| match array.is_matrix() {
            false => Candidate::None,
            true if array.is_single() && !is_meant(source, &array.name) => Candidate::LastResort,
            true => Candidate::Matrix,
        };
        let wanted = (source.member.as_deref(), source.role);
        picked(&source.file, wanted, candidate, |array, content| matrix(source, array, content))
    }
}

/// Whether the name of a single number is the one that is wanted, or says that it is a matrix of a model.
fn is_meant(source: &MatrixSource<'_>, name: &str) -> bool {
    let is_wanted = source.member.as_deref().is_some_and(|wanted| wanted.eq_ignore_ascii_case(name));
    is_wanted || role_stated_by(name).is_some()
}

/// The matrix of an array, whose content follows.
fn matrix(source: &MatrixSource<'_>, array: &Array, content: &mut Content<'_>) -> Result<ReadMatrix> {
    let path = source.file.as_path();
    let declared = source.role.undeclared();
    if array.class == Class::Sparse {
        let (compressed, digits) = compressed(array, content)?;
        return compressed.into_matrix(source, &array.name, (declared, digits)).map(ReadMatrix::with_size);
    }
    let n = order(path, &array.name, array.shape)?;
    let mut entries = Collector::new(source, declared);
    let digits = content.each_real(array, u64::from(n) * u64::from(n), |position, value| {
        let (row, col) = ((position % u64::from(n)) as u32, (position / u64::from(n)) as u32);
        if value.is_finite() {
            return if value == 0.0 { Ok(()) } else { entries.push(row, col, value) };
        }
        let (path, matrix) = (path.to_owned(), array.name.clone());
        let (row, col) = (u64::from(row) + 1, u64::from(col) + 1);
        Err(Error::MatrixNotFinite { path, matrix, row, col, value })
    })?;
    let digest = crate::regular_file::digest(path)?;
    let mut input = entries.into_matrix(source, (n, declared), digest)?;
    input.digits = input.digits.at_most(digits.min(array.class.digits()));
    Ok(ReadMatrix::with_size(input))
}

/// A sparse array, whose content follows, and the digits that its numbers have room for.
pub(super) fn compressed(array: &Array, content: &mut Content<'_>) -> Result<(Compressed, u32)> {
    let mut indices = content.indices(array, "rows")?;
    let pointers = content.wholes(array, "column pointers")?;
    let (mut values, digits) = content.reals(array, "values")?;
    // What is reserved behind the last entry has no meaning.
    let n_entries = pointers.last().and_then(|last| usize::try_from(*last).ok()).unwrap_or(0);
    indices.truncate(n_entries);
    values.truncate(n_entries);
    let names = ["column pointers", "rows", "values"].map(|part| format!("{} ({part})", array.name));
    Ok((Compressed::new(Major::Columns, array.shape, pointers, indices, values, names), digits))
}
