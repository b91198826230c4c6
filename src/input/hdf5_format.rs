//! Matrices and meshes in HDF5 among the other formats, also where the program is built without the library.

use std::path::Path;
#[cfg(feature = "hdf5")]
use std::path::PathBuf;

use super::Allowance;
#[cfg(feature = "hdf5")]
use super::Digits;
use super::file_start::FileStart;
#[cfg(feature = "hdf5")]
use super::format::ReadCells;
use super::format::{Format, MatrixFormat, MatrixSource, NodeFormat, ReadMatrix, ReadNodes, Sureness};
#[cfg(feature = "hdf5")]
use super::hdf5;
use super::member::split_member;
use super::mode_format::{ModeSource, ReadModes};
#[cfg(feature = "hdf5")]
use super::patch::{PatchFaces, Patches};
#[cfg(not(feature = "hdf5"))]
use crate::error::Error;
use crate::error::Result;
use crate::job::Layout;

/// Extensions of files that hold matrices in HDF5.
const CONTAINERS: [&str; 6] = ["h5", "hdf5", "hdf", "mat", "h5ad", "he5"];
/// Extensions of meshes in HDF5, or in XML that refers to it.
const MESHES: [&str; 6] = ["h5m", "hmf", "med", "rmed", "xdmf", "xmf"];

/// Sparse matrices in HDF5.
pub(super) struct Hdf5Matrix;

/// Meshes in HDF5, or in XML that refers to it.
pub(super) struct Hdf5Mesh;

/// The modes in a dataset of an HDF5 file, for matrices of `n_rows` rows.
///
/// # Errors
/// The errors of [`super::mode_columns`]; [`Error::FeatureMissing`] where the program is built without the library.
#[cfg_attr(not(feature = "hdf5"), expect(unused_variables, reason = "nothing is read"))]
pub(super) fn mode_columns(
    path: &Path,
    dataset: Option<&str>,
    n_rows: usize,
    allowance: &Allowance,
) -> Result<Vec<Vec<f64>>> {
    #[cfg(feature = "hdf5")]
    return hdf5::mode_columns(path, dataset, n_rows, allowance);
    #[cfg(not(feature = "hdf5"))]
    return Err(Error::FeatureMissing { path: path.to_owned(), feature: "hdf5" });
}

/// The modes in an HDF5 file that was written by a program that is known, with their eigenvalues.
///
/// # Errors
/// Those of [`super::mode_columns`]; [`Error::FeatureMissing`] where the program is built without the library.
pub(super) fn foreign_modes(source: &ModeSource<'_>) -> Result<ReadModes> {
    #[cfg(feature = "hdf5")]
    return hdf5::feminterface_modes(&source.file, source.rows.n, source.allowance);
    #[cfg(not(feature = "hdf5"))]
    return Err(Error::FeatureMissing { path: source.file.clone(), feature: "hdf5" });
}

/// Whether the modes of a job are in an HDF5 file.
pub(super) fn has_modes(path: &Path) -> bool {
    FileStart::of(&split_member(path).0).is_ok_and(|start| start.is_hdf5())
}

/// Reads modes, or their frequencies, where they are in an HDF5 file, and discards them.
///
/// # Errors
/// A file that cannot be read or has no such dataset.
#[cfg_attr(not(feature = "hdf5"), expect(unused_variables, reason = "nothing is read"))]
pub(super) fn rehearse_modes(path: &Path, allowance: &Allowance) -> Result<()> {
    #[cfg(feature = "hdf5")]
    if has_modes(path) {
        return match split_member(path) {
            (file, Some(dataset)) => hdf5::rehearse_dataset(&file, &dataset, allowance),
            (file, None) => hdf5::rehearse_feminterface(&file, allowance),
        };
    }
    Ok(())
}

fn sureness(start: &FileStart<'_>, extensions: &[&str]) -> Sureness {
    match () {
        () if start.is_hdf5() => Sureness::Certain,
        () if start.has_extension(extensions) => Sureness::Named,
        () => Sureness::Unlikely,
    }
}

impl Format for Hdf5Matrix {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        sureness(start, &CONTAINERS)
    }

    fn is_parsed_in_c(&self) -> bool {
        true
    }
}

impl Format for Hdf5Mesh {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        sureness(start, &MESHES)
    }

    fn is_parsed_in_c(&self) -> bool {
        true
    }
}

#[cfg(feature = "hdf5")]
impl MatrixFormat for Hdf5Matrix {
    fn layout(&self) -> Layout {
        Layout::Hdf5
    }

    fn has_members(&self) -> bool {
        true
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        let MatrixSource { file, member, role, stated_digits, allowance, .. } = source;
        let mut input = hdf5::read_matrix_within(file, member.as_deref(), *role, allowance)?;
        input.digits = stated_digits.map_or(input.digits, Digits::stated);
        Ok(ReadMatrix::with_size(input))
    }
}

#[cfg(feature = "hdf5")]
impl NodeFormat for Hdf5Mesh {
    fn read(&self, path: &Path, allowance: &Allowance) -> Result<ReadNodes> {
        hdf5::read_nodes_within(path, allowance).map(|(nodes, digest)| ReadNodes::along_the_axes(nodes, digest))
    }

    fn referenced_files(&self, path: &Path) -> Vec<PathBuf> {
        hdf5::referenced_files(path)
    }

    fn data_digest(&self, path: &Path) -> Result<Option<String>> {
        hdf5::data_digest(path)
    }

    fn has_cells(&self) -> bool {
        true
    }

    fn read_cells(&self, path: &Path, coordinates: &[[f64; 3]], allowance: &Allowance) -> Result<ReadCells> {
        hdf5::read_cells(path, coordinates, allowance)
    }

    fn read_faces(&self, path: &Path, patches: &Patches, allowance: &Allowance) -> Result<Vec<PatchFaces>> {
        hdf5::read_faces(path, patches, allowance)
    }
}

#[cfg(not(feature = "hdf5"))]
impl MatrixFormat for Hdf5Matrix {
    fn layout(&self) -> Layout {
        Layout::Hdf5
    }

    fn has_members(&self) -> bool {
        true
    }

    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix> {
        Err(Error::FeatureMissing { path: source.file.clone(), feature: "hdf5" })
    }
}

#[cfg(not(feature = "hdf5"))]
impl NodeFormat for Hdf5Mesh {
    fn read(&self, path: &Path, _: &Allowance) -> Result<ReadNodes> {
        Err(Error::FeatureMissing { path: path.to_owned(), feature: "hdf5" })
    }
}
