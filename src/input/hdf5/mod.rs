//! Sparse matrices and meshes in HDF5 files.
//!
//! The C library is called through a crate that takes one process-wide lock for each call, so that reading from several
//! threads is safe. It is never asked to believe a header: a dataset is read only when its stored bytes can hold what it
//! promises, links that could leave the file are refused, only filters with a bounded expansion are accepted, and numbers
//! are converted here. What remains is the library's own parsing of damaged metadata, which these checks cannot reach:
//! the program therefore lets a child process read HDF5 input first.

mod attribute;
mod attribute_groups;
mod cells;
mod cgns;
mod convention;
mod dataset;
mod exodus;
mod file;
mod group;
mod hmf;
mod layout;
mod med;
mod med_cells;
mod med_groups;
mod mesh;
mod moab;
mod moab_cells;
mod moab_sets;
mod modes;
mod nastran;
mod nastran_records;
mod nodes;
mod numbers;
mod other_types;
mod patch_cells;
mod search;
mod sparse;
mod vtkhdf;
mod xdmf;
mod xdmf_attributes;
mod xdmf_cells;
mod xdmf_reference;

pub(crate) use file::start;
pub(in crate::input) use modes::feminterface_modes;
pub(crate) use modes::{mode_columns, rehearse_dataset, rehearse_feminterface};
pub use nodes::read_nodes;
pub(crate) use nodes::{data_digest, read_nodes_within, referenced_files};
pub(in crate::input) use patch_cells::read_cells;
pub(crate) use patch_cells::read_faces;
pub use sparse::read_matrix;
pub(crate) use sparse::read_matrix_within;
pub(crate) use vtkhdf::{GROUP_NAME, LABELS, MESH_OF_SUPEL};
