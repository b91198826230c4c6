//! The files of a finite element model: which there are, what they hold, and whether it fits together.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::allowance::Allowance;
use super::blocks::LastLine;
use super::constraint_file::{ConstraintRows, constraint_rows};
use super::format::{DirectionBase, MatrixSource, OrderSource, ReadMatrix};
use super::further_matrix::FurtherMatrix;
use super::hdf5_format::{self, split_group};
use super::internal_forces::{on_rows, read_internal_forces};
use super::load_file::{LoadColumn, WantedColumn, load_column};
use super::modes_file::{ModeColumns, mode_columns};
use super::patch::Patches;
use super::quantity_files::{QuantityRows, quantity_rows};
use super::{Cells, InputNote, MatrixInput, MatrixRole, dof_map, empty_rows, formats};
use crate::dofs::{DofMap, FileRows, Nodes};
use crate::error::{Error, Result};
use crate::job::{
    ConstraintsToGround, Duplicates, Job, LoadJob, LoadPattern, MatrixJob, ModelJob, QuantitiesJob, ReductionJob,
};
use crate::regular_file::{digest, unchanged};
use crate::sparse::SparseMatrix;
use crate::sparse::Triangle;

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
    /// Which rows of the files are left.
    pub rows: FileRows,
    /// Multipoint constraints on the rows that are left; absent where the job names none.
    pub constraints: Option<ConstraintRows>,
    /// Internal forces of a preloaded state, one for each row that is left, in the units of the file; absent where the job names none.
    pub internal_forces: Option<Vec<f64>>,
    /// BLAKE3 digests of the files of the dof map (`dofs`), of the nodes (`nodes`), of what those refer to (`nodes_data`), of the
    /// constraints (`constraints`) and of the internal forces (`internal_forces`), lower-case hexadecimal.
    pub digests: BTreeMap<&'static str, String>,
    /// What reading needed beyond copying.
    pub notes: Vec<InputNote>,
}

impl Input {
    /// Rows of the matrices in their files, those that were dropped included.
    pub fn n_file_rows(&self) -> usize {
        self.stiffness.matrix.rows() + self.rows.n_dropped()
    }
}

/// Reads the files of a model, K and M at the same time, whatever memory that takes.
///
/// # Errors
/// The errors of [`read_within`].
pub fn read(model: &ModelJob) -> Result<Input> {
    read_within(model, &Allowance::of(None))
}

/// Reads the files of a model, K and M at the same time.
///
/// # Errors
/// A file that cannot be read or whose content is wrong; [`Error::Changed`] where one is written meanwhile;
/// [`Error::MemoryRead`] where they hold more than `allowance`;
/// [`Error::SizeMismatch`], [`Error::DofCount`], [`Error::DofNodeMissing`] and [`Error::DofOrderUnknown`] where they do not fit together;
/// [`Error::Duplicates`] where the job refuses them.
pub fn read_within(model: &ModelJob, allowance: &Allowance) -> Result<Input> {
    let mut notes = Vec::new();
    let [stiffness, mass] = own_sources(model, allowance);
    let (stiffness, mass) = rayon::join(|| read_matrix(&stiffness), || read_matrix(&mass));
    let (mut stiffness, mut mass) = fit_matrices(stiffness?, mass?, &mut notes)?;
    for matrix in [&mut stiffness, &mut mass] {
        refuse_duplicates(matrix, model.duplicates)?;
        notes.extend(model.symmetric.and_then(|triangle| take_triangle(matrix, triangle)));
        notes.extend(last_row_empty(matrix));
    }
    let n = stiffness.matrix.rows();
    let mut digests = BTreeMap::new();
    let nodes = model.nodes.as_deref().map(|path| read_nodes(path, allowance, &mut digests)).transpose()?;
    let given = nodes.as_ref().zip(model.nodes.as_deref());
    let mut dofs = match (model.dofs.as_deref(), given) {
        (Some(path), given) => {
            let (dofs, digest) = unchanged(path, || Ok((read_dofs(path, n, given, &mut notes)?, digest(path)?)))?;
            digests.insert("dofs", digest);
            Some(dofs)
        }
        (None, Some((nodes, path))) => {
            let dofs = dof_map::default_order(nodes, path, n)?;
            let dofs_per_node = n / nodes.labels.len();
            notes.push(InputNote::DefaultOrder { dofs_per_node, nodes: path.to_owned() });
            Some(dofs)
        }
        (None, None) => None,
    };
    let constraints = read_constraints(model, n, allowance, &mut digests)?;
    let forces = read_internal_forces(model, n, &mut digests)?;
    let mut rows = FileRows::default();
    let tied = constraints.as_ref().map_or_else(Vec::new, ConstraintRows::tied);
    if model.drop_empty
        && let Some((kept, note)) = empty_rows::drop_empty((&mut stiffness, &mut mass), &mut dofs, &tied)
    {
        rows = kept;
        notes.push(note);
    }
    // A row that takes part in a constraint is not dropped.
    let number = |row: u32| rows.find(row as usize).unwrap_or_default() as u32;
    let constraints = constraints.map(|constraints| constraints.renumbered(number));
    let internal_forces = forces.map(|forces| on_rows(forces, &rows, stiffness.matrix.rows())).transpose()?;
    Ok(Input { stiffness, mass, dofs, nodes, rows, constraints, internal_forces, digests, notes })
}

/// The columns of the files of loads, one for each load that has a file.
///
/// # Errors
/// What [`load_column`](super::load_column) refuses; [`Error::LoadKeys`].
pub fn load_columns(loads: &[LoadJob], input: &Input) -> Result<Vec<Option<LoadColumn>>> {
    let n_rows = input.n_file_rows();
    let of_load = |load: &LoadJob| match load.pattern()? {
        LoadPattern::File(path, column) => {
            load_column(WantedColumn { path, load: &load.name, column, n_rows }).map(Some)
        }
        LoadPattern::Force(..) | LoadPattern::Rotation(_) => Ok(None),
    };
    loads.iter().map(of_load).collect()
}

/// The modes of the file of a job, where it has one.
///
/// # Errors
/// The errors of [`mode_columns`].
pub fn expansion_columns(
    reduction: &ReductionJob,
    input: &Input,
    allowance: &Allowance,
) -> Result<Option<ModeColumns>> {
    reduction.modes_file().map(|path| mode_columns(path, input.n_file_rows(), allowance)).transpose()
}

/// The further matrices of a job, for rows and columns of K and M as they are in their files.
///
/// # Errors
/// The errors of the readers of matrices; [`Error::MatrixKind`]; [`Error::MatrixRows`]; [`Error::Duplicates`] where the job refuses
/// them.
pub fn further_matrices(job: &Job, input: &Input, allowance: &Allowance) -> Result<Vec<FurtherMatrix>> {
    let n_rows = input.n_file_rows();
    let read = |matrix: &MatrixJob| {
        let (input, _) = take_notes(read_matrix(&further_source(matrix, allowance))?, &mut Vec::new());
        refuse_duplicates(&input, job.model.duplicates)?;
        let n = input.matrix.rows();
        if n != n_rows {
            return Err(Error::MatrixRows { path: input.path, matrix: matrix.name.clone(), found: n, n: n_rows });
        }
        FurtherMatrix::checked(matrix, input)
    };
    job.matrices.iter().map(read).collect()
}

fn further_source<'a>(job: &MatrixJob, allowance: &'a Allowance) -> MatrixSource<'a> {
    let (file, group) = split_group(&job.file);
    MatrixSource { file, group, role: MatrixRole::Further, triangle: None, stated_digits: None, allowance }
}

/// The rows of quantities of a job, where it asks for some.
///
/// # Errors
/// The errors of [`quantity_rows`](super::quantity_rows).
pub fn job_quantities(
    job: Option<&QuantitiesJob>,
    input: &Input,
    allowance: &Allowance,
) -> Result<Option<QuantityRows>> {
    job.map(|job| quantity_rows(job, input.n_file_rows(), allowance)).transpose()
}

/// Starts the HDF5 library. A failure after that is the fault of a file.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub fn start_hdf5() -> Result<()> {
    #[cfg(feature = "hdf5")]
    super::hdf5::start()?;
    Ok(())
}

/// The file of a path that may name a place in it, as `model.h5:/V` does.
pub fn file_of(path: &Path) -> PathBuf {
    split_group(path).0
}

/// Every file of a model with what it is, those that its files refer to among them. Files that cannot be read are listed all the same.
pub fn files(model: &ModelJob) -> Vec<(&'static str, PathBuf)> {
    let mut files = vec![("the stiffness", file_of(&model.stiffness)), ("the mass", file_of(&model.mass))];
    files.extend(model.dofs.clone().map(|path| ("the dof map", path)));
    files.extend(model.constraints.clone().map(|path| ("the constraints", path)));
    files.extend(model.internal_forces.clone().map(|path| ("the internal forces", path)));
    if let Some(nodes) = &model.nodes {
        files.push(("the nodes", nodes.clone()));
        let referenced = formats::of_nodes(nodes).map(|format| format.referenced_files(nodes)).unwrap_or_default();
        files.extend(referenced.into_iter().map(|path| ("the data of the nodes", path)));
    }
    files
}

/// The first file of a job that the HDF5 library reads, where one is.
pub fn hdf5_file(job: &Job) -> Option<PathBuf> {
    let model = &job.model;
    let modes = job.reduction.modes_file().filter(|path| hdf5_format::has_modes(path)).map(file_of);
    let further = job.matrices.iter().map(|matrix| &matrix.file);
    let matrices = [&model.stiffness, &model.mass].into_iter().chain(further).map(|path| file_of(path));
    let matrices = matrices.filter(|file| formats::of_matrix(file).is_ok_and(|format| format.is_parsed_in_c()));
    let nodes = model.nodes.iter().filter(|file| formats::of_nodes(file).is_ok_and(|format| format.is_parsed_in_c()));
    matrices.chain(nodes.cloned()).chain(modes).next()
}

/// Reads the files of a job that need the HDF5 library, those of its model, of its further matrices and of its modes, and discards what was
/// read.
///
/// # Errors
/// A file that cannot be read or whose content is wrong.
pub fn read_hdf5_parts(
    (model, matrices, modes): (&ModelJob, &[MatrixJob], Option<&Path>),
    cells: Cells,
    allowance: &Allowance,
) -> Result<()> {
    modes.map_or(Ok(()), |path| hdf5_format::rehearse_modes(path, allowance))?;
    let further = matrices.iter().map(|matrix| further_source(matrix, allowance));
    for source in further.chain(own_sources(model, allowance)) {
        if formats::of_matrix(&source.file)?.is_parsed_in_c() {
            read_matrix(&source)?;
        }
    }
    let Some(path) = model.nodes.as_deref() else { return Ok(()) };
    let format = formats::of_nodes(path)?;
    if !format.is_parsed_in_c() {
        return Ok(());
    }
    let n_nodes = read_nodes(path, allowance, &mut BTreeMap::new())?.labels.len();
    match cells {
        Cells::Wanted => format.read_faces(path, &Patches { n_nodes, list: Vec::new() }, allowance).map(drop),
        Cells::Unwanted => Ok(()),
    }
}

/// Where K and M are.
fn own_sources<'a>(model: &ModelJob, allowance: &'a Allowance) -> [MatrixSource<'a>; 2] {
    let own = [
        (MatrixRole::Stiffness, &model.stiffness, model.stiffness_digits),
        (MatrixRole::Mass, &model.mass, model.mass_digits),
    ];
    own.map(|(role, path, stated)| {
        let (file, group) = split_group(path);
        // A job states 17 at most.
        let stated_digits = stated.map(|digits| digits as u32);
        MatrixSource { file, group, role, triangle: model.symmetric, stated_digits, allowance }
    })
}

fn read_matrix(source: &MatrixSource<'_>) -> Result<ReadMatrix> {
    unchanged(&source.file, || formats::of_matrix(&source.file)?.read(source))
}

/// Digests by the role of a file.
type Digests = BTreeMap<&'static str, String>;

fn read_nodes(path: &Path, allowance: &Allowance, digests: &mut Digests) -> Result<Nodes> {
    let (nodes, of_data, of_nodes) = unchanged(path, || {
        let (nodes, of_data) = formats::of_nodes(path)?.read(path, allowance)?;
        Ok((nodes, of_data, digest(path)?))
    })?;
    digests.extend(of_data.map(|digest| ("nodes_data", digest)));
    digests.insert("nodes", of_nodes);
    refuse_out_of_range(path, &nodes)?;
    Ok(nodes)
}

fn read_constraints(
    model: &ModelJob,
    n: usize,
    allowance: &Allowance,
    digests: &mut Digests,
) -> Result<Option<ConstraintRows>> {
    let Some(path) = &model.constraints else { return Ok(None) };
    let read = constraint_rows(path, n, allowance)?;
    digests.insert("constraints", read.digest.clone());
    Ok(Some(ConstraintRows { may_ground: model.constraints_to_ground == ConstraintsToGround::Accept, ..read }))
}

/// Refuses coordinates with which moments of inertia, and what is squared of them, would leave the range of double precision.
fn refuse_out_of_range(path: &Path, nodes: &Nodes) -> Result<()> {
    /// Four factors of so many bits leave room for stiffness and mass.
    const BITS: u32 = 160;
    let sizes = nodes
        .coordinates
        .iter()
        .enumerate()
        .flat_map(|(node, point)| (0..3).map(move |axis| (node, axis, point[axis])));
    let Some((node, axis, value)) = sizes.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs())) else { return Ok(()) };
    let range = f64::from(BITS).exp2().recip()..=f64::from(BITS).exp2();
    if value == 0.0 || range.contains(&value.abs()) {
        return Ok(());
    }
    Err(Error::NodeRange { path: path.to_owned(), node: nodes.labels[node], axis, value, bits: BITS })
}

/// Brings K and M to one order, which only a matrix without a size line allows, and notes what each needed.
fn fit_matrices(
    stiffness: ReadMatrix,
    mass: ReadMatrix,
    notes: &mut Vec<InputNote>,
) -> Result<(MatrixInput, MatrixInput)> {
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

fn take_notes(matrix: ReadMatrix, notes: &mut Vec<InputNote>) -> (MatrixInput, OrderSource) {
    let ReadMatrix { input, order, last_line } = matrix;
    if order == OrderSource::LargestIndex {
        notes.push(InputNote::OrderFromIndices { path: input.path.clone(), n: input.matrix.rows() });
    }
    if last_line == LastLine::Open {
        notes.push(InputNote::OpenLastLine { path: input.path.clone() });
    }
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
    notes.push(InputNote::Extended { path: input.path.clone(), from: input.matrix.rows(), to: n });
    let (mut pointers, indices, data) = input.matrix.into_raw_storage();
    pointers.resize(n + 1, indices.len());
    MatrixInput { matrix: SparseMatrix::new((n, n), pointers, indices, data), ..input }
}

fn read_dofs(path: &Path, n: usize, nodes: Option<(&Nodes, &Path)>, notes: &mut Vec<InputNote>) -> Result<DofMap> {
    let read = formats::of_dof_map(path)?.read(path, n)?;
    if read.n_rows != n {
        return Err(Error::DofCount { path: path.to_owned(), found: read.n_rows, n });
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
