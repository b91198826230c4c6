//! Reading: matrices, dof maps and nodes as finite element programs export them.
//!
//! A reader never guesses silently. Whatever it did beyond copying becomes a note in the report.

mod allowance;
mod banner;
mod blocks;
mod constraint_file;
mod decimal;
mod digits;
mod dof_map;
mod empty_rows;
mod entries;
mod exact;
mod facts;
mod file_start;
mod format;
mod formats;
mod further_matrix;
mod gathering;
#[cfg(feature = "hdf5")]
pub mod hdf5;
mod hdf5_format;
mod internal_forces;
mod load_file;
mod matrix_market;
mod mode_matrix;
mod model_files;
mod modes_file;
mod node_table;
mod note;
mod npy;
mod patch;
mod patch_faces;
mod quantity_files;
mod rectangular;
mod single_precision;
mod source;
mod state_table;
mod table;
mod unsupported_format;
mod written;

pub use allowance::Allowance;
pub use constraint_file::{Constraint, ConstraintRows};
pub use digits::{Digits, DigitsBy, digits_of};
pub use facts::{InputFacts, MatrixFacts};
pub use further_matrix::FurtherMatrix;
pub use load_file::{LoadColumn, WantedColumn, load_column};
pub use model_files::{
    Input, expansion_columns, file_of, files, further_matrices, hdf5_file, job_quantities, load_columns, read,
    read_hdf5_parts, read_within, start_hdf5,
};
pub use modes_file::{ModeColumns, mode_columns};
pub use note::InputNote;
pub use patch::{Faces, Patch, PatchFaces, Patches};
pub use patch_faces::{Cells, looks_at_faces, patch_faces};
pub use quantity_files::{QuantityRows, quantity_rows};
pub use state_table::{StateRow, StateTable};

use std::path::PathBuf;

use crate::sparse::{AssemblyNotes, SparseMatrix};

/// A square matrix as it was read.
#[derive(Clone, Debug)]
pub struct MatrixInput {
    /// The matrix, both triangles stored.
    pub matrix: SparseMatrix,
    /// What assembling it needed.
    pub notes: AssemblyNotes,
    /// How many digits or decimals the values carry.
    pub digits: Digits,
    /// The file.
    pub path: PathBuf,
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

/// What a matrix is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatrixRole {
    /// The stiffness matrix K.
    Stiffness,
    /// The mass matrix M.
    Mass,
    /// A further matrix, which may be neither symmetric nor skew.
    Further,
}

impl MatrixRole {
    /// What messages call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stiffness => "stiffness",
            Self::Mass => "mass",
            Self::Further => "further matrix",
        }
    }
}
