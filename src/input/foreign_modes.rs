//! Modes as other programs write them: their shapes, and where the file has them their frequencies.
//!
//! A format is told by the content of the file. Files of numbers alone are those of [`super::mode_columns`].

use std::path::Path;

use super::digits::{Digits, digits_of_columns};
use super::file_start::FileStart;
use super::frd_modes;
use super::hdf5_format;
use super::matlab5;
use super::member::split_member;
use super::mode_format::{ModeSource, ReadModes};
use super::mode_rounding::ModeRounding;
use super::mode_rows::ModeRows;
use super::modes_file::{ModeColumns, mode_columns};
use super::npy_header::is_array;
use super::npy_series;
use super::npz;
use super::op4;
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
    /// What the numbers of the shapes may be off by.
    pub rounding: ModeRounding,
    /// Whether modes may be in the rows of what was read as columns.
    pub orientation: Orientation,
    /// What reading left out, one sentence each.
    pub notes: Vec<String>,
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

/// Whether the extents of a file tell which of its numbers are one mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// They do, or the format does.
    Known,
    /// A dataset of as many rows as columns: modes may be its columns or its rows.
    Square,
}

/// Which axes the values at a node are along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Along {
    /// The axes of the rows of K and M in their files.
    Rows,
    /// The axes of the model.
    Model,
}

/// A format of modes with their frequencies.
struct ModeFormat {
    /// Whether a file is one of the format.
    is_one: fn(&ModeSource<'_>, &FileStart<'_>) -> bool,
    read: fn(&ModeSource<'_>) -> Result<ReadModes>,
    along: Along,
}

/// The formats, those that know more than shapes first; what none of them takes is a matrix of numbers.
const FORMATS: [ModeFormat; 6] = [
    ModeFormat {
        is_one: |source, start| start.is_hdf5() && source.member.is_none(),
        read: hdf5_format::foreign_modes,
        along: Along::Rows,
    },
    ModeFormat { is_one: |_, start| op4::begins(start), read: op4::modes, along: Along::Rows },
    ModeFormat { is_one: |_, start| matlab5::begins(start), read: matlab5::modes, along: Along::Rows },
    ModeFormat { is_one: |_, start| frd_modes::begins(start), read: frd_modes::modes, along: Along::Model },
    ModeFormat { is_one: |_, start| npz::begins(start), read: npz::modes, along: Along::Rows },
    ModeFormat {
        is_one: |source, start| source.member.is_some() && is_array(&start.head),
        read: npy_series::modes,
        along: Along::Rows,
    },
];

/// Reads the modes of another program, for matrices of these rows.
///
/// # Errors
/// The errors of [`super::mode_columns`]; [`Error::ValuesCount`] where the file has more or fewer frequencies than shapes;
/// [`Error::ModesNodes`] where a row has no value in a file of nodes and directions.
pub fn foreign_modes(path: &Path, rows: &ModeRows, allowance: &Allowance) -> Result<ForeignModes> {
    let (file, member) = split_member(path);
    let source = ModeSource { file, member, rows, allowance };
    let start = FileStart::of(&source.file)?;
    let format = FORMATS.iter().find(|format| (format.is_one)(&source, &start));
    let (read, digest) = match format {
        Some(format) => unchanged(&source.file, || Ok(((format.read)(&source)?, digest(&source.file)?)))?,
        None => {
            let ModeColumns { columns, digest } = mode_columns(path, rows.n, allowance)?;
            (ReadModes::of_columns(columns), digest)
        }
    };
    let ReadModes { mut columns, values, program, digits, notes } = read;
    let rounding = ModeRounding::of(digits.map_or_else(|| digits_of_columns(&columns), Digits::relative));
    let is_along_rows = format.is_none_or(|format| format.along == Along::Rows);
    if let Some(turning) = rows.turning.as_ref().filter(|_| is_along_rows) {
        columns.iter_mut().for_each(|column| turning.turn(column));
    }
    let values = values.map(|(unit, numbers)| ModeValues::new(unit, numbers));
    let n_modes = columns.len();
    if let Some(values) = values.as_ref().filter(|values| values.numbers.len() != n_modes) {
        return Err(Error::ValuesCount { path: Some(source.file), found: values.numbers.len() as u64, n_modes });
    }
    let is_square = start.is_hdf5() && program.is_none() && n_modes == rows.n;
    let orientation = if is_square { Orientation::Square } else { Orientation::Known };
    Ok(ForeignModes { rounding, columns, values, program, orientation, notes, digest })
}
