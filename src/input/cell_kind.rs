//! What formats call a kind of cell, and whether all kinds of a mesh are known.

use super::faces::{Cell, Shape};

/// What a format calls a kind of cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// One with faces.
    Faced(Cell),
    /// Points and lines, which have none.
    Faceless,
    /// Anything else.
    Unknown,
}

/// Whether all cells of a mesh are of kinds that are known.
#[cfg(feature = "hdf5")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Known {
    All,
    /// What the mesh has that is not read, in words.
    Not(String),
}

/// The kind of a shape with so many nodes.
pub(super) fn kind(shape: Shape, n_nodes: usize) -> Kind {
    Cell::new(shape, n_nodes).map_or(Kind::Unknown, Kind::Faced)
}
