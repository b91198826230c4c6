//! What a format of modes is given and makes of it.

use std::path::PathBuf;

use super::Allowance;
use super::value_unit::ValueUnit;

/// A file of modes.
pub(super) struct ModeSource<'a> {
    pub(super) file: PathBuf,
    /// The place in the file that was named.
    pub(super) member: Option<String>,
    /// Rows of the matrices in their files.
    pub(super) n_rows: usize,
    pub(super) allowance: &'a Allowance,
}

/// What a format makes of a file.
pub(super) struct ReadModes {
    pub(super) columns: Vec<Vec<f64>>,
    /// What the numbers are that stand next to the shapes, and one for each mode.
    pub(super) values: Option<(ValueUnit, Vec<f64>)>,
    pub(super) program: Option<&'static str>,
}
