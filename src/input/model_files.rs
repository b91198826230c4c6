//! The files of a finite element model: which reader each one needs, and whether they fit together.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::blocks::LastLine;
use super::dof_map::{self, DirectionBase};
use super::matrix_market::{OrderSource, TextMatrix};
use super::{DofMap, InputNote, MatrixInput, Nodes, Triangle, empty_rows, matrix_market, node_table};
use crate::error::{Error, Result};
use crate::job::{Duplicates, ModelJob};
use crate::sparse::SparseMatrix;

/// A finite element model as it was read: matrices of one size, a dof map that fits them, nodes that fit the map.
#[derive(Clone, Debug)]
pub struct Input {
    /// K.
    pub stiffness: MatrixInput,
    /// M.
    pub mass: MatrixInput,
    /// What each row stands for; absent where the job names neither a dof map nor nodes.
    pub dofs: Option<DofMap>,
    /// Nodes; absent where the job names none.
    pub nodes: Option<Nodes>,
    /// What reading needed beyond copying.
    pub notes: Vec<InputNote>,
}

/// Reads the files of a model, K and M at the same time.
///
/// # Errors
/// Those of the files; [`Error::SizeMismatch`], [`Error::DofCount`], [`Error::DofNodeMissing`] and
/// [`Error::DofOrderUnknown`] where they do not fit together; [`Error::Duplicates`] where the job refuses them.
pub fn read(model: &ModelJob) -> Result<Input> {
    let mut notes = Vec::new();
    let (stiffness, mass) = rayon::join(|| read_matrix(model, Role::Stiffness), || read_matrix(model, Role::Mass));
    let (mut stiffness, mut mass) = fit_matrices(stiffness?, mass?, &mut notes)?;
    for matrix in [&mut stiffness, &mut mass] {
        refuse_duplicates(matrix, model.duplicates)?;
        notes.extend(model.symmetric.and_then(|triangle| take_triangle(matrix, triangle)));
        notes.extend(last_row_empty(matrix));
    }
    let n = stiffness.matrix.rows();
    let nodes = model.nodes.as_deref().map(read_nodes).transpose()?;
    let given = nodes.as_ref().zip(model.nodes.as_deref());
    let mut dofs = match (model.dofs.as_deref(), given) {
        (Some(path), given) => Some(read_dofs(path, n, given, &mut notes)?),
        (None, Some((nodes, path))) => {
            let dofs = dof_map::default_order(nodes, path, n)?;
            let dofs_per_node = n / nodes.labels.len();
            notes.push(InputNote::DefaultOrder { dofs_per_node, nodes: path.to_owned() });
            Some(dofs)
        }
        (None, None) => None,
    };
    if model.drop_empty {
        notes.extend(empty_rows::drop_empty(&mut stiffness, &mut mass, &mut dofs));
    }
    Ok(Input { stiffness, mass, dofs, nodes, notes })
}

/// The first file of a model that the HDF5 library reads, where one is.
pub fn hdf5_file(model: &ModelJob) -> Option<PathBuf> {
    let matrices = [&model.stiffness, &model.mass].into_iter().filter_map(|path| Some(hdf5_location(path)?.0));
    let nodes = model.nodes.iter().filter(|path| is_hdf5_mesh(path)).cloned();
    matrices.chain(nodes).find(|path| path.is_file())
}

/// A matrix from whichever kind of file.
enum Matrix {
    Text(TextMatrix),
    Hdf5(MatrixInput),
}

/// Which matrix of the pencil a file is read for; names inside an HDF5 file are matched against it.
#[derive(Clone, Copy)]
enum Role {
    Stiffness,
    Mass,
}

fn read_matrix(model: &ModelJob, role: Role) -> Result<Matrix> {
    let path = match role {
        Role::Stiffness => &model.stiffness,
        Role::Mass => &model.mass,
    };
    match hdf5_location(path) {
        Some((file, group)) => read_hdf5_matrix(&file, group.as_deref(), role).map(Matrix::Hdf5),
        None => matrix_market::read(path, model.symmetric).map(Matrix::Text),
    }
}

fn read_nodes(path: &Path) -> Result<Nodes> {
    if is_hdf5_mesh(path) {
        return read_hdf5_nodes(path);
    }
    node_table::read(path)
}

/// A mesh in HDF5, or in XML beside it.
fn is_hdf5_mesh(path: &Path) -> bool {
    const MESHES: [&str; 6] = ["h5m", "hmf", "med", "rmed", "xdmf", "xmf"];
    has_extension(path, &MESHES) || is_hdf5(path)
}

#[cfg(feature = "hdf5")]
fn read_hdf5_matrix(path: &Path, group: Option<&str>, role: Role) -> Result<MatrixInput> {
    let role = match role {
        Role::Stiffness => super::hdf5::MatrixRole::Stiffness,
        Role::Mass => super::hdf5::MatrixRole::Mass,
    };
    super::hdf5::read_matrix(path, group, role)
}

#[cfg(feature = "hdf5")]
fn read_hdf5_nodes(path: &Path) -> Result<Nodes> {
    super::hdf5::read_nodes(path)
}

#[cfg(not(feature = "hdf5"))]
fn read_hdf5_matrix(path: &Path, _: Option<&str>, _: Role) -> Result<MatrixInput> {
    Err(Error::FeatureMissing { path: path.to_owned(), feature: "hdf5" })
}

#[cfg(not(feature = "hdf5"))]
fn read_hdf5_nodes(path: &Path) -> Result<Nodes> {
    Err(Error::FeatureMissing { path: path.to_owned(), feature: "hdf5" })
}

/// File and group of a matrix in HDF5, told by `file.h5:/group`, by the extension or by the content.
fn hdf5_location(path: &Path) -> Option<(PathBuf, Option<String>)> {
    const CONTAINERS: [&str; 6] = ["h5", "hdf5", "hdf", "mat", "h5ad", "he5"];
    if let Some((file, group)) = path.to_str().and_then(|text| text.rsplit_once(":/"))
        && !path.exists()
        && (has_extension(Path::new(file), &CONTAINERS) || is_hdf5(Path::new(file)))
    {
        return Some((file.into(), Some(format!("/{group}"))));
    }
    (has_extension(path, &CONTAINERS) || is_hdf5(path)).then(|| (path.to_owned(), None))
}

fn has_extension(path: &Path, known: &[&str]) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    known.iter().any(|name| extension.eq_ignore_ascii_case(name))
}

/// Whether a file starts as HDF5 does, or does so behind the block of 512 bytes that MATLAB puts first.
fn is_hdf5(path: &Path) -> bool {
    const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
    // Opening a pipe would wait for its writer.
    if !path.is_file() {
        return false;
    }
    let mut start = Vec::new();
    let file = std::fs::File::open(path);
    let is_read = file.and_then(|file| file.take(512 + SIGNATURE.len() as u64).read_to_end(&mut start)).is_ok();
    is_read && (start.starts_with(SIGNATURE) || start.get(512..).is_some_and(|rest| rest.starts_with(SIGNATURE)))
}

/// Brings K and M to one order, which only a matrix without a size line allows, and notes what each needed.
fn fit_matrices(stiffness: Matrix, mass: Matrix, notes: &mut Vec<InputNote>) -> Result<(MatrixInput, MatrixInput)> {
    let (stiffness, stiffness_order) = take_notes(stiffness, notes);
    let (mass, mass_order) = take_notes(mass, notes);
    let (n_stiffness, n_mass) = (stiffness.matrix.rows(), mass.matrix.rows());
    if n_stiffness < n_mass && stiffness_order == OrderSource::LargestIndex {
        return Ok((extend(stiffness, n_mass, notes), mass));
    }
    if n_mass < n_stiffness && mass_order == OrderSource::LargestIndex {
        return Ok((stiffness, extend(mass, n_stiffness, notes)));
    }
    if n_stiffness != n_mass {
        let (stiffness, mass) = (stiffness.path, mass.path);
        return Err(Error::SizeMismatch { stiffness, n_stiffness, mass, n_mass });
    }
    Ok((stiffness, mass))
}

fn take_notes(matrix: Matrix, notes: &mut Vec<InputNote>) -> (MatrixInput, OrderSource) {
    let (input, order) = match matrix {
        Matrix::Hdf5(input) => (input, OrderSource::SizeLine),
        Matrix::Text(TextMatrix { input, order, last_line }) => {
            if order == OrderSource::LargestIndex {
                notes.push(InputNote::OrderFromIndices { path: input.path.clone(), n: input.matrix.rows() });
            }
            if last_line == LastLine::Open {
                notes.push(InputNote::OpenLastLine { path: input.path.clone() });
            }
            (input, order)
        }
    };
    if input.notes.n_duplicates > 0 {
        notes.push(InputNote::Duplicates { path: input.path.clone(), count: input.notes.n_duplicates });
    }
    if input.notes.mirrored {
        notes.push(InputNote::Mirrored { path: input.path.clone() });
    }
    (input, order)
}

fn refuse_duplicates(matrix: &MatrixInput, duplicates: Duplicates) -> Result<()> {
    match (duplicates, matrix.notes.n_duplicates) {
        (Duplicates::Refuse, count @ 1..) => Err(Error::Duplicates { path: matrix.path.clone(), count }),
        _ => Ok(()),
    }
}

/// Replaces the other triangle by the mirror image of this one.
fn take_triangle(matrix: &mut MatrixInput, triangle: Triangle) -> Option<InputNote> {
    let (mirrored, n_differing) = triangle.mirrored(&matrix.matrix);
    matrix.matrix = mirrored;
    (n_differing > 0).then(|| InputNote::TriangleTaken { path: matrix.path.clone(), triangle, n_differing })
}

/// An empty last row where no other row is empty: what indices from zero leave in a matrix that reads as if from one.
fn last_row_empty(matrix: &MatrixInput) -> Option<InputNote> {
    let n = matrix.matrix.rows();
    let mut empty = (0..n).filter(|row| matrix.matrix.outer_view(*row).is_none_or(|view| view.nnz() == 0));
    let is_last = n > 1 && empty.next() == Some(n - 1);
    is_last.then(|| InputNote::LastRowEmpty { path: matrix.path.clone(), n })
}

/// Adds empty rows and columns up to the order n.
fn extend(input: MatrixInput, n: usize, notes: &mut Vec<InputNote>) -> MatrixInput {
    let MatrixInput { matrix, notes: assembly, digits, path, digest } = input;
    notes.push(InputNote::Extended { path: path.clone(), from: matrix.rows(), to: n });
    let (mut pointers, indices, data) = matrix.into_raw_storage();
    pointers.resize(n + 1, indices.len());
    let matrix = SparseMatrix::new((n, n), pointers, indices, data);
    MatrixInput { matrix, notes: assembly, digits, path, digest }
}

fn read_dofs(path: &Path, n: usize, nodes: Option<(&Nodes, &Path)>, notes: &mut Vec<InputNote>) -> Result<DofMap> {
    let read = dof_map::read(path)?;
    if read.dofs.len() != n {
        return Err(Error::DofCount { path: path.to_owned(), found: read.dofs.len(), n });
    }
    if read.base == DirectionBase::Zero {
        notes.push(InputNote::DirectionsFromZero { path: path.to_owned() });
    }
    if let Some((nodes, nodes_path)) = nodes {
        let count = dof_map::check_nodes(&read.dofs, path, nodes, nodes_path)?;
        if count > 0 {
            notes.push(InputNote::UnusedNodes { path: nodes_path.to_owned(), count });
        }
    }
    Ok(read.dofs)
}
