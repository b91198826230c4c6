//! Reading: matrices, dof maps and nodes as finite element programs export them.
//!
//! A reader never guesses silently. Whatever it did beyond copying becomes a note in the report.

mod abaqus_labels;
mod allowance;
mod ansys_mapping;
mod archive;
mod assembled;
mod banner;
mod blocks;
mod bulk_cards;
mod bulk_lines;
mod bulk_start;
mod calculix;
mod cell_kind;
mod common_rows;
mod compressed;
pub(crate) mod condensed_digits;
mod constraint_file;
pub(crate) mod decimal;
mod deck_axes;
mod digits;
mod dmig;
mod dof_map;
mod empty_rows;
mod entries;
mod exact;
mod face_areas;
mod face_shapes;
mod faces;
mod facts;
mod file_start;
mod foreign_modes;
mod format;
mod formats;
mod fortran;
mod fortran_format;
mod frd_modes;
mod further_matrix;
mod gathering;
mod gzip;
mod half_precision;
mod harwell_boeing;
#[cfg(feature = "hdf5")]
pub mod hdf5;
mod hdf5_format;
mod in_line;
mod inclusion;
mod indices;
mod internal_forces;
mod labels;
mod lines;
mod load_file;
mod local_system;
mod map_and_nodes;
mod market_array;
mod matlab5;
mod matrix_market;
mod member;
mod mesh;
mod mesh_cells;
mod mesh_input;
mod mode_format;
mod mode_formats;
mod mode_matrix;
mod mode_rounding;
mod mode_rows;
mod mode_values;
mod model_files;
mod modes_file;
mod named;
mod named_files;
mod nastran_frames;
mod nastran_nodes;
mod nastran_rows;
mod node_frames;
mod node_table;
mod note;
mod npy;
mod npy_header;
mod npy_matrix;
mod npy_series;
mod npz;
mod numpy_array;
mod op4;
mod outer_faces;
mod patch;
mod patch_faces;
mod quantity_files;
mod raw_numbers;
mod recorded;
mod rectangular;
mod reduced_pair;
mod row_label;
mod single_matrix;
mod single_precision;
mod source;
mod state_table;
pub(crate) mod strainless;
pub(crate) mod superelement_file;
mod table;
mod tag_groups;
mod turned_rows;
mod unit_mass;
mod unsupported_format;
mod user_element;
mod value_unit;
mod written;
mod xml_size;
mod zstd;

pub use allowance::Allowance;
pub use bulk_lines::digest_with_included;
pub use common_rows::RowLabels;
pub use constraint_file::{Constraint, ConstraintRows};
pub use digits::{Digits, DigitsBy, digits_of};
pub use face_areas::area_vectors;
pub use facts::{InputFacts, MatrixFacts};
pub use foreign_modes::{ForeignModes, Orientation, foreign_modes};
pub use further_matrix::FurtherMatrix;
pub use load_file::{LoadColumn, WantedColumn, WantedColumns, columns_of_file};
pub use map_and_nodes::nodes;
pub use mesh_cells::MeshCells;
pub use mesh_input::{MeshInput, VtkCells};
pub use mode_rounding::ModeRounding;
pub use mode_rows::ModeRows;
pub use mode_values::{ModeValues, ValueSource};
pub use model_files::{
    Input, expansion_columns, further_matrices, job_quantities, load_columns, read, read_hdf5_parts, read_within,
    start_hdf5,
};
pub use modes_file::{ModeColumns, mode_columns};
pub use named_files::{bytes_of_matrices, file_of, files, hdf5_file};
pub use note::InputNote;
pub use outer_faces::outer_faces;
pub use patch::{Face, Faces, Patch, PatchFaces, Patches};
pub use patch_faces::{looks_at_faces, patch_faces};
pub use quantity_files::{QuantityRows, quantity_rows};
pub use recorded::changed_role;
pub use reduced_pair::ReducedPair;
pub use single_matrix::{ReadSingle, SingleMatrix};
pub use state_table::{StateRow, StateTable};
pub use superelement_file::{is_superelement, refuse_unsaid, superelement};
pub use value_unit::ValueUnit;

use std::path::PathBuf;

use crate::job::Layout;
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
    /// The format that the file is in; none of a matrix that is from no file.
    pub layout: Option<Layout>,
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
    /// A matrix that is written in another format as it is.
    Conversion,
    /// A reduced matrix of another program, whose symmetry is measured.
    Reduced,
}

impl MatrixRole {
    /// What messages call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stiffness => "stiffness",
            Self::Mass => "mass",
            Self::Further => "further matrix",
            Self::Conversion => "which one is meant",
            Self::Reduced => "reduced matrix",
        }
    }
}
