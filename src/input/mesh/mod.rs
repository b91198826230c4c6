//! Meshes in files that are read from beginning to end: decks, text and simple binary formats.
//!
//! A format has one function from a file to a [`cell_mesh::CellMesh`]. What all of them share is here: labels and their indices, groups, and the
//! faces of patches.

mod cell_mesh;
pub(super) mod deck;
pub(super) mod frd;
mod gmsh;
mod groups;
mod labels;
mod mesh_file;
pub(super) mod stream;
pub(super) mod vtk;

pub(super) use cell_mesh::CellMesh;
#[cfg(feature = "hdf5")]
pub(super) use cell_mesh::named_apart;
pub(super) use gmsh::begins as begins_as_gmsh;
pub(super) use mesh_file::{DECK, FRD, GMSH, VTK, VTU};
