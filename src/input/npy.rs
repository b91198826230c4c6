//! Modes in arrays of NumPy: real numbers in double precision.

use std::io::Read;
use std::path::Path;

use super::allowance::Claim;
use super::mode_matrix::{NUMBER, checked_count, columns_of, refuse_not_finite};
use super::npy_header::{Failure, Header};
use crate::error::{Error, Result};
use crate::regular_file;

const EXPECTED: &str = "a NumPy array of float64, little-endian, of one or two dimensions, as numpy.save writes it";

/// The columns of an array of two dimensions; of one dimension, the only one.
///
/// # Errors
/// [`Error::ModesFormat`] for what is no such array, [`Error::ModesRows`] and [`Error::ModesColumns`] for another size,
/// [`Error::MemoryRead`]; those of reading the file.
pub(super) fn columns(path: &Path, n_rows: usize, claim: &Claim<'_>) -> Result<Vec<Vec<f64>>> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    let wrong = |found: String| Error::ModesFormat { path: path.to_owned(), line: None, found, expected: EXPECTED };
    let mut file = regular_file::open(path)?;
    let n_bytes = file.metadata().map_err(failed)?.len();
    let header = Header::read(&mut file).map_err(|failure| match failure {
        Failure::Found(found) => wrong(found),
        Failure::Read(source) => failed(source),
    })?;
    if header.descr != "<f8" {
        return Err(wrong(format!("numbers of type '{}'", header.descr)));
    }
    let (rows, n_columns) = match header.shape[..] {
        [rows] => (rows, 1),
        [rows, columns] => (rows, columns),
        _ => return Err(wrong(format!("the shape {:?}", header.shape))),
    };
    if rows != n_rows as u64 {
        return Err(Error::ModesRows { path: path.to_owned(), found: rows, n: n_rows });
    }
    let n_columns = checked_count(path, n_columns, n_rows)?;
    let promised = (n_rows as u64).checked_mul(n_columns as u64).and_then(|n| n.checked_mul(NUMBER));
    let there = n_bytes.saturating_sub(header.length);
    if promised != Some(there) {
        return Err(wrong(format!("{there} bytes behind the header of {n_rows} × {n_columns} numbers")));
    }
    // The numbers as they are read and in columns.
    claim.add(there.saturating_mul(2))?;
    let mut bytes = Vec::new();
    file.take(there).read_to_end(&mut bytes).map_err(failed)?;
    let (numbers, _) = bytes.as_chunks::<8>();
    let values: Vec<f64> = numbers.iter().map(|number| f64::from_le_bytes(*number)).collect();
    if values.len() as u64 * NUMBER != there {
        return Err(Error::Changed { path: path.to_owned() });
    }
    let columns = columns_of(&values, [n_rows, n_columns], header.order);
    refuse_not_finite(path, &columns)?;
    Ok(columns)
}
