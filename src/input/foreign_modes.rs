//! Modes as other programs write them: their shapes, and where the file has them their frequencies.
//!
//! A format is told by the content of the file. Files of numbers alone are those of [`super::mode_columns`].

use std::path::Path;

use super::digits::{Digits, digits_of};
use super::file_start::FileStart;
use super::hdf5_format;
use super::member::split_member;
use super::mode_format::{ModeSource, ReadModes};
use super::modes_file::{ModeColumns, mode_columns};
use super::{Allowance, ModeValues};
use crate::error::{Error, Result};
use crate::regular_file::{digest, unchanged};

/// The modes of another program.
#[derive(Clone, Debug)]
pub struct ForeignModes {
    /// For each mode a value for every row of the files, in the units of the file.
    pub columns: Vec<Vec<f64>>,
    /// The frequencies that the file has next to the shapes.
    pub values: Option<ModeValues>,
    /// What wrote the file, where it tells.
    pub program: Option<&'static str>,
    /// What the numbers of the shapes may be off by, relative to each.
    pub rounding: f64,
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

/// A format of modes with their frequencies.
struct ModeFormat {
    /// Whether a file is one of the format.
    is_one: fn(&ModeSource<'_>, &FileStart<'_>) -> bool,
    read: fn(&ModeSource<'_>) -> Result<ReadModes>,
}

/// The formats, those that know more than shapes first; what none of them takes is a matrix of numbers.
const FORMATS: [ModeFormat; 1] = [ModeFormat {
    is_one: |source, start| start.is_hdf5() && source.member.is_none(),
    read: hdf5_format::foreign_modes,
}];

/// Reads the modes of another program, for matrices of `n_rows` rows in their files.
///
/// # Errors
/// Those of [`super::mode_columns`]; [`Error::ValuesCount`] where the file has more or fewer frequencies than shapes.
pub fn foreign_modes(path: &Path, n_rows: usize, allowance: &Allowance) -> Result<ForeignModes> {
    let (file, member) = split_member(path);
    let source = ModeSource { file, member, n_rows, allowance };
    let start = FileStart::of(&source.file)?;
    let (read, digest) = match FORMATS.iter().find(|format| (format.is_one)(&source, &start)) {
        Some(format) => unchanged(&source.file, || Ok(((format.read)(&source)?, digest(&source.file)?)))?,
        None => {
            let ModeColumns { columns, digest } = mode_columns(path, n_rows, allowance)?;
            (ReadModes { columns, values: None, program: None }, digest)
        }
    };
    let ReadModes { columns, values, program } = read;
    let values = values.map(|(unit, numbers)| ModeValues::new(unit, numbers));
    let n_modes = columns.len();
    if let Some(values) = values.as_ref().filter(|values| values.numbers.len() != n_modes) {
        return Err(Error::ValuesCount { path: Some(source.file), found: values.numbers.len() as u64, n_modes });
    }
    Ok(ForeignModes { rounding: rounding_of(&columns), columns, values, program, digest })
}

/// Half a unit of the last digit that the numbers carry, relative to each.
fn rounding_of(columns: &[Vec<f64>]) -> f64 {
    let of_column = |column: &Vec<f64>| Digits { decimals: None, ..digits_of(column) }.half_a_unit()[0];
    columns.iter().map(of_column).fold(f64::INFINITY, f64::min)
}
