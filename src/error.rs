//! Every way a run can fail, one variant each, with the values that explain it.
//!
//! A message reads *what – where – found – expected – what to do*, in lower case and without a full stop. The variant
//! decides the exit code, so that a CI job can tell bad input from a bad model from a full disk.

use std::path::PathBuf;

/// The result of every fallible call of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why a run failed. Each variant belongs to one [`ErrorClass`], which is its exit code.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    // ---- files -----------------------------------------------------------------------------------------------------
    /// A file could not be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    // ---- text input ------------------------------------------------------------------------------------------------
    /// A path is a folder, a pipe or a device.
    #[error("{}: not a regular file; give the path of a file on disk", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// Gzipped data ends early or is damaged.
    #[error("{}: the gzipped data are damaged or cut short ({source}); copy or create the file again", path.display())]
    GzipDamaged {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        source: std::io::Error,
    },
    /// Gzipped data inflate to more than a matrix can.
    #[error(
        "{}: the gzipped data inflate to more than {limit} times their size ({compressed} bytes gave {inflated}); \
         no table of numbers does this, check where the file comes from", path.display()
    )]
    GzipInflation {
        /// The file.
        path: PathBuf,
        /// Bytes read so far.
        compressed: u64,
        /// Bytes they gave.
        inflated: u64,
        /// The ratio allowed.
        limit: u64,
    },
    /// A line is longer than any line of numbers.
    #[error(
        "{}:{line}: line longer than {limit} bytes; expected lines of a few numbers, is this a text file?",
        path.display()
    )]
    LineTooLong {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The longest line allowed, in bytes.
        limit: usize,
    },
    /// A text file holds no data.
    #[error("{}: the file holds no data; expected {expected}", path.display())]
    NoData {
        /// The file.
        path: PathBuf,
        /// What belongs there.
        expected: &'static str,
    },
    /// The first line of a matrix file is neither a Matrix Market banner nor numbers.
    #[error(
        "{}:{line}: not a matrix: found `{found}`, expected `%%MatrixMarket matrix coordinate real symmetric` \
         or lines `row column value`", path.display()
    )]
    MatrixBanner {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The line.
        found: String,
    },
    /// A Matrix Market flavour that no stiffness or mass matrix needs.
    #[error(
        "{}:{line}: Matrix Market flavour `{found}` is not read; \
         supported are `coordinate real` and `coordinate integer`, each `symmetric` or `general`", path.display()
    )]
    MatrixFlavour {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The word that is not supported.
        found: String,
    },
    /// The size line of a Matrix Market file cannot be read.
    #[error(
        "{}:{line}: size line: found `{found}`, expected three whole numbers `rows columns entries`",
        path.display()
    )]
    MatrixSizeLine {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The line.
        found: String,
    },
    /// A matrix is rectangular.
    #[error("{}:{line}: the matrix has {rows} rows and {cols} columns; stiffness and mass are square", path.display())]
    MatrixNotSquare {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// Rows declared.
        rows: u64,
        /// Columns declared.
        cols: u64,
    },
    /// A matrix without rows, or with more than can be numbered.
    #[error("{}:{line}: the matrix has {n} rows; expected 1 to {limit}", path.display())]
    MatrixOrder {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// Rows declared or implied.
        n: u64,
        /// The largest order.
        limit: u64,
    },
    /// Nearly all rows of a large matrix are empty.
    #[error(
        "{}: a matrix of {n} rows with only {entries} entries; nearly all rows would be empty, \
         check its size line and indices",
        path.display()
    )]
    MatrixMostlyEmpty {
        /// The file.
        path: PathBuf,
        /// Rows declared or implied.
        n: u64,
        /// Entries found.
        entries: u64,
    },
    /// A field of an entry is not a number.
    #[error("{}:{line}: {field} of an entry: found `{found}`, expected {expected}", path.display())]
    EntryField {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// Which field: row, column or value.
        field: &'static str,
        /// The text found.
        found: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A line has more fields than an entry.
    #[error("{}:{line}: found `{found}` after the value; expected `row column value` and nothing else", path.display())]
    EntryExcess {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The text found.
        found: String,
    },
    /// An index lies outside the matrix.
    #[error(
        "{}:{line}: {field} {found} lies outside the matrix; indices count from 1, expected 1 to {n}",
        path.display()
    )]
    EntryIndex {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// Which index: row or column.
        field: &'static str,
        /// The index found.
        found: u64,
        /// The order of the matrix.
        n: u64,
    },
    /// A value is infinite or not a number.
    #[error("{}:{line}: entry ({row}, {col}) is `{found}`; expected a finite number", path.display())]
    NonFinite {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// Row, from 1.
        row: u64,
        /// Column, from 1.
        col: u64,
        /// The text found.
        found: String,
    },
    /// A matrix file holds fewer entries than it declares, or its bare size line is wrong.
    #[error("{}: the size line declares {declared} entries, found {found}; the file may be cut short", path.display())]
    EntryCount {
        /// The file.
        path: PathBuf,
        /// Entries declared.
        declared: u64,
        /// Entries found.
        found: u64,
    },
    /// A matrix file goes on after all entries have come.
    #[error("{}:{line}: more entries than the {declared} that the size line declares", path.display())]
    EntriesSurplus {
        /// The file.
        path: PathBuf,
        /// Line number of the first entry too many, from 1.
        line: u64,
        /// Entries declared.
        declared: u64,
    },
    /// A matrix declared symmetric has entries on both sides of the diagonal.
    #[error(
        "{}: declared symmetric, but entries lie on both sides of the diagonal, ({}, {}) and ({}, {}); \
         expected one triangle: remove the other, or declare the matrix general",
        path.display(), lower.0, lower.1, upper.0, upper.1
    )]
    DoubleTriangle {
        /// The file.
        path: PathBuf,
        /// Row and column, from 1, of an entry below the diagonal.
        lower: (u64, u64),
        /// Row and column, from 1, of an entry above the diagonal.
        upper: (u64, u64),
    },
    /// K and M differ in size.
    #[error(
        "stiffness {} has {n_stiffness} rows and mass {} has {n_mass}; expected the same degrees of freedom in both",
        stiffness.display(), mass.display()
    )]
    SizeMismatch {
        /// The file of K.
        stiffness: PathBuf,
        /// Its order.
        n_stiffness: usize,
        /// The file of M.
        mass: PathBuf,
        /// Its order.
        n_mass: usize,
    },
    /// A table lacks a column.
    #[error("{}: no column `{column}`: found the header `{found}`, expected {expected}", path.display())]
    TableColumn {
        /// The file.
        path: PathBuf,
        /// The missing column.
        column: &'static str,
        /// The header found.
        found: String,
        /// The columns that are needed.
        expected: &'static str,
    },
    /// A table cannot be split into rows and fields.
    #[error("{}:{line}: row of {found} fields; expected {expected} as in the header", path.display())]
    TableRow {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// Fields found.
        found: u64,
        /// Fields of the header.
        expected: u64,
    },
    /// A field of a table cannot be read.
    #[error("{}:{line}: column `{column}`: found `{found}`, expected {expected}", path.display())]
    TableField {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// Name of the column.
        column: String,
        /// The text found.
        found: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A node is listed twice.
    #[error("{}:{line}: node {node} again, first at line {first_line}; expected each node once", path.display())]
    NodeRepeated {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// Label of the node.
        node: i64,
        /// Line where it came first.
        first_line: u64,
    },
    /// A line of a dof map is not `node.direction`.
    #[error("{}:{line}: found `{found}`; expected `node.direction`, for example 412.1", path.display())]
    DofText {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The text found.
        found: String,
    },
    /// A direction of a dof map does not exist.
    #[error("{}:{line}: node {node} has direction `{found}`; expected {expected}", path.display())]
    DofDirection {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// Label of the node.
        node: i64,
        /// The text found.
        found: String,
        /// The directions that exist.
        expected: &'static str,
    },
    /// Two rows of a dof map are the same degree of freedom.
    #[error(
        "{}: rows {first_row} and {row} are both {direction:?} of node {node}; expected every degree of freedom once \
         (rows count from 1; programs that expand shells or beams into solids repeat labels, renumber their nodes)",
        path.display()
    )]
    DofRepeated {
        /// The file.
        path: PathBuf,
        /// Row of the repetition, from 1.
        row: usize,
        /// Row where it came first, from 1.
        first_row: usize,
        /// Label of the node.
        node: i64,
        /// Direction.
        direction: crate::input::Direction,
    },
    /// The rows of a dof map are numbered, but not in order.
    #[error("{}:{line}: row number `{found}`; expected {expected}, the rows of the matrices in order", path.display())]
    DofRowOrder {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The number found.
        found: String,
        /// The number due.
        expected: u64,
    },
    /// A dof map is longer or shorter than the matrices.
    #[error(
        "{}: the dof map has {found} rows, the matrices have {n}; expected one row for each of theirs",
        path.display()
    )]
    DofCount {
        /// The file.
        path: PathBuf,
        /// Rows of the map.
        found: usize,
        /// Order of the matrices.
        n: usize,
    },
    /// A dof map names a node that has no position.
    #[error(
        "{}: row {row} (from 1) is at node {node}, which {} does not list; \
         expected a position for every node of the map",
        path.display(), nodes.display()
    )]
    DofNodeMissing {
        /// The file of the dof map.
        path: PathBuf,
        /// Row, from 1.
        row: usize,
        /// Label of the node.
        node: i64,
        /// The file of the nodes.
        nodes: PathBuf,
    },
    /// Without a dof map, the counts do not say what the rows are.
    #[error(
        "the matrices have {n} rows and {} lists {n_nodes} nodes, neither three nor six rows a node; \
         give a dof map (a file with `node.direction` for each row)", nodes.display()
    )]
    DofOrderUnknown {
        /// The file of the nodes.
        nodes: PathBuf,
        /// Nodes listed.
        n_nodes: usize,
        /// Order of the matrices.
        n: usize,
    },
    /// A file needs a part of the program that was left out when it was built.
    #[error(
        "{}: this program was built without `{feature}`, which this file needs; rebuild with --features {feature}",
        path.display()
    )]
    FeatureMissing {
        /// The file.
        path: PathBuf,
        /// The feature.
        feature: &'static str,
    },
    // ---- hdf5 input ------------------------------------------------------------------------------------------------
    // ---- job and command line --------------------------------------------------------------------------------------
    // ---- model -----------------------------------------------------------------------------------------------------
    // ---- partition -------------------------------------------------------------------------------------------------
    // ---- factor ----------------------------------------------------------------------------------------------------
    // ---- modes -----------------------------------------------------------------------------------------------------
    // ---- superelement file -----------------------------------------------------------------------------------------
}

/// The class of an [`Error`]; its number is the exit code of the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorClass {
    /// The command line or the job document is wrong.
    Usage = 2,
    /// A file's content is wrong.
    InputData = 3,
    /// The matrices do not describe a component that can be reduced as asked.
    ModelPhysics = 4,
    /// The arithmetic cannot give what was asked.
    NumericalLimit = 5,
    /// Not enough memory.
    Resources = 6,
    /// A file could not be read or written.
    Io = 7,
}

impl Error {
    /// The class of this error, which is its exit code.
    pub fn class(&self) -> ErrorClass {
        match self {
            Self::Read { .. } | Self::Write { .. } => ErrorClass::Io,
            Self::FeatureMissing { .. } => ErrorClass::Usage,
            Self::NotAFile { .. }
            | Self::GzipDamaged { .. }
            | Self::GzipInflation { .. }
            | Self::LineTooLong { .. }
            | Self::NoData { .. }
            | Self::MatrixBanner { .. }
            | Self::MatrixFlavour { .. }
            | Self::MatrixSizeLine { .. }
            | Self::MatrixNotSquare { .. }
            | Self::MatrixOrder { .. }
            | Self::MatrixMostlyEmpty { .. }
            | Self::EntryField { .. }
            | Self::EntryExcess { .. }
            | Self::EntryIndex { .. }
            | Self::NonFinite { .. }
            | Self::EntryCount { .. }
            | Self::EntriesSurplus { .. }
            | Self::DoubleTriangle { .. }
            | Self::SizeMismatch { .. }
            | Self::TableColumn { .. }
            | Self::TableRow { .. }
            | Self::TableField { .. }
            | Self::NodeRepeated { .. }
            | Self::DofText { .. }
            | Self::DofDirection { .. }
            | Self::DofRepeated { .. }
            | Self::DofRowOrder { .. }
            | Self::DofCount { .. }
            | Self::DofNodeMissing { .. }
            | Self::DofOrderUnknown { .. } => ErrorClass::InputData,
        }
    }
}
