//! The formats that are read, one line each, and how the one of a file is found.

use std::path::Path;

use super::abaqus_labels::AbaqusLabels;
use super::ansys_mapping::AnsysMapping;
use super::dmig::Dmig;
use super::dof_map::DofText;
use super::file_start::FileStart;
use super::format::{DofMapFormat, Format, MatrixFormat, MatrixSource, NodeFormat, Sureness};
use super::harwell_boeing::HarwellBoeing;
use super::hdf5_format::{Hdf5Matrix, Hdf5Mesh};
use super::matlab5::Matlab5;
use super::matrix_market::{Coordinate, MatrixMarket};
use super::mesh;
use super::nastran_nodes::NastranNodes;
use super::nastran_rows::NastranRows;
use super::node_table::NodeTable;
use super::npy_matrix::NpyMatrix;
use super::npz::Npz;
use super::op4::Op4;
use super::superelement_file::SuperelementFile;
use super::unsupported_format::{self, Wanted};
use super::user_element::UserElement;
use crate::error::{Error, Result};

/// Formats of matrices.
const MATRICES: [&dyn MatrixFormat; 12] = [
    &SuperelementFile,
    &MatrixMarket,
    &Hdf5Matrix,
    &Matlab5,
    &Npz,
    &NpyMatrix,
    &Op4,
    &Dmig,
    &AbaqusLabels,
    &UserElement,
    &HarwellBoeing,
    &Coordinate,
];
/// Formats of nodes.
const NODES: [&dyn NodeFormat; 9] = [
    &SuperelementFile,
    &Hdf5Mesh,
    &NastranNodes,
    &mesh::DECK,
    &mesh::GMSH,
    &mesh::FRD,
    &mesh::VTK,
    &mesh::VTU,
    &NodeTable,
];
/// Formats of dof maps.
const DOF_MAPS: [&dyn DofMapFormat; 4] = [&SuperelementFile, &NastranRows, &AnsysMapping, &DofText];

/// The format of a matrix: the one that the job names, or the only one that the content fits.
///
/// # Errors
/// [`Error::FormatNotRead`]; [`Error::FormatAmbiguous`]; those of opening the file.
pub(super) fn of_matrix(source: &MatrixSource<'_>) -> Result<&'static dyn MatrixFormat> {
    let named = source.layout.and_then(|layout| MATRICES.iter().find(|format| format.layout() == layout));
    if let Some(named) = named {
        return Ok(*named);
    }
    let start = FileStart::of(&source.file)?;
    let certain: Vec<_> = MATRICES.into_iter().filter(|format| format.sureness(&start) == Sureness::Certain).collect();
    match certain[..] {
        [] => surest(&MATRICES, |format| *format, &start, Wanted::Matrix).copied(),
        [only] => Ok(only),
        _ => {
            let formats = certain.iter().map(|format| format.layout().name()).collect();
            Err(Error::FormatAmbiguous { path: source.file.clone(), formats })
        }
    }
}

/// The format of nodes.
///
/// # Errors
/// The errors of [`of_matrix`].
pub(super) fn of_nodes(file: &Path) -> Result<&'static dyn NodeFormat> {
    surest(&NODES, |format| *format, &FileStart::of(file)?, Wanted::Table).copied()
}

/// The format of a dof map.
///
/// # Errors
/// The errors of [`of_matrix`].
pub(super) fn of_dof_map(file: &Path) -> Result<&'static dyn DofMapFormat> {
    surest(&DOF_MAPS, |format| *format, &FileStart::of(file)?, Wanted::Table).copied()
}

/// The format that is surest of a file, the first of several. Files of formats that are not read are told by their content alone.
fn surest<'f, F>(
    formats: &'f [F],
    as_format: fn(&F) -> &dyn Format,
    start: &FileStart<'_>,
    wanted: Wanted,
) -> Result<&'f F> {
    let sureness = |format: &F| as_format(format).sureness(start);
    let mut surest = &formats[0];
    for format in &formats[1..] {
        if sureness(format) > sureness(surest) {
            surest = format;
        }
    }
    if sureness(surest) < Sureness::Certain {
        unsupported_format::refuse(start, wanted)?;
    }
    Ok(surest)
}
