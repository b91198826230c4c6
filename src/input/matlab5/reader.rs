//! Reads the matrix that is wanted of a file.

use super::element::{Array, Class, Content, FORMAT};
use super::file::{Step, endian, walk};
use crate::error::{Error, Result};
use crate::input::assembled::Collector;
use crate::input::compressed::{Compressed, Major, order};
use crate::input::file_start::FileStart;
use crate::input::format::{Format, MatrixFormat, MatrixSource, ReadMatrix, Sureness};
use crate::input::named::{chosen, role_stated_by};
use crate::job::Layout;

const EXPECTED: &str = "real matrices, sparse or of numbers, at the top level of the file or in a struct";

/// MATLAB level 5, plain or compressed.
pub(in crate::input) struct Matlab5;

impl Format for Matlab5 {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        if endian(&start.head).is_some() { Sureness::Certain } else { Sureness::Unlikely }
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
        let path = source.file.as_path();
        let (mut names, mut singles, mut others, mut position) = (Vec::new(), Vec::new(), Vec::new(), 0);
        walk(path, |array, _| {
            match array.unread() {
                None if array.is_matrix() && array.is_single() && !is_meant(source, &array.name) => {
                    singles.push((position, array.name.clone()));
                }
                None if array.is_matrix() => names.push((position, array.name.clone())),
                Some(why) if source.member.as_deref() == Some(&array.name) => return Err(unread(source, array, why)),
                _ => others.push(format!("{} ({})", array.name, array.class.name())),
            }
            position += 1;
            Ok(Step::Skip)
        })?;
        // A model of one row has no larger matrix.
        let names = if names.is_empty() { singles } else { names };
        if names.is_empty() {
            return Err(Error::MatrixNone { path: path.to_owned(), format: FORMAT, holds: others, expected: EXPECTED });
        }
        let listed: Vec<&str> = names.iter().map(|(_, name)| name.as_str()).collect();
        let wanted = names[chosen(path, &listed, source.member.as_deref(), source.role)?].0;
        let (mut position, mut found) = (0, None);
        walk(path, |array, content| {
            position += 1;
            if position - 1 < wanted {
                return Ok(Step::Skip);
            }
            found = Some(matrix(source, array, content)?);
            Ok(Step::Stop)
        })?;
        found.ok_or_else(|| Error::Changed { path: path.to_owned() })
    }
}

/// Whether the name of a single number is the one that is wanted, or says that it is a matrix of a model.
fn is_meant(source: &MatrixSource<'_>, name: &str) -> bool {
    let is_wanted = source.member.as_deref().is_some_and(|wanted| wanted.eq_ignore_ascii_case(name));
    is_wanted || role_stated_by(name).is_some()
}

fn unread(source: &MatrixSource<'_>, array: &Array, found: &str) -> Error {
    let (path, place, found) = (source.file.clone(), array.name.clone(), found.to_owned());
    Error::MatrixUnread { path, format: FORMAT, place, found, expected: EXPECTED }
}

/// The matrix of an array, whose content follows.
fn matrix(source: &MatrixSource<'_>, array: &Array, content: &mut Content<'_>) -> Result<ReadMatrix> {
    let path = source.file.as_path();
    let declared = source.role.undeclared();
    if array.class == Class::Sparse {
        let mut indices = content.indices(array, "rows")?;
        let pointers = content.wholes(array, "column pointers")?;
        let (mut values, digits) = content.reals(array, "values")?;
        // What is reserved behind the last entry has no meaning.
        let n_entries = pointers.last().and_then(|last| usize::try_from(*last).ok()).unwrap_or(0);
        indices.truncate(n_entries);
        values.truncate(n_entries);
        let names = ["column pointers", "rows", "values"].map(|part| format!("{} ({part})", array.name));
        let compressed = Compressed::new(Major::Columns, array.shape, pointers, indices, values, names);
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
