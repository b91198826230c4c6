//! The formats that are read, one line each, and how the one of a file is found.

use std::path::Path;

use super::dof_map::DofText;
use super::file_start::FileStart;
use super::format::{DofMapFormat, Format, MatrixFormat, NodeFormat, Sureness};
use super::hdf5_format::{Hdf5Matrix, Hdf5Mesh};
use super::matrix_market::TextMatrix;
use super::node_table::NodeTable;
use super::unsupported_format::{self, Wanted};
use crate::error::Result;

/// Formats of matrices.
const MATRICES: [&dyn MatrixFormat; 2] = [&Hdf5Matrix, &TextMatrix];
/// Formats of nodes.
const NODES: [&dyn NodeFormat; 2] = [&Hdf5Mesh, &NodeTable];
/// Formats of dof maps.
const DOF_MAPS: [&dyn DofMapFormat; 1] = [&DofText];

/// The format of a matrix.
///
/// # Errors
/// [`Error::FormatNotRead`](crate::error::Error::FormatNotRead); those of opening the file.
pub(super) fn of_matrix(file: &Path) -> Result<&'static dyn MatrixFormat> {
    surest(&MATRICES, |format| *format, file, Wanted::Matrix).copied()
}

/// The format of nodes.
///
/// # Errors
/// The errors of [`of_matrix`].
pub(super) fn of_nodes(file: &Path) -> Result<&'static dyn NodeFormat> {
    surest(&NODES, |format| *format, file, Wanted::Table).copied()
}

/// The format of a dof map.
///
/// # Errors
/// The errors of [`of_matrix`].
pub(super) fn of_dof_map(file: &Path) -> Result<&'static dyn DofMapFormat> {
    surest(&DOF_MAPS, |format| *format, file, Wanted::Table).copied()
}

/// The format that is surest of a file, the first of several. Files of formats that are not read are told by their content alone.
fn surest<'f, F>(formats: &'f [F], as_format: fn(&F) -> &dyn Format, file: &Path, wanted: Wanted) -> Result<&'f F> {
    let start = FileStart::of(file)?;
    let sureness = |format: &F| as_format(format).sureness(&start);
    let mut surest = &formats[0];
    for format in &formats[1..] {
        if sureness(format) > sureness(surest) {
            surest = format;
        }
    }
    if sureness(surest) < Sureness::Certain {
        unsupported_format::refuse(&start, wanted)?;
    }
    Ok(surest)
}
