//! What a reader did beyond copying, for the user.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::dofs::Dof;
use crate::number::counted;
use crate::sparse::Triangle;

/// A remark on the input that is not an error. Its text is one line for the report.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum InputNote {
    /// Entries of one position were added.
    Duplicates {
        /// The file of the matrix.
        path: PathBuf,
        /// Entries that repeated an earlier position.
        count: usize,
    },
    /// One triangle was given without the declaration that it stands for both.
    Mirrored {
        /// The file of the matrix.
        path: PathBuf,
    },
    /// One triangle was taken for both on request, and the other differed.
    TriangleTaken {
        /// The file of the matrix.
        path: PathBuf,
        /// The triangle that holds.
        triangle: Triangle,
        /// Positions of the other triangle that held something else.
        n_differing: usize,
    },
    /// Rows without stiffness and mass were dropped on request.
    EmptyRowsDropped {
        /// How many.
        count: usize,
        /// The first, from 1.
        row: usize,
        /// What it stands for, where known.
        dof: Option<Dof>,
    },
    /// The last row of a matrix, and no other, is empty: its indices may count from zero.
    LastRowEmpty {
        /// The file of the matrix.
        path: PathBuf,
        /// The order, which is the row.
        n: usize,
    },
    /// A file without a size line: its order is the largest index.
    OrderFromIndices {
        /// The file of the matrix.
        path: PathBuf,
        /// The order.
        n: usize,
    },
    /// A matrix without a size line was filled up with empty rows to the order of the other.
    Extended {
        /// The file of the matrix.
        path: PathBuf,
        /// Its largest index.
        from: usize,
        /// The order of the other matrix.
        to: usize,
    },
    /// The last line has no line end, the usual sign of a file cut short.
    OpenLastLine {
        /// The file.
        path: PathBuf,
    },
    /// Directions of the dof map count from zero.
    DirectionsFromZero {
        /// The file of the dof map.
        path: PathBuf,
    },
    /// Without a dof map, rows were taken node by node.
    DefaultOrder {
        /// Directions at each node, three or six.
        dofs_per_node: usize,
        /// The file of the nodes, whose order was used.
        nodes: PathBuf,
    },
    /// Nodes without any row.
    UnusedNodes {
        /// The file of the nodes.
        path: PathBuf,
        /// How many.
        count: usize,
    },
}

impl InputNote {
    /// The code of the warning that this remark is, where it is more than a remark.
    pub fn warning_code(&self) -> Option<&'static str> {
        match self {
            Self::LastRowEmpty { .. } => Some("W-INDEX-BASE"),
            _ => None,
        }
    }
}

impl fmt::Display for InputNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Duplicates { path, count } => {
                let entries = counted(*count, "entry repeats", "entries repeat");
                write!(f, "{}: {entries} a position: what stands at one position was added up", file_name(path))
            }
            Self::Mirrored { path } => {
                write!(
                    f,
                    "{}: only one triangle is given; it was mirrored, as stiffness and mass are symmetric",
                    file_name(path)
                )
            }
            Self::TriangleTaken { path, triangle, n_differing } => {
                let (kept, other) = match triangle {
                    Triangle::Lower => ("lower", "above"),
                    Triangle::Upper => ("upper", "below"),
                };
                write!(
                    f,
                    "{}: the {kept} triangle was taken for both as asked; what stands at {} {other} the diagonal \
                     differs from it and was left out",
                    file_name(path),
                    counted(*n_differing, "position", "positions")
                )
            }
            Self::EmptyRowsDropped { count, row, dof } => {
                let dof = dof.map(|dof| format!(", {dof}")).unwrap_or_default();
                let rows =
                    counted(*count, "row without stiffness and mass was", "rows without stiffness and mass were");
                write!(f, "{rows} dropped as asked; the first is row {row}{dof}")
            }
            Self::LastRowEmpty { path, n } => {
                write!(
                    f,
                    "{}: row {n}, the last one, is empty and no other is; if its indices count from zero, add one to each",
                    file_name(path)
                )
            }
            Self::OrderFromIndices { path, n } => {
                let rows = counted(*n, "row", "rows");
                write!(f, "{}: no size line; the largest index makes it a matrix of {rows}", file_name(path))
            }
            Self::Extended { path, from, to } => {
                write!(
                    f,
                    "{}: the largest index is {from}; rows up to {to}, the order of the other matrix, are empty",
                    file_name(path)
                )
            }
            Self::OpenLastLine { path } => {
                write!(f, "{}: the last line has no line end; check that the file is complete", file_name(path))
            }
            Self::DirectionsFromZero { path } => write!(f, "{}: directions count from zero, 0 is ux", file_name(path)),
            Self::DefaultOrder { dofs_per_node, nodes } => {
                write!(f, "no dof map: rows are taken as {dofs_per_node} a node, in the order of {}", file_name(nodes))
            }
            Self::UnusedNodes { path, count } => {
                write!(f, "{}: {} no row", file_name(path), counted(*count, "node has", "nodes have"))
            }
        }
    }
}

/// The name of a file without its folder: what a note says must not depend on where the files are.
fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
