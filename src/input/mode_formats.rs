//! The formats of modes by their content, and the numbers of modes in a file of any of them.

use std::path::Path;

use super::Allowance;
use super::file_start::FileStart;
use super::frd_modes;
use super::hdf5_format;
use super::matlab5;
use super::member::split_member;
use super::mode_format::{ModeSource, ReadModes};
use super::mode_matrix::Meaning;
use super::mode_rows::ModeRows;
use super::modes_file::columns_of_numbers;
use super::npy_header::is_array;
use super::npy_series;
use super::npz;
use super::op4;
use crate::error::{Error, Result};

/// Which axes the values at a node are along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Along {
    /// The axes of the rows of K and M in their files.
    Rows,
    /// The axes of the model.
    Model,
}

/// A format of modes with their frequencies.
pub(super) struct ModeFormat {
    /// Whether a file is one of the format.
    pub(super) is_one: fn(&ModeSource<'_>, &FileStart<'_>) -> bool,
    pub(super) read: fn(&ModeSource<'_>) -> Result<ReadModes>,
    pub(super) along: Along,
    holds: Holds,
}

/// What a format has of each mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Holds {
    /// Numbers, which may be shapes or frequencies.
    Numbers,
    /// Shapes with their frequencies, as a program writes them.
    Pairs,
}

/// The formats, those that know more than shapes first; what none of them takes is a matrix of numbers.
pub(super) const FORMATS: [ModeFormat; 6] = [
    ModeFormat {
        is_one: |source, start| start.is_hdf5() && source.member.is_none(),
        read: hdf5_format::foreign_modes,
        along: Along::Rows,
        holds: Holds::Pairs,
    },
    ModeFormat { is_one: |_, start| op4::begins(start), read: op4::modes, along: Along::Rows, holds: Holds::Numbers },
    ModeFormat {
        is_one: |_, start| matlab5::begins(start),
        read: matlab5::modes,
        along: Along::Rows,
        holds: Holds::Numbers,
    },
    ModeFormat {
        is_one: |_, start| frd_modes::begins(start),
        read: frd_modes::modes,
        along: Along::Model,
        holds: Holds::Pairs,
    },
    ModeFormat { is_one: |_, start| npz::begins(start), read: npz::modes, along: Along::Rows, holds: Holds::Numbers },
    ModeFormat {
        is_one: |source, start| source.member.is_some() && is_array(&start.head),
        read: npy_series::modes,
        along: Along::Rows,
        holds: Holds::Numbers,
    },
];

/// One number of each mode in a file of a format that has numbers, in a column or in a row; none where the file is of no such format.
///
/// # Errors
/// What the readers return; [`Error::ModesRows`] and [`Error::ModesColumns`] for another size than a column or a row of `n_modes`.
pub(super) fn values_of_modes(path: &Path, n_modes: usize, allowance: &Allowance) -> Result<Option<Vec<f64>>> {
    let (file, member) = split_member(path);
    let start = FileStart::of(&file)?;
    let columns_of = |n: usize| -> Result<Option<Vec<Vec<f64>>>> {
        let rows = ModeRows { n, left: Vec::new(), turning: None };
        let meaning = Meaning::Values { n_modes };
        let (file, member) = (file.clone(), member.clone());
        let source = ModeSource { file, member, rows: &rows, meaning, allowance };
        let mut formats = FORMATS.iter().filter(|format| format.holds == Holds::Numbers);
        match formats.find(|format| (format.is_one)(&source, &start)) {
            Some(format) => (format.read)(&source).map(|read| Some(read.columns)),
            None if start.is_hdf5() || is_array(&start.head) || start.holds(b"%%MatrixMarket") => {
                columns_of_numbers(path, (n, meaning), allowance).map(|read| Some(read.columns))
            }
            None => Ok(None),
        }
    };
    let columns = match columns_of(n_modes) {
        // A row of them.
        Err(Error::ModesRows { found: 1, .. }) => columns_of(1),
        other => other,
    };
    Ok(columns?.map(|columns| columns.concat()))
}
