//! Meshes of VTK: the old text and binary files (`.vtk`) and XML (`.vtu`).
//!
//! VTK has no sets. Whole numbers at points and cells become groups, see [`crate::input::tag_groups`].

mod cell_type;
mod encoded;
mod legacy;
mod pieces;
mod xml;

pub(super) use legacy::{read as read_legacy, sureness as legacy_sureness};
#[cfg(feature = "hdf5")]
pub(in crate::input) use pieces::{Piece, Pieces, Tags};
pub(super) use xml::{read as read_xml, sureness as xml_sureness};
