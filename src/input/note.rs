//! What a reader did beyond copying, for the user.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::dofs::Dof;
use crate::number::{count, counted};
use crate::sparse::{Given, Triangle};

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
    /// Each pair of a row and a column was given once, without the declaration that it stands for both.
    Mirrored {
        /// The file of the matrix.
        path: PathBuf,
        /// One triangle, or pairs in either order.
        given: Given,
    },
    /// Pairs of a row and a column were given in one order only, and stay so.
    GivenOnce {
        /// The file of the matrix.
        path: PathBuf,
        /// How many pairs.
        n_once: usize,
    },
    /// One triangle was taken for both on request, and the other differed.
    TriangleTaken {
        /// The file of the matrix.
        path: PathBuf,
        /// The triangle that holds.
        triangle: Triangle,
        /// Positions of the other triangle that held something else.
        n_differing: usize,
        /// Pairs of a row and a column that stood in one triangle only, whichever.
        n_once: usize,
    },
    /// A matrix has rows in an order of its own, so that a dof map orders nothing.
    MapUnused {
        /// The file of the dof map.
        path: PathBuf,
        /// The file of the matrix.
        matrix: PathBuf,
    },
    /// Rows without stiffness and mass were left out.
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
    /// K and M name the node and the direction of each row, and no dof map was given.
    RowsNamed {
        /// The file of the stiffness.
        path: PathBuf,
        /// Rows that either names.
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
    /// A mass of a format that states no size has no entries from some row on, where whole elements lie.
    MassEndsEarly {
        /// The file of the mass.
        path: PathBuf,
        /// The last row with entries.
        from: usize,
        /// The order.
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
    /// The cells of a mesh are damaged, and compared with nothing.
    CellsUnread {
        /// The file of the nodes.
        path: PathBuf,
        /// What is wrong with them.
        why: String,
    },
    /// Nodes without any row.
    UnusedNodes {
        /// The file of the nodes.
        path: PathBuf,
        /// How many.
        count: usize,
    },
    /// A deck gives nodes local directions.
    Transformed {
        /// The deck, or the file that it includes.
        path: PathBuf,
        /// The line of `*TRANSFORM`, from 1.
        line: u64,
    },
    /// Rows of nodes along axes of their own were turned to those of the model.
    Turned {
        /// The file that gives the axes.
        path: PathBuf,
        /// Nodes whose rows were turned.
        n_nodes: usize,
    },
    /// A deck states other axes of a node than the table of the job.
    OtherAxes {
        /// The table, which holds.
        path: PathBuf,
        /// The deck.
        deck: PathBuf,
        /// Label of the first such node.
        node: i64,
    },
    /// Rows were turned by axes that nothing compares with the stiffness.
    TurnedUntested {
        /// The file that gives the axes.
        path: PathBuf,
    },
    /// Nodes of shells or beams that CalculiX made into solids have got their nodes back.
    Expanded {
        /// The file of the dof map.
        path: PathBuf,
        /// The file that says where they are.
        positions: PathBuf,
        /// Nodes of the deck.
        n_nodes: usize,
        /// Nodes that were made of them.
        n_made: usize,
    },
    /// Supports have taken rows of nodes that were made of one, so that rows could be those of several.
    ExpandedUnsure {
        /// The file of the dof map.
        path: PathBuf,
        /// Nodes of the deck.
        count: usize,
        /// The first of them.
        first: i64,
    },
    /// Rows of nodes that no deck lists are amplitudes of incompatible modes.
    Amplitudes {
        /// The file of the dof map.
        path: PathBuf,
        /// Nodes that the deck does not list.
        n_nodes: usize,
        /// Elements of the deck that have incompatible modes.
        n_elements: usize,
    },
}

impl InputNote {
    /// The code of the warning that this remark is, where it is more than a remark.
    pub fn warning_code(&self) -> Option<&'static str> {
        match self {
            Self::LastRowEmpty { .. } => Some("W-INDEX-BASE"),
            Self::MassEndsEarly { .. } => Some("W-MASS-ENDS"),
            Self::Transformed { .. } => Some("W-LOCAL-DIRECTIONS"),
            Self::TurnedUntested { .. } => Some("W-FRAME-UNTESTED"),
            _ => None,
        }
    }
}

impl fmt::Display for InputNote {
    #[expect(clippy::too_many_lines, reason = "one sentence for each remark")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Duplicates { path, count } => {
                let entries = counted(*count, "entry repeats", "entries repeat");
                write!(f, "{}: {entries} a position: what stands at one position was added up", file_name(path))
            }
            Self::Mirrored { path, given } => {
                let what = match given {
                    Given::EitherOrder { n_below, n_above } => format!(
                        "each pair of rows is given once, by {} below the diagonal and {} above it",
                        counted(*n_below, "entry", "entries"),
                        count(*n_above as u64)
                    ),
                    Given::Whole | Given::OneTriangle => "only one triangle is given".to_owned(),
                };
                write!(f, "{}: {what}; it was mirrored, as stiffness and mass are symmetric", file_name(path))
            }
            Self::GivenOnce { path, n_once } => {
                let pairs = counted(*n_once, "pair of rows is", "pairs of rows are");
                write!(
                    f,
                    "{}: {pairs} given in one order only, and no other pair tells the matrix from a symmetric one; what is not \
                     given stays zero: if one order stands for both, declare the matrix symmetric",
                    file_name(path)
                )
            }
            Self::TriangleTaken { path, triangle, n_differing, n_once } => {
                let (kept, other) = match triangle {
                    Triangle::Lower => ("lower", "above"),
                    Triangle::Upper => ("upper", "below"),
                };
                write!(f, "{}: the {kept} triangle was taken for both", file_name(path))?;
                if *n_differing > 0 {
                    let positions = counted(*n_differing, "position", "positions");
                    write!(f, "; what stands at {positions} {other} the diagonal differs from it and was left out")?;
                }
                if *n_once > 0 {
                    let pairs = counted(*n_once, "pair of rows that is", "pairs of rows that are");
                    write!(f, "; of {pairs} given once, what stands in either triangle was mirrored")?;
                }
                Ok(())
            }
            Self::EmptyRowsDropped { count, row, dof } => {
                let dof = dof.map(|dof| format!(", {dof}")).unwrap_or_default();
                let rows =
                    counted(*count, "row without stiffness and mass was", "rows without stiffness and mass were");
                write!(f, "{rows} left out: the first is row {row}{dof}")
            }
            Self::MapUnused { path, matrix } => write!(
                f,
                "{}: {} names none of its rows, which stay in the order of the matrix",
                file_name(path),
                file_name(matrix)
            ),
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
            Self::RowsNamed { path, n } => {
                let rows = counted(*n, "row is", "rows are");
                write!(
                    f,
                    "{}: {rows} named by stiffness and mass, in the order of nodes and directions",
                    file_name(path)
                )
            }
            Self::Extended { path, from, to } => {
                write!(
                    f,
                    "{}: the largest index is {from}; rows up to {to}, the order of the other matrix, are empty",
                    file_name(path)
                )
            }
            Self::MassEndsEarly { path, from, to } => {
                write!(
                    f,
                    "{}: rows {} to {to} have no mass, nor have elements between them; a file of a format that states no size looks \
                     so where it was cut short – check that it is whole, and name the mass in model.expect",
                    file_name(path),
                    from + 1
                )
            }
            Self::OpenLastLine { path } => {
                write!(f, "{}: the last line has no line end; check that the file is complete", file_name(path))
            }
            Self::DirectionsFromZero { path } => write!(f, "{}: directions count from zero, 0 is ux", file_name(path)),
            Self::DefaultOrder { dofs_per_node, nodes } => {
                write!(f, "no dof map: rows are taken as {dofs_per_node} a node, in the order of {}", file_name(nodes))
            }
            Self::Transformed { path, line } => write!(
                f,
                "{}:{line}: *TRANSFORM gives nodes local directions, but rows are taken to be along the global axes, as CalculiX \
                 writes them; where Abaqus writes the matrices, give the axes of these nodes with `model.frames`",
                file_name(path)
            ),
            Self::Turned { path, n_nodes } => write!(
                f,
                "{}: {} along axes of their own; they are turned to the axes of the model, and what the tool says of them is along these",
                file_name(path),
                counted(*n_nodes, "node has rows", "nodes have rows")
            ),
            Self::OtherAxes { path, deck, node } => write!(
                f,
                "{}: {} states other axes of node {node}; those of the table hold",
                file_name(path),
                file_name(deck)
            ),
            Self::TurnedUntested { path } => write!(
                f,
                "{}: no coordinates are given, so that nothing compares the axes of its nodes with the stiffness; wrong axes leave the \
                 frequencies as they are and turn the interface: give `model.nodes`",
                file_name(path)
            ),
            Self::Expanded { path, positions, n_nodes, n_made } => write!(
                f,
                "{}: CalculiX made {n_made} nodes of {n_nodes} of shells, beams or cells in the plane; where they are is from {}",
                file_name(path),
                file_name(positions)
            ),
            Self::ExpandedUnsure { path, count, first } => write!(
                f,
                "{}: supports have taken rows of what was made of {}, the first is {first}; the rows left there are taken to \
                 be those of the first nodes made",
                file_name(path),
                counted(*count, "node", "nodes")
            ),
            Self::Amplitudes { path, n_nodes, n_elements } => write!(
                f,
                "{}: {n_nodes} nodes that the deck does not list are amplitudes of incompatible modes in {}; rigid-body motion \
                 leaves them at rest",
                file_name(path),
                counted(*n_elements, "element", "elements")
            ),
            Self::CellsUnread { path, why } => {
                write!(f, "{}: its cells are not compared with the stiffness: {why}", file_name(path))
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
