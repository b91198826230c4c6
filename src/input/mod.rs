//! Reading: matrices, dof maps and nodes as finite element programs export them.
//!
//! Nothing is guessed silently: whatever a reader had to do beyond copying is a note that reaches the report.

mod allowance;
mod banner;
mod blocks;
mod digits;
mod dof_map;
mod empty_rows;
mod entries;
mod file_rows;
mod foreign;
mod gathering;
#[cfg(feature = "hdf5")]
pub mod hdf5;
mod kind;
mod matrix_market;
mod model_files;
mod node_table;
mod note;
mod patch;
pub(crate) mod regular;
mod source;
mod table;
mod triangle;

pub use allowance::Allowance;
pub use digits::significant_digits;
pub use file_rows::{FileRows, RowNames};
pub use kind::{files, hdf5_file};
pub use model_files::{Input, read, read_hdf5_parts, read_within, start_hdf5};
pub use note::InputNote;
pub use patch::{Cells, Patch, PatchFaces, Patches, has_mean_origin, patch_faces};
pub use triangle::Triangle;

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::sparse::{AssemblyNotes, SparseMatrix};

/// A square matrix as it was read.
#[derive(Clone, Debug)]
pub struct MatrixInput {
    /// The matrix, both triangles stored.
    pub matrix: SparseMatrix,
    /// What assembling it needed.
    pub notes: AssemblyNotes,
    /// Significant decimal digits the values carry: 17 for binary data, fewer where every sampled value is a short
    /// decimal fraction.
    pub digits: u32,
    /// The file.
    pub path: PathBuf,
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

/// The direction of a degree of freedom, in the order of the classical six.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Translation along x.
    Ux,
    /// Translation along y.
    Uy,
    /// Translation along z.
    Uz,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}

impl Direction {
    /// All six, in order.
    pub const ALL: [Self; 6] = [Self::Ux, Self::Uy, Self::Uz, Self::Rx, Self::Ry, Self::Rz];

    /// The axis 0, 1 or 2.
    pub fn axis(self) -> usize {
        self as usize % 3
    }

    /// True for a rotation.
    pub fn is_rotation(self) -> bool {
        self as usize >= 3
    }
}

impl std::fmt::Display for Direction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(["ux", "uy", "uz", "rx", "ry", "rz"][*self as usize])
    }
}

/// A degree of freedom of the finite element model: what one row of K and M stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dof {
    /// Label of the node, as the finite element program numbers it.
    pub node: i64,
    /// Direction at the node.
    pub direction: Direction,
}

impl std::fmt::Display for Dof {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "node {} {}", self.node, self.direction)
    }
}

/// The degree of freedom of every row, in row order.
pub type DofMap = Vec<Dof>;

/// Nodes with their labels, coordinates and named groups.
#[derive(Clone, Debug, Default)]
pub struct Nodes {
    /// Label of each node.
    pub labels: Vec<i64>,
    /// Position of each node.
    pub coordinates: Vec<[f64; 3]>,
    /// Named groups, each a list of indices into `labels`.
    pub groups: BTreeMap<String, Vec<usize>>,
}
