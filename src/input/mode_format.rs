//! What a format of modes is given and makes of it.

use std::path::PathBuf;

use super::Allowance;
use super::mode_matrix::Meaning;
use super::mode_rows::ModeRows;
use super::value_unit::ValueUnit;

/// A file of modes.
pub(super) struct ModeSource<'a> {
    pub(super) file: PathBuf,
    /// The place in the file that was named.
    pub(super) member: Option<String>,
    /// The rows of the matrices in their files.
    pub(super) rows: &'a ModeRows,
    pub(super) meaning: Meaning,
    pub(super) allowance: &'a Allowance,
}

/// What a format makes of a file.
pub(super) struct ReadModes {
    pub(super) columns: Vec<Vec<f64>>,
    /// What the numbers are that stand next to the shapes, and one for each mode.
    pub(super) values: Option<(ValueUnit, Vec<f64>)>,
    pub(super) program: Option<&'static str>,
    /// Digits that the format gives each number of the shapes; none where the numbers themselves tell.
    pub(super) digits: Option<u32>,
    /// What reading left out, one sentence each.
    pub(super) notes: Vec<String>,
}

impl ReadModes {
    /// Shapes of a format that gives them as they are, one value for every row.
    pub(super) fn of_columns(columns: Vec<Vec<f64>>) -> Self {
        Self { columns, values: None, program: None, digits: None, notes: Vec::new() }
    }
}
