//! Modes in arrays of NumPy.

use std::io::Read;
use std::path::Path;

use super::allowance::Claim;
use super::mode_matrix::{Meaning, NUMBER, columns_of, refuse_not_finite};
use super::npy_header::{Failure, Header};
use super::numpy_array::stored_as;
use super::raw_numbers;
use crate::error::{Error, Result};
use crate::regular_file;

const EXPECTED: &str = "a NumPy array of real numbers, of one or two dimensions, as numpy.save writes it";

/// The columns of an array of two dimensions; of one dimension, the only one.
///
/// # Errors
/// [`Error::ModesFormat`] for what is no such array, [`Error::ModesRows`] and [`Error::ModesColumns`] for another size,
/// [`Error::MemoryRead`]; those of reading the file.
pub(super) fn columns(path: &Path, (n_rows, meaning): (usize, Meaning), claim: &Claim<'_>) -> Result<Vec<Vec<f64>>> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    let wrong = |found: String| Error::ModesFormat { path: path.to_owned(), line: None, found, expected: EXPECTED };
    let mut file = regular_file::open(path)?;
    let n_bytes = file.metadata().map_err(failed)?.len();
    let header = Header::read(&mut file).map_err(|failure| match failure {
        Failure::Found(found) => wrong(found),
        Failure::Read(source) => failed(source),
    })?;
    let Some(stored) = stored_as(&header.descr) else {
        return Err(wrong(format!("numbers of type '{}'", header.descr)));
    };
    let (rows, n_columns) = match header.shape[..] {
        [rows] => (rows, 1),
        [rows, columns] => (rows, columns),
        _ => return Err(wrong(format!("the shape {:?}", header.shape))),
    };
    if rows != n_rows as u64 {
        return Err(Error::ModesRows { path: path.to_owned(), found: rows, n: n_rows });
    }
    let n_columns = meaning.checked_count(path, n_columns, n_rows)?;
    let n_numbers = (n_rows as u64).checked_mul(n_columns as u64);
    let promised = n_numbers.and_then(|n| n.checked_mul(stored.0.size() as u64));
    let there = n_bytes.saturating_sub(header.length);
    if promised != Some(there) {
        return Err(wrong(format!("{there} bytes behind the header of {n_rows} × {n_columns} numbers")));
    }
    // The numbers as they are read and in columns.
    let n_numbers = n_numbers.unwrap_or(u64::MAX);
    claim.add(n_numbers.saturating_mul(2 * NUMBER))?;
    let values = raw_numbers::reals(&mut file.take(there), stored, n_numbers).map_err(|failure| match failure {
        raw_numbers::Failure::Cut(_) => Error::Changed { path: path.to_owned() },
        raw_numbers::Failure::Value(at) => wrong(format!("number {}, which no double equals", at + 1)),
        raw_numbers::Failure::Read(source) => failed(source),
        raw_numbers::Failure::Refused(error) => *error,
    })?;
    let columns = columns_of(&values, [n_rows, n_columns], header.order);
    refuse_not_finite(path, &columns)?;
    Ok(columns)
}
