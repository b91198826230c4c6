//! Modes in the columns of a matrix of a file.

use super::element::{Array, Class, Content};
use super::picked::{Candidate, picked};
use super::reader::compressed;
use crate::error::{Error, Result};
use crate::input::MatrixRole;
use crate::input::mode_format::{ModeSource, ReadModes};
use crate::input::mode_matrix::{NUMBER, Order, columns_of, refuse_not_finite};

/// The modes in the columns of the matrix that is named, or of the only one.
///
/// # Errors
/// As for matrices; [`Error::ModesRows`] and [`Error::ModesColumns`] for another size.
pub(in crate::input) fn modes(source: &ModeSource<'_>) -> Result<ReadModes> {
    let path = source.file.as_path();
    let candidate = |array: &Array| match array.is_table() {
        false => Candidate::None,
        true if array.is_single() && source.member.is_none() => Candidate::LastResort,
        true => Candidate::Matrix,
    };
    let wanted = (source.member.as_deref(), MatrixRole::Further);
    let columns = picked(path, wanted, candidate, |array, content| columns(source, array, content))?;
    refuse_not_finite(path, &columns)?;
    Ok(ReadModes::of_columns(columns))
}

/// The columns of an array, whose content follows.
fn columns(source: &ModeSource<'_>, array: &Array, content: &mut Content<'_>) -> Result<Vec<Vec<f64>>> {
    let (path, n_rows, [rows, n_columns]) = (source.file.as_path(), source.rows.n, array.shape);
    if rows != n_rows as u64 {
        return Err(Error::ModesRows { path: path.to_owned(), found: rows, n: n_rows });
    }
    let n_columns = source.meaning.checked_count(path, n_columns, n_rows)?;
    let claim = source.allowance.claim(path);
    if array.class == Class::Sparse {
        let (compressed, _) = compressed(array, content)?;
        compressed.check_parts(path, n_columns)?;
        let entries = compressed.into_triplets(path)?;
        claim.add(NUMBER * rows * n_columns as u64)?;
        let mut columns = vec![vec![0.0; n_rows]; n_columns];
        entries.iter().for_each(|(row, column, value)| columns[column as usize][row as usize] += value);
        return Ok(columns);
    }
    // The numbers as they are read and in columns, once they are there: a head may promise any number of them.
    let mut values = Vec::new();
    content.each_real(array, rows * n_columns as u64, |position, value| {
        if position.is_multiple_of(rows) {
            claim.add(2 * NUMBER * rows)?;
        }
        values.push(value);
        Ok(())
    })?;
    Ok(columns_of(&values, [n_rows, n_columns], Order::ByColumns))
}
