//! What every format of matrices, nodes and dof maps offers, and what reading gives.

use std::path::{Path, PathBuf};

use super::blocks::LastLine;
use super::faces::CellList;
use super::file_start::FileStart;
use super::node_frames::NodeFrames;
use super::patch::{PatchFaces, Patches};
use super::row_label::RowLabel;
use super::{Allowance, MatrixInput, MatrixRole};
use crate::dofs::{DofMap, Nodes};
use crate::error::Result;
use crate::job::Layout;
use crate::sparse::Triangle;

/// How sure a format is that a file is one of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Sureness {
    /// Something speaks against it.
    Unlikely,
    /// Nothing speaks against it.
    Possible,
    /// The name says so.
    Named,
    /// The content says so.
    Certain,
}

/// What the formats of all kinds of files have in common.
pub(super) trait Format {
    /// How sure the format is that a file is one of its own.
    fn sureness(&self, start: &FileStart<'_>) -> Sureness;

    /// Whether a library in C parses it, which a damaged file may crash: then a child process reads the file first.
    fn is_parsed_in_c(&self) -> bool {
        false
    }
}

/// A matrix that is to be read.
pub(super) struct MatrixSource<'a> {
    pub(super) file: PathBuf,
    /// The matrix in the file that the job names, by the path of its group where the file is HDF5.
    pub(super) member: Option<String>,
    /// The format that the job names.
    pub(super) layout: Option<Layout>,
    pub(super) role: MatrixRole,
    /// The triangle that the job asks for.
    pub(super) triangle: Option<Triangle>,
    /// Significant digits that the job states.
    pub(super) stated_digits: Option<u32>,
    pub(super) allowance: &'a Allowance,
}

/// A format of matrices.
pub(super) trait MatrixFormat: Format {
    /// Its name.
    fn layout(&self) -> Layout;

    /// Whether a file may hold several matrices, or names the one that it holds.
    fn has_members(&self) -> bool {
        false
    }

    /// # Errors
    /// A file that cannot be read or whose content is wrong, more data than the allowance has room for.
    fn read(&self, source: &MatrixSource<'_>) -> Result<ReadMatrix>;
}

/// A format of nodes.
pub(super) trait NodeFormat: Format {
    /// # Errors
    /// A file that cannot be read or whose content is wrong, more data than `allowance` has room for.
    fn read(&self, path: &Path, allowance: &Allowance) -> Result<ReadNodes>;

    /// Files that a file refers to, where they can be told.
    fn referenced_files(&self, _path: &Path) -> Vec<PathBuf> {
        Vec::new()
    }

    /// BLAKE3 of the files that a file refers to now, as a reading records it in [`ReadNodes::data_digest`].
    ///
    /// # Errors
    /// A file that cannot be read.
    fn data_digest(&self, _path: &Path) -> Result<Option<String>> {
        Ok(None)
    }

    /// Whether a file of it may have cells.
    fn has_cells(&self) -> bool {
        false
    }

    /// All cells of the file; `coordinates` are those of its nodes.
    ///
    /// # Errors
    /// The errors of [`NodeFormat::read_faces`].
    fn read_cells(&self, _path: &Path, _coordinates: &[[f64; 3]], _allowance: &Allowance) -> Result<ReadCells> {
        Ok(ReadCells::default())
    }

    /// The faces of patches, from the cells of the file.
    ///
    /// # Errors
    /// Cells that cannot be those of the nodes, a file that cannot be read, more data than `allowance` has room for.
    fn read_faces(&self, _path: &Path, _patches: &Patches, _allowance: &Allowance) -> Result<Vec<PatchFaces>> {
        Ok(Vec::new())
    }
}

/// Nodes as their format left them.
pub(super) struct ReadNodes {
    /// Label, position and groups of each.
    pub(super) nodes: Nodes,
    /// BLAKE3 of the files that this one refers to, where it does.
    pub(super) data_digest: Option<String>,
    /// The axes of nodes that have their own, as the deck says.
    pub(super) frames: Option<NodeFrames>,
    /// The axes that rows are along whoever writes the matrices, as the deck says.
    pub(super) along_frames: Option<NodeFrames>,
}

/// Cells as their format left them.
#[derive(Default)]
pub(super) struct ReadCells {
    pub(super) cells: CellList,
    /// What the mesh has that is not read, in words; then the cells are not all of them.
    pub(super) unread: Option<String>,
}

impl ReadNodes {
    /// Nodes of a format that knows no axes of nodes.
    pub(super) fn along_the_axes(nodes: Nodes, data_digest: Option<String>) -> Self {
        Self { nodes, data_digest, frames: None, along_frames: None }
    }
}

/// A format of dof maps.
pub(super) trait DofMapFormat: Format {
    /// The map of a model of n dofs. More rows than n are counted, not kept. Rows may repeat a label, as CalculiX writes for nodes that it
    /// made.
    ///
    /// # Errors
    /// A file that cannot be read or whose content is wrong, more data than `allowance` has room for.
    fn read(&self, path: &Path, n: usize, allowance: &Allowance) -> Result<ReadDofs>;
}

/// A matrix as its format left it.
pub(super) struct ReadMatrix {
    /// The matrix.
    pub(super) input: MatrixInput,
    /// Where its order comes from.
    pub(super) order: OrderSource,
    /// Whether the last line is complete.
    pub(super) last_line: LastLine,
    /// What each row is, ascending, where the matrix itself says so.
    pub(super) labels: Option<Vec<RowLabel>>,
    /// The axes that the deck of the matrix states its nodes to have, which its rows are along; an error where it does not tell all of them.
    pub(super) frames: Result<Option<NodeFrames>>,
}

impl ReadMatrix {
    /// A matrix of a format that states its size.
    pub(super) fn with_size(input: MatrixInput) -> Self {
        Self { input, order: OrderSource::SizeLine, last_line: LastLine::Terminated, labels: None, frames: Ok(None) }
    }
}

/// Where the order of a matrix comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OrderSource {
    /// The size line.
    SizeLine,
    /// The largest index.
    LargestIndex,
    /// The labels of its rows.
    Labels,
}

/// A dof map and how its directions were numbered.
pub(super) struct ReadDofs {
    /// The degree of freedom of every row, as far as the matrices have rows.
    pub(super) dofs: DofMap,
    /// Rows in the file.
    pub(super) n_rows: usize,
    /// How directions are numbered.
    pub(super) base: DirectionBase,
    /// The axes of nodes along which their rows are, where these are their own; an error where the file does not tell all of them.
    pub(super) frames: Result<Option<NodeFrames>>,
    /// Labels of rows that no node has, where the file has them.
    pub(super) scalars: Vec<(usize, RowLabel)>,
}

impl ReadDofs {
    /// A map whose directions count from one, without scalar dofs that have a label.
    pub(super) fn new(dofs: DofMap, n_rows: usize) -> Self {
        Self { dofs, n_rows, base: DirectionBase::One, frames: Ok(None), scalars: Vec::new() }
    }
}

/// The number of the direction ux.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DirectionBase {
    /// Directions count from 0.
    Zero,
    /// Directions count from 1, or have names.
    One,
}
