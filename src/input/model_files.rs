//! The files of a finite element model: which there are, what they hold, and whether it fits together.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::allowance::Allowance;
use super::common_rows::{RowLabels, ends_early, fit_matrices, take_notes};
use super::constraint_file::{ConstraintRows, constraint_rows};
use super::format::{MatrixSource, OrderSource, ReadMatrix};
use super::further_matrix::FurtherMatrix;
use super::hdf5_format;
use super::internal_forces::{on_rows, read_internal_forces};
use super::load_file::{LoadColumn, WantedColumn, WantedColumns, columns_of_file};
use super::map_and_nodes::{Digests, MapAndNodes, dof_map_for_labels, map_and_nodes, nodes};
use super::member::split_member;
use super::mesh_cells::{MeshCells, mesh_cells};
use super::modes_file::{ModeColumns, mode_columns};
use super::nastran_frames::grid_frames;
use super::node_frames::NodeFrames;
use super::quantity_files::{QuantityRows, quantity_rows};
use super::superelement_file::refuse_other;
use super::turned_rows::{turned, turning};
use super::{InputNote, MatrixInput, MatrixRole, deck_axes, empty_rows, formats, unit_mass};
use crate::dofs::{DofMap, FileRows, Nodes, RoundedAxes};
use crate::error::{Error, Result, Unnamed};
use crate::job::{
    ConstraintsToGround, Duplicates, Job, Layout, LoadJob, LoadPattern, MatrixJob, ModelJob, QuantitiesJob,
    ReductionJob,
};
use crate::regular_file::unchanged;
use crate::sparse::{Mirrored, Triangle, Turning};

/// A finite element model as it was read: matrices of one size, a dof map that fits them, nodes that fit the map.
#[derive(Clone, Debug)]
pub struct Input {
    /// K.
    pub stiffness: MatrixInput,
    /// M.
    pub mass: MatrixInput,
    /// What each row stands for; absent where the job names neither a dof map nor nodes.
    pub dofs: Option<DofMap>,
    /// What each row of the files is called by matrices that name their rows.
    pub labels: RowLabels,
    /// Nodes; absent where the job names none.
    pub nodes: Option<Nodes>,
    /// The cells of the mesh that has the nodes, by their indices; none where it has none.
    pub cells: Vec<MeshCells>,
    /// Which rows of the files are left.
    pub rows: FileRows,
    /// Rows of the files that were along axes of their own; absent where all were along those of the model.
    pub turning: Option<Turning>,
    /// Axes of nodes that look rounded, where there are some.
    pub axes: Option<RoundedAxes>,
    /// Multipoint constraints on the rows that are left; absent where the job names none.
    pub constraints: Option<ConstraintRows>,
    /// Internal forces of a preloaded state, one for each row that is left, in the units of the file; absent where the job names none.
    pub internal_forces: Option<Vec<f64>>,
    /// BLAKE3 digests of the files of the dof map (`dofs`), of what CalculiX wrote next to it (`dofs_data`), of the nodes (`nodes`), of what those refer to (`nodes_data`), of the
    /// constraints (`constraints`), of the axes of nodes (`frames`) and of the internal forces (`internal_forces`), lower-case hexadecimal.
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
    let OwnMatrices { mut stiffness, mass, labels, frames } = own_matrices(model, allowance, &mut notes)?;
    let n = stiffness.matrix.rows();
    let mut digests = BTreeMap::new();
    let named = labels.as_ref().map(|labels| (model.stiffness.as_path(), labels.dof_map().unwrap_or_default()));
    let MapAndNodes { mut dofs, nodes, cells, mut said } =
        map_and_nodes(model, (n, named), allowance, (&mut digests, &mut notes))?;
    said.by_decks.extend(frames);
    let layouts = [stiffness.layout, mass.as_ref().and_then(|mass| mass.layout)];
    let turning = turning(model, (dofs.as_ref(), layouts), said, allowance, (&mut digests, &mut notes))?;
    let (turning, axes) = turning.unzip();
    let turning = turning.as_ref();
    stiffness = turned(stiffness, turning);
    let labels = labels.unwrap_or_else(|| dofs.as_ref().map_or_else(RowLabels::default, RowLabels::of_map));
    let mass = mass.map(|mass| turned(mass, turning));
    let mut mass = mass.unwrap_or_else(|| unit_mass::of(&stiffness.matrix, dofs.as_deref()));
    let constraints = read_constraints(model, n, allowance, &mut digests)?.map(|rows| turned(rows, turning));
    let forces = read_internal_forces(model, n, allowance, &mut digests)?.map(|forces| turned(forces, turning));
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
    refuse_other_superelements(model, (&stiffness, &mass), &digests)?;
    let (turning, axes) = (turning.cloned(), axes.flatten());
    Ok(Input {
        stiffness,
        mass,
        dofs,
        labels,
        nodes,
        cells,
        rows,
        turning,
        axes,
        constraints,
        internal_forces,
        digests,
        notes,
    })
}

fn refuse_other_superelements(
    model: &ModelJob,
    (stiffness, mass): (&MatrixInput, &MatrixInput),
    digests: &Digests,
) -> Result<()> {
    let of_mass = model.mass.as_deref().map(|path| ("the mass", path, mass.digest.as_str()));
    let digest = |role: &str| digests.get(role).map_or("", String::as_str);
    let of_dofs = model.dofs.as_deref().map(|path| ("the dof map", path, digest("dofs")));
    let of_nodes = model.nodes.as_deref().map(|path| ("the nodes", path, digest("nodes")));
    let mut parts = [of_mass, of_dofs, of_nodes].into_iter().flatten();
    parts.try_for_each(|(what, path, digest)| refuse_other(stiffness, what, (path, digest)))
}

/// The columns of the files of loads, one for each load that has a file.
///
/// # Errors
/// What [`columns_of_file`] refuses; [`Error::LoadKeys`]; [`Error::LoadOfCondensed`].
pub fn load_columns(loads: &[LoadJob], input: &Input, allowance: &Allowance) -> Result<Vec<Option<LoadColumn>>> {
    let n_rows = input.n_file_rows();
    // Every file once, however many loads it has.
    let mut files: BTreeMap<&Path, Vec<(usize, WantedColumn<'_>)>> = BTreeMap::new();
    for (at, load) in loads.iter().enumerate() {
        match load.pattern()? {
            LoadPattern::File(path, column) => {
                files.entry(path).or_default().push((at, WantedColumn { load: &load.name, column }));
            }
            LoadPattern::Rotation(_) if input.mass.layout == Some(Layout::Superelement) => {
                return Err(Error::LoadOfCondensed { load: load.name.clone(), path: input.mass.path.clone() });
            }
            _ => {}
        }
    }
    let mut columns = vec![None; loads.len()];
    for (path, wanted) in files {
        let (places, wanted): (Vec<usize>, Vec<WantedColumn<'_>>) = wanted.into_iter().unzip();
        let read = columns_of_file(WantedColumns { path, columns: &wanted, n_rows }, allowance)?;
        for (at, column) in places.into_iter().zip(read) {
            refuse_other(&input.stiffness, "a load", (path, &column.digest))?;
            columns[at] = Some(turned(column, input.turning.as_ref()));
        }
    }
    Ok(columns)
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
    let read = |path| mode_columns(path, input.n_file_rows(), allowance);
    let columns = reduction.modes_file().map(read).transpose()?;
    Ok(columns.map(|columns| turned(columns, input.turning.as_ref())))
}

/// The further matrices of a job, for rows and columns of K and M as they are in their files.
///
/// # Errors
/// The errors of the readers of matrices; [`Error::MatrixKind`]; [`Error::MatrixRows`]; [`Error::Duplicates`] where the job refuses
/// them.
pub fn further_matrices(job: &Job, input: &Input, allowance: &Allowance) -> Result<Vec<FurtherMatrix>> {
    let (n_rows, stiffness) = (input.n_file_rows(), &input.stiffness);
    let read = |matrix: &MatrixJob| {
        let mut read = read_matrix(&further_source(matrix, allowance))?;
        if job.model.frames.is_none() {
            check_axes(std::mem::replace(&mut read.frames, Ok(None))?, input)?;
        }
        let (read, _) = take_notes(input.labels.placed(read)?, &mut Vec::new());
        refuse_duplicates(&read, job.model.duplicates)?;
        let n = read.matrix.rows();
        if n != n_rows {
            return Err(Error::MatrixRows { path: read.path, matrix: matrix.name.clone(), found: n, n: n_rows });
        }
        refuse_other(stiffness, "a further matrix", (&read.path, &read.digest))?;
        Ok(turned(FurtherMatrix::checked(matrix, read)?, input.turning.as_ref()))
    };
    job.matrices.iter().map(read).collect()
}

/// Refuses a deck that states other axes of a node than its rows were turned by.
///
/// # Errors
/// [`Error::FrameDiffer`].
fn check_axes(of_deck: Option<NodeFrames>, input: &Input) -> Result<()> {
    let Some((of_deck, dofs)) = of_deck.zip(input.labels.dof_map()) else { return Ok(()) };
    deck_axes::of_model(&input.stiffness.path, &dofs, input.turning.as_ref()).check_agree(&of_deck)
}

pub(super) fn further_source<'a>(job: &MatrixJob, allowance: &'a Allowance) -> MatrixSource<'a> {
    let ((file, member), layout) = (split_member(&job.file), job.layout);
    MatrixSource { file, member, layout, role: MatrixRole::Further, triangle: None, stated_digits: None, allowance }
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
    let rows = job.map(|job| quantity_rows(job, input.n_file_rows(), allowance)).transpose()?;
    Ok(rows.map(|rows| turned(rows, input.turning.as_ref())))
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

/// Reads the files of a job that need the HDF5 library, those of its model, of its further matrices and of modes, and discards what was
/// read.
///
/// # Errors
/// A file that cannot be read or whose content is wrong.
pub fn read_hdf5_parts(
    (model, matrices, modes): (Option<&ModelJob>, &[MatrixJob], &[PathBuf]),
    allowance: &Allowance,
) -> Result<()> {
    modes.iter().try_for_each(|path| hdf5_format::rehearse_modes(path, allowance))?;
    let further = matrices.iter().map(|matrix| further_source(matrix, allowance));
    let own = model.into_iter().flat_map(|model| {
        let (stiffness, mass) = own_sources(model, allowance);
        std::iter::once(stiffness).chain(mass)
    });
    for source in further.chain(own) {
        if formats::of_matrix(&source)?.is_parsed_in_c() {
            read_matrix(&source)?;
        }
    }
    let Some(path) = model.and_then(|model| model.nodes.as_deref()) else { return Ok(()) };
    let format = formats::of_nodes(path)?;
    if !format.is_parsed_in_c() {
        return Ok(());
    }
    mesh_cells((path, &nodes(path, allowance)?), allowance, &mut Vec::new()).map(drop)
}

/// Where K and M are; M may not be needed.
pub(super) fn own_sources<'a>(
    model: &ModelJob,
    allowance: &'a Allowance,
) -> (MatrixSource<'a>, Option<MatrixSource<'a>>) {
    let source = |role, path, stated: Option<usize>| {
        let (file, member) = split_member(path);
        // A job states 17 at most.
        let stated_digits = stated.map(|digits| digits as u32);
        MatrixSource { file, member, layout: model.layout, role, triangle: model.symmetric, stated_digits, allowance }
    };
    let mass = model.mass.as_ref().map(|path| source(MatrixRole::Mass, path, model.mass_digits));
    (source(MatrixRole::Stiffness, &model.stiffness, model.stiffness_digits), mass)
}

pub(super) fn read_matrix(source: &MatrixSource<'_>) -> Result<ReadMatrix> {
    unchanged(&source.file, || {
        let format = formats::of_matrix(source)?;
        match &source.member {
            Some(name) if !format.has_members() => {
                Err(Error::MatrixName { path: source.file.clone(), name: name.clone(), holds: Vec::new() })
            }
            _ => {
                let mut read = format.read(source)?;
                read.input.layout = Some(format.layout());
                if format.layout() == Layout::Dmig && source.role != MatrixRole::Conversion {
                    read.frames = grid_frames(&source.file);
                }
                Ok(read)
            }
        }
    })
}

/// K and M as their files have them, on common rows.
struct OwnMatrices {
    stiffness: MatrixInput,
    /// None where the job does without.
    mass: Option<MatrixInput>,
    /// The rows that they name, in the order of the map where there is one; none where they name none.
    labels: Option<RowLabels>,
    /// What their decks state of the axes of nodes.
    frames: Vec<Result<Option<NodeFrames>>>,
}

/// K and M, of one size and without what the job refuses. Rows that they name are put in the order of the map, where there is one.
fn own_matrices(model: &ModelJob, allowance: &Allowance, notes: &mut Vec<InputNote>) -> Result<OwnMatrices> {
    let (stiffness, mass) = own_sources(model, allowance);
    let (stiffness, mass) = rayon::join(|| read_matrix(&stiffness), || mass.as_ref().map(read_matrix).transpose());
    let (mut stiffness, mut mass) = (stiffness?, mass?);
    let of_deck = |matrix: &mut ReadMatrix| std::mem::replace(&mut matrix.frames, Ok(None));
    let frames = std::iter::once(&mut stiffness).chain(&mut mass).map(of_deck).collect();
    let matrices: Vec<&ReadMatrix> = std::iter::once(&stiffness).chain(&mass).collect();
    let is_labelled = matrices.iter().any(|matrix| matrix.labels.is_some());
    let map =
        model.dofs.as_deref().filter(|_| is_labelled).map(|path| dof_map_for_labels(path, allowance)).transpose()?;
    let labels = RowLabels::common(&matrices, (map.map(|(_, labels)| labels), Unnamed::Model))?;
    let stiffness = labels.placed(stiffness)?;
    let (mut stiffness, mut mass) = match mass {
        Some(mass) => {
            let mass = labels.placed(mass)?;
            // A mass that the job expects is compared, whatever its file looks like.
            let is_expected = model.expect.as_ref().is_some_and(|expect| expect.mass.is_some());
            let may_end_early = mass.order != OrderSource::SizeLine && !is_expected;
            let (stiffness, mass) = fit_matrices(stiffness, mass, notes)?;
            notes.extend(may_end_early.then(|| ends_early(&stiffness.matrix, &mass)).flatten());
            (stiffness, Some(mass))
        }
        None => (take_notes(stiffness, notes).0, None),
    };
    for matrix in std::iter::once(&mut stiffness).chain(&mut mass) {
        refuse_duplicates(matrix, model.duplicates)?;
        notes.extend(model.symmetric.and_then(|triangle| take_triangle(matrix, triangle)));
        notes.extend(last_row_empty(matrix).filter(|_| !is_labelled));
    }
    Ok(OwnMatrices { stiffness, mass, labels: is_labelled.then_some(labels), frames })
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

pub(super) fn refuse_duplicates(matrix: &MatrixInput, duplicates: Duplicates) -> Result<()> {
    match (duplicates, matrix.notes.n_duplicates) {
        (Duplicates::Refuse, count @ 1..) => Err(Error::Duplicates { path: matrix.path.clone(), count }),
        _ => Ok(()),
    }
}

/// Replaces the other triangle by the mirror image of this one.
fn take_triangle(matrix: &mut MatrixInput, triangle: Triangle) -> Option<InputNote> {
    let Mirrored { matrix: mirrored, n_differing, n_once } = triangle.mirrored(&matrix.matrix);
    matrix.matrix = mirrored;
    let path = matrix.path.clone();
    (n_differing + n_once > 0).then_some(InputNote::TriangleTaken { path, triangle, n_differing, n_once })
}

/// An empty last row where no other row is empty: what indices from zero leave in a matrix that reads as if from one.
fn last_row_empty(matrix: &MatrixInput) -> Option<InputNote> {
    let n = matrix.matrix.rows();
    let mut empty = (0..n).filter(|row| matrix.matrix.outer_view(*row).is_none_or(|view| view.nnz() == 0));
    let is_last = n > 1 && empty.next() == Some(n - 1);
    is_last.then(|| InputNote::LastRowEmpty { path: matrix.path.clone(), n })
}
