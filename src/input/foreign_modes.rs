//! Modes as other programs write them: their shapes, and where the file has them their frequencies.
//!
//! A format is told by the content of the file. Files of numbers alone are those of [`super::mode_columns`].

use std::path::Path;

use super::digits::{Digits, digits_of_modes};
use super::file_start::FileStart;
use super::member::split_member;
use super::mode_format::{ModeSource, ReadModes};
use super::mode_formats::{Along, FORMATS};
use super::mode_matrix::Meaning;
use super::mode_rounding::ModeRounding;
use super::mode_rows::ModeRows;
use super::modes_file::{ModeColumns, mode_columns};
use super::{Allowance, ModeValues};
use crate::error::{Error, Result};
use crate::regular_file::{digest, unchanged};
use crate::sparse::Turning;

/// The modes of another program.
#[derive(Clone, Debug)]
pub struct ForeignModes {
    /// For each mode a value for every row of the files, in the units of the file.
    pub columns: Vec<Vec<f64>>,
    /// Rows of them that are along axes of their own, where any are.
    pub turning: Option<Turning>,
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

impl ForeignModes {
    /// The modes with all rows along the axes of the model.
    #[must_use]
    pub fn along_model(mut self) -> Self {
        if let Some(turning) = self.turning.take() {
            self.columns.iter_mut().for_each(|column| turning.turn(column));
        }
        self
    }
}

/// Whether the extents of a file tell which of its numbers are one mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// They do, or the format does.
    Known,
    /// A dataset of as many rows as columns: modes may be its columns or its rows.
    Square,
}

/// Reads the modes of another program, for matrices of these rows.
///
/// # Errors
/// The errors of [`super::mode_columns`]; [`Error::ValuesCount`] where the file has more or fewer frequencies than shapes;
/// [`Error::ModesNodes`] where a row has no value in a file of nodes and directions.
pub fn foreign_modes(path: &Path, rows: &ModeRows, allowance: &Allowance) -> Result<ForeignModes> {
    let (file, member) = split_member(path);
    let source = ModeSource { file, member, rows, meaning: Meaning::Shapes, allowance };
    let start = FileStart::of(&source.file)?;
    let format = FORMATS.iter().find(|format| (format.is_one)(&source, &start));
    let (read, digest) = match format {
        Some(format) => unchanged(&source.file, || Ok(((format.read)(&source)?, digest(&source.file)?)))?,
        None => {
            let ModeColumns { columns, digest } = mode_columns(path, rows.n, allowance)?;
            (ReadModes::of_columns(columns), digest)
        }
    };
    let ReadModes { columns, values, program, digits, notes } = read;
    let rounding = ModeRounding::of(digits.map_or_else(|| digits_of_modes(&columns), Digits::relative));
    let is_along_rows = format.is_none_or(|format| format.along == Along::Rows);
    let turning = rows.turning.clone().filter(|_| is_along_rows);
    let values = values.map(|(unit, numbers)| ModeValues::new(unit, numbers));
    let n_modes = columns.len();
    if let Some(values) = values.as_ref().filter(|values| values.numbers.len() != n_modes) {
        return Err(Error::ValuesCount { path: Some(source.file), found: values.numbers.len() as u64, n_modes });
    }
    let is_square = start.is_hdf5() && program.is_none() && n_modes == rows.n;
    let orientation = if is_square { Orientation::Square } else { Orientation::Known };
    Ok(ForeignModes { rounding, columns, turning, values, program, orientation, notes, digest })
}
