//! Which reader a file needs, by its name or its first bytes, and which files a model is made of.

use std::io::Read;
use std::path::{Path, PathBuf};

use crate::job::ModelJob;
use crate::regular_file;

/// Every file of a model with what it is, those that its files refer to among them. Files that cannot be read are listed all the same.
pub fn files(model: &ModelJob) -> Vec<(&'static str, PathBuf)> {
    let matrix = |path: &Path| hdf5_location(path).map_or_else(|| path.to_owned(), |(file, _)| file);
    let mut files = vec![("the stiffness", matrix(&model.stiffness)), ("the mass", matrix(&model.mass))];
    files.extend(model.dofs.clone().map(|path| ("the dof map", path)));
    if let Some(nodes) = &model.nodes {
        files.push(("the nodes", nodes.clone()));
        files.extend(mesh_data(nodes).into_iter().map(|path| ("the data of the nodes", path)));
    }
    files
}

/// Files that a mesh refers to.
#[cfg(feature = "hdf5")]
fn mesh_data(path: &Path) -> Vec<PathBuf> {
    if is_hdf5_mesh(path) { super::hdf5::referenced_files(path) } else { Vec::new() }
}

#[cfg(not(feature = "hdf5"))]
fn mesh_data(_: &Path) -> Vec<PathBuf> {
    Vec::new()
}

/// The first file of a model that the HDF5 library reads, where one is.
pub fn hdf5_file(model: &ModelJob) -> Option<PathBuf> {
    let matrices = [&model.stiffness, &model.mass].into_iter().filter_map(|path| Some(hdf5_location(path)?.0));
    let nodes = model.nodes.iter().filter(|path| is_hdf5_mesh(path)).cloned();
    matrices.chain(nodes).find(|path| regular_file::open(path).is_ok())
}

/// File and group of a matrix in HDF5, told by `file.h5:/group`, by the extension or by the content.
pub(super) fn hdf5_location(path: &Path) -> Option<(PathBuf, Option<String>)> {
    const CONTAINERS: [&str; 6] = ["h5", "hdf5", "hdf", "mat", "h5ad", "he5"];
    if let Some((file, group)) = path.to_str().and_then(|text| text.rsplit_once(":/"))
        && !path.exists()
        && (has_extension(Path::new(file), &CONTAINERS) || is_hdf5(Path::new(file)))
    {
        return Some((file.into(), Some(format!("/{group}"))));
    }
    (has_extension(path, &CONTAINERS) || is_hdf5(path)).then(|| (path.to_owned(), None))
}

/// A mesh in HDF5, or in XML that refers to it.
pub(super) fn is_hdf5_mesh(path: &Path) -> bool {
    const MESHES: [&str; 6] = ["h5m", "hmf", "med", "rmed", "xdmf", "xmf"];
    has_extension(path, &MESHES) || is_hdf5(path)
}

fn has_extension(path: &Path, known: &[&str]) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    known.iter().any(|name| extension.eq_ignore_ascii_case(name))
}

/// Whether a file starts as HDF5 does, or does so behind the block of 512 bytes that MATLAB puts first.
fn is_hdf5(path: &Path) -> bool {
    const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
    let Ok(file) = regular_file::open(path) else { return false };
    let mut start = Vec::new();
    let is_read = file.take(512 + SIGNATURE.len() as u64).read_to_end(&mut start).is_ok();
    is_read && (start.starts_with(SIGNATURE) || start.get(512..).is_some_and(|rest| rest.starts_with(SIGNATURE)))
}
