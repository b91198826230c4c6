//! Every way in which a run can fail. Each has one variant, with the values that explain it.
//!
//! A message reads *what – where – found – expected – what to do*, in lower case and without a full stop. The variant
//! decides the exit code, so that a CI job can tell bad input from a bad model from a full disk.

mod code;
mod warning;

use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};

use serde::Serialize;
use supel_runtime::FileError;

use crate::number::{bytes, count, counted, quantity, typed};

pub use code::{ErrorClass, ErrorEntry, INTERNAL_CODE, USAGE_CODE};
pub use warning::Warning;

/// The result of every fallible call of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why a run failed. Each variant belongs to one [`ErrorClass`], which is its exit code.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
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
    /// The folder of an output is none.
    #[error(
        "{}: cannot be written: the folder {} {reason} – create it, or give the output another place",
        path.display(), folder.display()
    )]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// An output has its name, but the system did not confirm that it is on the disk.
    #[error(
        "{}: written, but the system did not confirm that it is on the disk: {source} – it may not outlive a power \
        cut – write it again or sync the disk",
        path.display()
    )]
    NotSynced {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// An output could not be written, and those before it could not be taken back.
    #[error("{}: cannot be written: {source} – {left} – put the old files back or run again", path.display())]
    HalfWritten {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
        /// Which files are new and where their old content is, in words.
        left: String,
    },
    /// The answer did not arrive.
    #[error("the answer could not be written to stdout: {source} – give stdout a place with room")]
    Answer {
        /// What the system said.
        source: std::io::Error,
    },
    /// A path is a folder, a pipe or a device.
    #[error("{}: not a regular file – give the path of a file on disk", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// A file was written, cut or exchanged while it was read.
    #[error(
        "{}: changed while it was read – expected one size, time and file from beginning to end – wait until it is \
        written and run again",
        path.display()
    )]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// An XDMF file is not UTF-8. The readers of numbers take any bytes in comments and say of a field what was expected there.
    #[error("{}: byte {offset} is not UTF-8 text – write the file as UTF-8", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Where the first byte is that is none, from 0.
        offset: usize,
    },
    /// What a file holds does not fit into the memory.
    #[error(
        "{}: what was read so far needs {} with the matrices made of it – {} of memory is available – free memory, raise \
        run.memory_gib or reduce a smaller model",
        path.display(), bytes(*needed), bytes(*available)
    )]
    MemoryRead {
        /// The file at which it came to an end.
        path: PathBuf,
        /// Bytes of everything read so far and made of it.
        needed: u64,
        /// Bytes available.
        available: u64,
    },
    /// A file of a known format that is not read.
    #[error("{}: {found} – not read – expected {expected} – {advice}", path.display())]
    FormatNotRead {
        /// The file.
        path: PathBuf,
        /// What it is.
        found: &'static str,
        /// What is read in its place.
        expected: &'static str,
        /// The way round.
        advice: &'static str,
    },
    /// Gzipped data ends early or is damaged.
    #[error("{}: the gzipped data are damaged or cut short – {source} – copy or create the file again", path.display())]
    GzipDamaged {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        source: std::io::Error,
    },
    /// Gzipped data inflate to more than a matrix can.
    #[error(
        "{}: the gzipped data inflate too far – found {inflated} bytes from {compressed} – expected at most {limit} \
        times their size, which tables of numbers keep to – check where the file comes from",
        path.display()
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
        "{}:{line}: a line longer than {limit} bytes – expected lines of a few numbers – check that this is a text \
        file",
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
    #[error("{}: the file holds no data – expected {expected}", path.display())]
    NoData {
        /// The file.
        path: PathBuf,
        /// What belongs there.
        expected: &'static str,
    },
    /// The first line of a matrix file is neither a Matrix Market banner nor numbers.
    #[error(
        "{}:{line}: not a matrix – found `{found}` – expected `%%MatrixMarket matrix coordinate real symmetric` or \
        lines `row column value`",
        path.display()
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
        "{}:{line}: a Matrix Market flavour that is not read – found `{found}` – expected `coordinate real` or \
        `coordinate integer`, each `symmetric` or `general`",
        path.display()
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
        "{}:{line}: size line – found `{found}` – expected three whole numbers `rows columns entries`",
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
    #[error(
        "{}:{line}: the matrix has {} and {} – expected as many of both, as stiffness and mass have",
        path.display(), counted(*rows, "row", "rows"), counted(*cols, "column", "columns")
    )]
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
    #[error("{}:{line}: the matrix has {n} rows – expected 1 to {limit}", path.display())]
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
        "{}: a matrix of {} with only {} – expected hardly any empty rows – check its size line and indices",
        path.display(), counted(*n, "row", "rows"), counted(*entries, "entry", "entries")
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
    #[error("{}:{line}: {field} of an entry – found `{found}` – expected {expected}", path.display())]
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
    #[error(
        "{}:{line}: found `{found}` after the value – expected `row column value` and nothing else",
        path.display()
    )]
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
        "{}:{line}: {field} {found} lies outside the matrix – expected 1 to {n}, because indices count from 1",
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
    #[error("{}:{line}: entry ({row}, {col}) is `{found}` – expected a finite number", path.display())]
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
    #[error(
        "{}: entries are missing – found {found} – expected the {declared} that the size line declares – the file may \
        be cut short: write or copy it again",
        path.display()
    )]
    EntryCount {
        /// The file.
        path: PathBuf,
        /// Entries declared.
        declared: u64,
        /// Entries found.
        found: u64,
    },
    /// A matrix file goes on after all entries have come.
    #[error(
        "{}:{line}: more entries than declared – expected the {declared} of the size line – write or copy the file \
        again",
        path.display()
    )]
    EntriesSurplus {
        /// The file.
        path: PathBuf,
        /// Line number of the first entry too many, from 1.
        line: u64,
        /// Entries declared.
        declared: u64,
    },
    /// Entries of a matrix repeat a position, and the job refuses that.
    #[error(
        "{}: {} a position – expected each position once, as --strict or model.duplicates = \
        \"refuse\" asks – assemble the matrix, or take that back to have them added",
        path.display(), counted(*count, "entry repeats", "entries repeat")
    )]
    Duplicates {
        /// The file.
        path: PathBuf,
        /// How many.
        count: usize,
    },
    /// A matrix declared symmetric has entries on both sides of the diagonal.
    #[error(
        "{}: declared symmetric – found entries on both sides of the diagonal, ({}, {}) and ({}, {}) – expected one \
        triangle – remove the other, declare the matrix general, or say which holds: model.symmetric = \"lower\" or \
        \"upper\" (reduce --symmetric)",
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
    /// K and M are one matrix.
    #[error(
        "stiffness {} and mass {} hold one matrix – expected two, because every frequency of the pencil would be 1 \
        rad/s – give the file of the other one",
        stiffness.display(), mass.display()
    )]
    SameMatrix {
        /// The file of K.
        stiffness: PathBuf,
        /// The file of M.
        mass: PathBuf,
    },
    /// K and M differ in size.
    #[error(
        "stiffness {} has {} and mass {} has {} – expected the same degrees of freedom in both",
        stiffness.display(), counted(*n_stiffness, "row", "rows"), mass.display(), count(*n_mass as u64)
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
    #[error("{}: no column `{column}` – found the header `{found}` – expected {expected}", path.display())]
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
    #[error("{}:{line}: a row of {} – expected {expected} as in the header", path.display(), counted(*found, "field", "fields"))]
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
    #[error("{}:{line}: column `{column}` – found `{found}` – expected {expected}", path.display())]
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
    #[error("{}:{line}: node {node} again, first at line {first_line} – expected each node once", path.display())]
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
    /// A node lies so far away, or all so near to each other, that squares of their coordinates leave the range of double precision.
    #[error(
        "{}: coordinate {} of node {node} is {value:e} – expected sizes between 2^-{bits} and 2^{bits} – check the \
        number, or write the nodes in other units",
        path.display(), ["x", "y", "z"][*axis % 3]
    )]
    NodeRange {
        /// The file.
        path: PathBuf,
        /// Label of the node.
        node: i64,
        /// The axis 0, 1 or 2.
        axis: usize,
        /// The coordinate.
        value: f64,
        /// The powers of two between which sizes may lie.
        bits: u32,
    },
    /// A line of a dof map is not `node.direction`.
    #[error("{}:{line}: found `{found}` – expected `node.direction`, for example 412.1", path.display())]
    DofText {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The text found.
        found: String,
    },
    /// A direction of a dof map does not exist.
    #[error("{}:{line}: node {node} has direction `{found}` – expected {expected}", path.display())]
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
        "{}: rows {first_row} and {row} are both {direction} of node {node}, and {repeated} repeat a dof – expected \
        every degree of freedom once (rows count from 1; programs that expand shells or beams into solids repeat \
        labels) – renumber the nodes, or {BY_ROWS}",
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
        direction: crate::dofs::Direction,
        /// All rows that repeat an earlier one, in words.
        repeated: String,
    },
    /// The rows of a dof map are numbered, but not in order.
    #[error("{}:{line}: row number `{found}` – expected {expected}, the rows of the matrices in order", path.display())]
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
        "{}: the dof map has {} – expected {}, one for each of the matrices",
        path.display(), counted(*found, "row", "rows"), count(*n as u64)
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
        "{}: row {row} is at node {node}, which {} does not list, and {missing} have no position – expected one for \
        every node of the map (rows count from 1; programs that expand shells or beams into solids make nodes of \
        their own) – add the nodes, or {BY_ROWS}",
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
        /// All rows whose node has no position, in words.
        missing: String,
    },
    /// Without a dof map, the counts do not say what the rows are.
    #[error(
        "the matrices have {} and {} lists {} – expected three or six rows a node – give a dof map (a file with \
        `node.direction` for each row)",
        counted(*n, "row", "rows"), nodes.display(), counted(*n_nodes, "node", "nodes")
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
        "{}: this program was built without `{feature}`, which this file needs – rebuild with --features {feature}",
        path.display()
    )]
    FeatureMissing {
        /// The file.
        path: PathBuf,
        /// The feature.
        feature: &'static str,
    },
    /// A file that should be HDF5 is something else.
    #[error("{}: not an HDF5 file – found {found} – expected the HDF5 signature – {advice}", path.display())]
    Hdf5Signature {
        /// The file.
        path: PathBuf,
        /// What its first bytes look like.
        found: &'static str,
        /// What to do about it.
        advice: &'static str,
    },
    /// The HDF5 library refused to open a file.
    #[error("{}: a damaged HDF5 file – the HDF5 library says: {reason} – write or copy the file again", path.display())]
    Hdf5Open {
        /// The file.
        path: PathBuf,
        /// The library's words.
        reason: String,
    },
    /// The HDF5 library crashed on a file, in the child process that read it first.
    #[error(
        "{}: a damaged HDF5 file – the HDF5 library crashes when it reads it – write or copy the file again",
        path.display()
    )]
    Hdf5Crash {
        /// The file.
        path: PathBuf,
    },
    /// The HDF5 library did not come to an end with a file.
    #[error(
        "{}: the HDF5 library was still reading it after {seconds} s – expected an end long before – the file may be \
        damaged: look at it with h5dump, write or copy it again",
        path.display()
    )]
    Hdf5Time {
        /// The file.
        path: PathBuf,
        /// The time it had.
        seconds: u64,
    },
    /// The child process that reads HDF5 first was ended from outside.
    #[error(
        "{}: the child process that read it first was ended by signal {signal} – the system does so when memory runs \
        out – free memory and run again",
        path.display()
    )]
    RehearsalKilled {
        /// The file.
        path: PathBuf,
        /// The signal.
        signal: i32,
    },
    /// The child process that reads HDF5 first could not be started.
    #[error("no child process can be started to read the HDF5 input first – {source}")]
    Rehearsal {
        /// What the system said.
        source: std::io::Error,
    },
    /// The HDF5 library could not read an object of a file.
    #[error("{}:{object}: cannot be read – the HDF5 library says: {reason}", path.display())]
    Hdf5Read {
        /// The file.
        path: PathBuf,
        /// Path of the object in the file.
        object: String,
        /// The library's words.
        reason: String,
    },
    /// A group, dataset or attribute that must be there is not.
    #[error("{}:{object}: there is no such {kind} in the file", path.display())]
    Hdf5Missing {
        /// The file.
        path: PathBuf,
        /// Path of the object in the file.
        object: String,
        /// Group, dataset or attribute.
        kind: &'static str,
    },
    /// A path in the file leads through a soft or external link.
    #[error(
        "{}:{object}: a soft or external link, and links are not followed – give the path of the object itself",
        path.display()
    )]
    Hdf5Link {
        /// The file.
        path: PathBuf,
        /// Path of the link in the file.
        object: String,
    },
    /// The values of a dataset lie in other files.
    #[error(
        "{}:{object}: keeps its values in other files – expected values stored in this file – repack it with h5repack",
        path.display()
    )]
    Hdf5ExternalStorage {
        /// The file.
        path: PathBuf,
        /// Path of the dataset in the file.
        object: String,
    },
    /// A dataset is compressed in a way that is not read.
    #[error(
        "{}:{object}: stored through filter {filter} – expected none, shuffle, fletcher32 or one deflate (gzip) – \
        rewrite it with `h5repack -f GZIP=4`",
        path.display()
    )]
    Hdf5Filter {
        /// The file.
        path: PathBuf,
        /// Path of the dataset in the file.
        object: String,
        /// The filter.
        filter: String,
    },
    /// A dataset promises more values than its stored bytes can hold.
    #[error(
        "{}:{object}: promises {promised} – its stored bytes can hold at most {} – the file is damaged or \
        the dataset was never written",
        path.display(), counted(*available, "byte", "bytes")
    )]
    Hdf5Size {
        /// The file.
        path: PathBuf,
        /// Path of the dataset in the file.
        object: String,
        /// What the header promises.
        promised: String,
        /// Bytes that can be there.
        available: u64,
    },
    /// Groups are nested deeper, or there are more of them, than any real file has.
    #[error(
        "{}:{object}: more than {limit} {counted} – the file is damaged or its groups contain themselves",
        path.display()
    )]
    Hdf5Depth {
        /// The file.
        path: PathBuf,
        /// Path of the group at which reading stopped.
        object: String,
        /// The limit.
        limit: usize,
        /// Levels or objects.
        counted: &'static str,
    },
    /// An object or a value is of the wrong type.
    #[error("{}:{object}: found {found} – expected {expected}", path.display())]
    Hdf5Type {
        /// The file.
        path: PathBuf,
        /// Path of the object in the file.
        object: String,
        /// The type found.
        found: String,
        /// The type expected.
        expected: &'static str,
    },
    /// A number that would not stay what it is when it is read.
    #[error("{}:{object}: value {position} (from 0) is {found} – expected {expected}", path.display())]
    Hdf5Value {
        /// The file.
        path: PathBuf,
        /// Path of the dataset or attribute in the file.
        object: String,
        /// Position of the value, from zero.
        position: usize,
        /// The value.
        found: String,
        /// The numbers that can be read.
        expected: &'static str,
    },
    /// A dataset has the wrong number of values or the wrong shape.
    #[error("{}:{object}: found {found} – expected {expected}", path.display())]
    Hdf5Shape {
        /// The file.
        path: PathBuf,
        /// Path of the dataset in the file.
        object: String,
        /// Length or shape found.
        found: String,
        /// Length or shape expected, and where that comes from.
        expected: String,
    },
    /// There is no sparse matrix where one was looked for.
    #[error(
        "{}:{group}: no sparse matrix – found {} – expected a MATLAB v7.3 or PETSc (`MATLAB_sparse`), anndata, \
        h5sparse or Exudyn group, or one with data, indices and indptr",
        path.display(), listed(holds)
    )]
    Hdf5NoMatrix {
        /// The file.
        path: PathBuf,
        /// The group below which it was looked for.
        group: String,
        /// The objects there.
        holds: Vec<String>,
    },
    /// Several sparse matrices, or one under another name, so that none can be taken without guessing.
    #[error(
        "{}: no single matrix whose name says {role} – found {} – choose one, as in {}:{}",
        path.display(), listed(groups), path.display(), groups.first().map_or("/K", String::as_str)
    )]
    Hdf5AmbiguousMatrix {
        /// The file.
        path: PathBuf,
        /// Stiffness or mass.
        role: &'static str,
        /// The groups that could be meant.
        groups: Vec<String>,
    },
    /// A matrix without rows.
    #[error("{}:{group}: an empty matrix (0 × 0)", path.display())]
    Hdf5EmptyMatrix {
        /// The file.
        path: PathBuf,
        /// The group.
        group: String,
    },
    /// A stiffness or mass matrix that is not square, or larger than 32-bit row numbers allow.
    #[error(
        "{}:{group}: found a matrix of {n_rows} × {n_cols} – expected a square one of at most {} rows",
        path.display(), u32::MAX
    )]
    Hdf5NotSquare {
        /// The file.
        path: PathBuf,
        /// The group.
        group: String,
        /// Number of rows.
        n_rows: u64,
        /// Number of columns.
        n_cols: u64,
    },
    /// The pointers of compressed rows or columns do not rise from zero to the number of entries.
    #[error("{}:{dataset}: pointer {position} is {found} – expected {expected}", path.display())]
    Hdf5Pointer {
        /// The file.
        path: PathBuf,
        /// The dataset of the pointers.
        dataset: String,
        /// Position in the dataset, from zero.
        position: usize,
        /// The pointer there.
        found: i64,
        /// What it must be.
        expected: String,
    },
    /// A row or column index outside the matrix, or a node number outside the mesh.
    #[error("{}:{dataset}: entry {position} is {found} – expected {first} to {last}", path.display())]
    Hdf5Index {
        /// The file.
        path: PathBuf,
        /// The dataset.
        dataset: String,
        /// Position in the dataset, from zero.
        position: usize,
        /// The index there.
        found: i64,
        /// Smallest index allowed.
        first: i64,
        /// Largest index allowed.
        last: i64,
    },
    /// A matrix entry that is not a finite number.
    #[error(
        "{}:{dataset}: the entry of row {row}, column {col} (both from 0) is {value} – expected a finite number",
        path.display()
    )]
    Hdf5NotFinite {
        /// The file.
        path: PathBuf,
        /// The dataset of the values.
        dataset: String,
        /// Row, from zero.
        row: u32,
        /// Column, from zero.
        col: u32,
        /// The value.
        value: f64,
    },
    /// A file in which no known mesh was found.
    #[error(
        "{}: no mesh that can be read – found {} – expected .hmf (/domain/grid/Geometry), XDMF, .med (/ENS_MAA) or \
        .h5m (/tstt)",
        path.display(), listed(holds)
    )]
    MeshUnknown {
        /// The file.
        path: PathBuf,
        /// The objects at its top.
        holds: Vec<String>,
    },
    /// A file with no or several meshes, time steps or geometries where one is expected.
    #[error("{}:{object}: found {} – expected exactly one {kind}", path.display(), listed(found))]
    MeshNotOne {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        object: String,
        /// What is there.
        found: Vec<String>,
        /// What there must be one of.
        kind: &'static str,
    },
    /// A property of a mesh that is not supported.
    #[error("{}:{object}: found {found} – expected {expected}", path.display())]
    MeshUnsupported {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        object: String,
        /// What is there.
        found: String,
        /// What is supported.
        expected: &'static str,
    },
    /// A coordinate that is not a finite number.
    #[error(
        "{}:{object}: coordinate {} of node {label} is {value} – expected a finite number",
        path.display(), ["x", "y", "z"][*axis % 3]
    )]
    MeshNotFinite {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        object: String,
        /// Label of the node.
        label: i64,
        /// The axis 0, 1 or 2.
        axis: usize,
        /// The value.
        value: f64,
    },
    /// Two nodes of the same label.
    #[error("{}:{object}: two nodes have the label {label} – expected each label once", path.display())]
    MeshLabelTwice {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        object: String,
        /// The label.
        label: i64,
    },
    /// An XDMF file that is not well-formed XML.
    #[error("{}: not well-formed XML: {source}", path.display())]
    XdmfSyntax {
        /// The file.
        path: PathBuf,
        /// What is wrong and where.
        source: roxmltree::Error,
    },
    /// An XDMF file with more names than any mesh has, whose look-up would take for ever.
    #[error(
        "{}:{line}: more than {limit} {counted} – expected a few, as programs write them – write the file again",
        path.display()
    )]
    XdmfSize {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// The limit.
        limit: usize,
        /// Attributes of one element, or namespaces.
        counted: &'static str,
    },
    /// An XDMF file names a data file outside its own folder.
    #[error(
        "{}: refers to data in {reference} – expected a `file.h5:/path` in the folder of the XDMF file – move the \
        data there",
        path.display()
    )]
    XdmfReference {
        /// The file.
        path: PathBuf,
        /// The reference as it is written.
        reference: String,
    },
    /// The job document is not valid TOML or JSON, or a value in it has the wrong kind.
    #[error("{}{}: {message}", path.display(), At(*line))]
    JobSyntax {
        /// The job document.
        path: PathBuf,
        /// Line of the document, from one, where it is known.
        line: Option<usize>,
        /// What the parser said.
        message: String,
    },
    /// The job document holds a key that no job has.
    #[error("{}{}: unknown key `{key}`{}", path.display(), At(*line), Suggested(suggestion))]
    JobKey {
        /// The job document.
        path: PathBuf,
        /// Line of the document, from one; JSON documents have the key's path only.
        line: Option<usize>,
        /// Path of the key, `interface[1].nodez`.
        key: String,
        /// The known key that looks most like it.
        suggestion: Option<String>,
    },
    /// A number of the job is out of range.
    #[error("`{key}` is {} – expected {expected}", typed(*value))]
    JobNumber {
        /// Path of the key.
        key: String,
        /// The number found.
        value: f64,
        /// The range.
        expected: &'static str,
    },
    /// A string of the job is empty.
    #[error("`{key}` is empty – expected {expected}")]
    JobEmpty {
        /// Path of the key.
        key: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// Two interface nodes have one name.
    #[error("interface `{name}` is defined twice – names must be unique")]
    InterfaceTwice {
        /// The name.
        name: String,
    },
    /// A boundary of the scene is about an interface that the job does not have.
    #[error("scene.boundaries: `{boundary}`: no interface is called `{name}` – the job has {}", listed(known))]
    SceneInterface {
        /// The boundary.
        boundary: String,
        /// The name in it.
        name: String,
        /// Names of the job's interfaces.
        known: Vec<String>,
    },
    /// An interface lists one node, row or direction twice.
    #[error("interface `{interface}`: {what} is listed twice – list each once")]
    InterfaceRepeats {
        /// Name of the interface.
        interface: String,
        /// What is repeated: `node 12`.
        what: String,
    },
    /// Two interfaces list the same node directly, or the same row.
    #[error("interfaces `{first}` and `{second}` both list {what} – it can belong to one of them")]
    InterfaceOverlap {
        /// Name of the earlier interface.
        first: String,
        /// Name of the later interface.
        second: String,
        /// What is shared: `node 12`.
        what: String,
    },
    /// A selection of nodes is a word that names no group.
    #[error(
        "interface `{interface}`: nodes `{text}` – expected \"group:NAME\", a list of node labels, a region or rows"
    )]
    InterfaceNodes {
        /// Name of the interface.
        interface: String,
        /// The text found.
        text: String,
    },
    /// A key of an interface contradicts how its nodes are given or coupled.
    #[error("interface `{interface}`: `{key}` has no meaning for {situation} – remove it{remedy}")]
    InterfaceConflict {
        /// Name of the interface.
        interface: String,
        /// The key.
        key: String,
        /// What it does not go with.
        situation: &'static str,
        /// Another way out, with its leading word, or nothing.
        remedy: &'static str,
    },
    /// A file or a folder of the job has a name that JSON cannot hold.
    #[error(
        "`{key}` is {path:?} – expected a name in UTF-8, as the report and the superelement keep names – rename {:?}",
        not_text(path)
    )]
    NameNotText {
        /// Path of the key.
        key: &'static str,
        /// The file, with its folders.
        path: PathBuf,
    },
    /// A document cannot be written as JSON.
    #[error(
        "{what} cannot be written as JSON: {source} – expected names in UTF-8 – rename files and folders that have \
        others"
    )]
    NotJson {
        /// The document.
        what: &'static str,
        /// Why not.
        source: serde_json::Error,
    },
    /// An output has an extension that does not say what the file is.
    #[error("`{key}` is {} – expected a name that ends in {expected}", path.display())]
    OutputName {
        /// Path of the key.
        key: &'static str,
        /// The file asked for.
        path: PathBuf,
        /// The extension, with its dot.
        expected: &'static str,
    },
    /// An output would be written over an input.
    #[error(
        "`{key}` is {}, the same file as {role}, {} – expected a file of its own – give the output another name",
        path.display(), input.display()
    )]
    OutputIsInput {
        /// The key of the output.
        key: &'static str,
        /// Its path.
        path: PathBuf,
        /// What the input is.
        role: String,
        /// Its path.
        input: PathBuf,
    },
    /// Two outputs would be written over each other.
    #[error(
        "`{key}` is {}, the same file as `{other}` – expected a file of its own – give one of them another name",
        path.display()
    )]
    OutputTwice {
        /// The key of the later output.
        key: &'static str,
        /// Its path.
        path: PathBuf,
        /// The key of the earlier one.
        other: &'static str,
    },
    /// The name of an output is taken by something that is not a file.
    #[error(
        "{}: not a regular file – expected a name that is free or that of a file – give the output another name",
        path.display()
    )]
    OutputKind {
        /// The path.
        path: PathBuf,
    },
    /// Neither a job document nor the flags that replace it were given.
    #[error("no job document, and without one {} {} missing – give a job document or these flags",
        flags.join(", "), if flags.len() == 1 { "is" } else { "are" })]
    MissingFlags {
        /// The flags that are missing.
        flags: Vec<&'static str>,
    },
    /// The text of a flag cannot be understood.
    #[error("{flag} {text} – expected {expected}")]
    FlagText {
        /// The flag.
        flag: &'static str,
        /// What was typed.
        text: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A superelement of another version is to be made again.
    #[error(
        "{}: made by {found}, this is {} {} – only the same version gives the same bytes – run that one, or compare \
        by verify --job without --reproduce", path.display(), env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION"
        )
    )]
    OtherVersion {
        /// The file.
        path: PathBuf,
        /// Program and version that it names.
        found: String,
    },
    /// The job kept in a superelement is none that this version can run.
    #[error(
        "{}: the job kept in the file is none of {} {} – found one of another version, or none – run that version, or \
        give the job by verify --job",
        path.display(), env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION")
    )]
    KeptJob {
        /// The file.
        path: PathBuf,
    },
    /// The working threads could not be started.
    #[error("{} cannot be started: {source} – ask for fewer with --threads", counted(*n_threads, "thread", "threads"))]
    Threads {
        /// How many were asked for.
        n_threads: usize,
        /// What the system said.
        source: rayon::ThreadPoolBuildError,
    },
    /// A matrix is not symmetric.
    #[error(
        "the {matrix} matrix is not symmetric – worst at {place} – found a relative difference of {asymmetry:.1e} – \
        expected below 1e-6 – leave out follower forces, gyroscopic and friction terms; where the file lacks part of \
        a triangle, take the other one: model.symmetric = \"lower\" or \"upper\" (reduce --symmetric)"
    )]
    Unsymmetric {
        /// `stiffness` or `mass`.
        matrix: &'static str,
        /// max |A − Aᵀ| / max |A|.
        asymmetry: f64,
        /// Row and column of the largest difference, from one, with their dofs where known.
        place: String,
    },
    /// K and M are exchanged.
    #[error(
        "stiffness and mass are exchanged – a unit translation meets no force at {:.0} % of the rows of the stiffness \
        and at {:.0} % of the mass – expected the reverse – exchange the two files",
        100.0 * in_stiffness,
        100.0 * in_mass
    )]
    Swapped {
        /// Share of the rows of K whose entries of one direction add up to nothing.
        in_stiffness: f64,
        /// Share of the rows of M whose entries of one direction add up to nothing.
        in_mass: f64,
    },
    /// M is zero.
    #[error(
        "the mass matrix is zero – found no entry other than zero – expected a mass – give the mass matrix of the model"
    )]
    NoMass,
    /// A mass matrix that gives some motion a negative kinetic energy.
    #[error(
        "the mass matrix is indefinite – {place} – found a kinetic energy of {energy:.1e} relative to its diagonal – \
        expected none below zero – check point masses, offsets and the coupling terms of the mass"
    )]
    IndefiniteMass {
        /// The entry or the dof where it is worst, in words.
        place: String,
        /// The relative energy, negative.
        energy: f64,
    },
    /// A matrix whose numbers, or whose frequencies, leave the range of double precision.
    #[error(
        "{what} leaves the range of double precision – found 2^{exponent} – expected between 2^-960 and 2^1000 – \
        write the matrices in other units"
    )]
    UnitRange {
        /// What is too large or too small.
        what: &'static str,
        /// Its size as a power of two.
        exponent: i32,
    },
    /// Recovered shapes that single precision cannot hold.
    #[error(
        "the shapes of `write.recovery` leave the range of single precision – the largest entry is {largest:.1e} – \
        expected between 2^{low} and 2^{high} – set its precision to \"double\", or write the matrices in other \
        units"
    )]
    RecoveryRange {
        /// The largest entry.
        largest: f64,
        /// Power of two below which digits would be lost.
        low: i32,
        /// Power of two above which it would overflow.
        high: i32,
    },
    /// Rows without stiffness and mass.
    #[error(
        "{} neither stiffness nor mass – the first is row {row}{dof} – expected none – leave unused \
        and constrained dofs out of both matrices, or drop these rows: model.drop_empty = true (reduce --drop-empty)",
        counted(*n_rows, "row has", "rows have")
    )]
    EmptyRows {
        /// How many.
        n_rows: usize,
        /// The first, from one.
        row: usize,
        /// Its dof, in brackets, where known.
        dof: String,
    },
    /// A zero on the diagonal of K in a row that is not empty.
    #[error(
        "row {row}{dof} of the stiffness has a zero diagonal and other entries – expected a positive diagonal – this \
        is a constraint multiplier: eliminate constraints before exporting the matrices"
    )]
    MultiplierRow {
        /// The row, from one.
        row: usize,
        /// Its dof.
        dof: String,
    },
    /// A negative diagonal entry of K.
    #[error(
        "row {row}{dof} of the stiffness has the diagonal {value:.3e} – expected a positive one – the structure is \
        unstable or preloaded beyond buckling"
    )]
    NegativeStiffness {
        /// The row, from one.
        row: usize,
        /// Its dof.
        dof: String,
        /// The entry.
        value: f64,
    },
    /// A negative diagonal entry of M.
    #[error(
        "row {row}{dof} of the mass has the diagonal {value:.3e} – expected none below zero – check point masses and \
        offsets of the model"
    )]
    NegativeMass {
        /// The row, from one.
        row: usize,
        /// Its dof.
        dof: String,
        /// The entry.
        value: f64,
    },
    /// Coordinates or a dof map that do not belong to K.
    #[error(
        "the coordinates do not belong to the stiffness – {found} – expected below {} – check units, axes and local \
        node frames, the order of nodes and rows, and the state that the coordinates are of, or leave the nodes out",
        quantity(*expected, 2)
    )]
    CoordinatesDoNotFit {
        /// What was found, in words.
        found: String,
        /// The largest energy of a motion by the coordinates, relative to another; of nodes out of place their distance, relative to
        /// the size of the component.
        energy: f64,
        /// What rounding of coordinates may make of it.
        expected: f64,
        /// Where the forces are largest.
        dof: String,
    },
    /// Rotations that cost energy in a body that can move freely in every direction.
    #[error(
        "the stiffness lets the component move in every direction but not turn – {rotations} cost up to {} of the \
        energy of the first elastic mode, most of it at {dof}, and {} none – expected free \
        rotations, because no support holds a rotation and no translation of a solid – check the dof map, the order \
        of nodes, local node frames and the state that the coordinates are of; where supports hold rotations alone, \
        list these in model.held_rotations",
        quantity(*energy, 2), counted(*n_zero, "motion costs", "motions cost")
    )]
    RotationsHeld {
        /// The rotations.
        rotations: String,
        /// Zero modes of K.
        n_zero: usize,
        /// Largest Rayleigh quotient of a rotation over the first elastic eigenvalue.
        energy: f64,
        /// Where the forces are largest.
        dof: String,
    },
    /// Most nodes are coupled with other nodes in M than in K.
    #[error(
        "the mass couples {n_apart} of {n_nodes} {what} with other {what} than the stiffness does, the first at \
        {first} – expected the same neighbours, because elements have stiffness and mass at the same nodes – write \
        both matrices with their rows in one order, that of the dof map"
    )]
    MassInAnotherOrder {
        /// Nodes that share less than half of their neighbours.
        n_apart: usize,
        /// Nodes of the model.
        n_nodes: usize,
        /// `nodes`, or `rows` without a dof map.
        what: &'static str,
        /// The first of them.
        first: String,
    },
    /// A rigid-body motion whose energy is negative beyond rounding.
    #[error(
        "a rigid-body motion has the negative energy {energy:.1e} – expected zero within {noise:.1e} – a Sturm count \
        finds {} below half of it: the stiffness is indefinite – check preload and negative springs",
        counted(*count, "eigenvalue", "eigenvalues")
    )]
    NegativeRigidEnergy {
        /// Its Rayleigh quotient, scaled.
        energy: f64,
        /// What rounding of the data allows.
        noise: f64,
        /// Eigenvalues of K − σM below half of it, counted.
        count: usize,
    },
    /// A rigid-body motion that moves no mass.
    #[error(
        "a rigid-body motion moves no mass – found a modal mass of {relative_mass:.1e} relative to the largest – \
        expected above 1e-12 – give the massless part of the model its mass"
    )]
    MasslessRigidMotion {
        /// Its modal mass over the largest.
        relative_mass: f64,
    },
    /// A motion, no rigid-body motion, with neither energy nor mass.
    #[error(
        "a motion has neither stiffness nor mass – it is largest at {dof} – expected one of them for every motion – \
        give the dof stiffness or mass, or leave it out of both matrices"
    )]
    MasslessMechanism {
        /// The dof it moves most.
        dof: String,
    },
    /// Free modes of a component that can move as a rigid body without moving mass.
    #[error(
        "a rigid-body motion moves no mass while the interface is free – it is largest at {dof} – expected mass in \
        every rigid-body motion, without which free modes are not defined – give the nodes rotary inertia, or keep \
        fixed-interface modes (method = \"craig-bampton\")"
    )]
    MasslessFreeMotion {
        /// The dof it moves most.
        dof: String,
    },
    /// A small dense eigenproblem did not converge.
    #[error(
        "a dense eigenproblem of order {n} did not converge – its matrix holds values that are not finite – check the \
        magnitudes of the input"
    )]
    DenseEigen {
        /// Its order.
        n: usize,
    },
    /// An interface too large for dense matrices.
    #[error(
        "the interface has {} – expected at most {}, because the reduced matrices are dense – take fewer \
        interface nodes or couple their patches rigidly",
        counted(*n_interface, "dof", "dofs"), count(*limit as u64)
    )]
    InterfaceTooLarge {
        /// Dofs of the interface.
        n_interface: usize,
        /// The most there may be.
        limit: usize,
    },
    /// Nodes asked for where the model has none.
    #[error(
        "interface {interface:?} names nodes – the model has no dof map or no nodes – give model.dofs and model.nodes \
        (reduce --dofs, reduce --nodes); an interface may also list rows by number"
    )]
    SelectionNeedsNodes {
        /// The interface.
        interface: String,
    },
    /// A rigid patch without coordinates.
    #[error(
        "interface {interface:?} is rigid – its nodes have no coordinates – expected a node table or mesh with every \
        node of the patch"
    )]
    RigidNeedsCoordinates {
        /// The interface.
        interface: String,
    },
    /// A group the mesh does not have.
    #[error("interface {interface:?}: no group {group:?} – {}", groups(known))]
    UnknownGroup {
        /// The interface.
        interface: String,
        /// The group asked for.
        group: String,
        /// Those there are.
        known: Vec<String>,
    },
    /// A selection without nodes.
    #[error(
        "interface {interface:?} selects no node – expected at least one – check the list or the region against the \
        coordinates"
    )]
    EmptyInterface {
        /// The interface.
        interface: String,
    },
    /// A node without rows in the matrices.
    #[error(
        "interface {interface:?}: node {node} has no row in the matrices – expected a free dof – the node is \
        constrained, unused or not in the dof map"
    )]
    InterfaceNodeWithoutRows {
        /// The interface.
        interface: String,
        /// The node.
        node: i64,
    },
    /// A dof the node does not have.
    #[error(
        "interface {interface:?}: {dof} does not exist – expected a direction the node has – solids have no \
        rotations; use coupling = \"rigid\" or list the dofs"
    )]
    DofMissing {
        /// The interface.
        interface: String,
        /// The dof.
        dof: crate::dofs::Dof,
    },
    /// A row number beyond the matrices.
    #[error(
        "interface {interface:?}: row {row} {found} – expected one of 0 to {} with stiffness or mass – rows count \
        from zero, as in the files",
        n.saturating_sub(1)
    )]
    InterfaceRow {
        /// The interface.
        interface: String,
        /// The row, from zero.
        row: usize,
        /// What is wrong with it.
        found: &'static str,
        /// Rows of the files.
        n: usize,
    },
    /// A dof that two interface nodes claim.
    #[error(
        "{dof} belongs to interface {first:?} and to interface {second:?} – expected one owner – take it out of one \
        of them"
    )]
    DofTwice {
        /// The dof.
        dof: String,
        /// First owner.
        first: String,
        /// Second owner.
        second: String,
    },
    /// A rigid patch about a point far outside of the part.
    #[error(
        "interface {interface:?}: its origin ({}) is {} times the size of the part away from its nodes – expected a \
        point near their mean ({}) – give the origin in the unit of the coordinates, or leave it out for the mean",
        place(*origin),
        quantity(*ratio, 2),
        place(*middle)
    )]
    OriginTooFar {
        /// The interface.
        interface: String,
        /// Its origin.
        origin: [f64; 3],
        /// Its distance from the mean of the patch over the size of the part.
        ratio: f64,
        /// The mean of the patch.
        middle: [f64; 3],
    },
    /// Rigid patches that tie all nodes.
    #[error(
        "interface {interface:?}: a rigid patch of {} ties the whole component – found {} of freedom for \
        as many rigid-body motions – expected nodes that are free to deform – leave nodes out of \
        the patch; a rigid part needs no superelement",
        counted(*n_nodes, "node", "nodes"), counted(*n_rigid, "degree", "degrees")
    )]
    WhollyRigid {
        /// The interface.
        interface: String,
        /// Nodes of its patch.
        n_nodes: usize,
        /// Rigid-body motions.
        n_rigid: usize,
    },
    /// A patch that cannot move in all directions of its node.
    #[error(
        "interface {interface:?}: its {} can follow only {rank} of {} of a rigid node – expected three \
        nodes that are not in line – add nodes to the patch or list fewer dofs",
        counted(*n_rows, "row", "rows"), counted(*expected, "motion", "motions")
    )]
    PatchRank {
        /// The interface.
        interface: String,
        /// Rows of the patch.
        n_rows: usize,
        /// Independent motions.
        rank: usize,
        /// Motions asked for.
        expected: usize,
    },
    /// A body without interface that nothing holds.
    #[error(
        "{n_floating} of the {} of the model float free of every interface – the first holds {dof} – \
        expected an interface node on each, or a support – add an interface node there, connect the body or leave it \
        out",
        counted(*n_bodies, "body", "bodies")
    )]
    FloatingBody {
        /// How many.
        n_floating: usize,
        /// Bodies there are.
        n_bodies: usize,
        /// A dof of the first.
        dof: String,
    },
    /// The interface leaves a rigid-body motion free.
    #[error(
        "the interface can react only {rank} of the {}{motion} – expected all – add \
        interface nodes off that axis or give the nodes rotations",
        counted(*n_rigid, "rigid-body motion", "rigid-body motions")
    )]
    InterfaceRank {
        /// Motions it reacts.
        rank: usize,
        /// Motions there are.
        n_rigid: usize,
        /// The free motion in words.
        motion: String,
    },
    /// The digits of K leave open what the reduction rests on.
    #[error(
        "the digits of the stiffness do not tell {what} – {known} – \
        expected entries whose last digit does not decide that – write the stiffness with more digits, best in \
        binary"
    )]
    DigitsTooFew {
        /// What is open.
        what: String,
        /// How well its entries are known.
        known: String,
    },
    /// A pivot of a matrix that should be definite was not positive.
    #[error(
        "the stiffness is not positive definite with {} – elimination stopped at {dof} – expected a positive pivot – \
        the structure has a mechanism there or is unstable, or a penalty far above all else takes its digits",
        held_words(boundary)
    )]
    NotDefinite {
        /// The dof eliminated when it happened.
        dof: String,
        /// `free` or `held`: the interface while it was factored.
        boundary: &'static str,
    },
    /// Eigenvalues of K below zero.
    #[error(
        "the stiffness has {} with {}, by a Sturm count – expected none – the component is \
        preloaded beyond buckling, has negative springs, or its matrix lacks digits, which a penalty far above all \
        else takes too; reduce it at a smaller preload",
        counted(*count, "negative eigenvalue", "negative eigenvalues"), held_words(boundary)
    )]
    IndefiniteStiffness {
        /// How many.
        count: usize,
        /// `free` or `held`.
        boundary: &'static str,
    },
    /// The forecast exceeds the memory there is.
    #[error("{}", forecast(*available, [*factors, *matrices, *vectors], *in_single))]
    MemoryForecast {
        /// Bytes available.
        available: u64,
        /// Bytes of the factors.
        factors: u64,
        /// Bytes of the matrices.
        matrices: u64,
        /// Bytes of the constraint modes and of the eigensolver's basis.
        vectors: u64,
        /// Bytes in all with the factor in single precision, where those are available.
        in_single: Option<u64>,
    },
    /// The forecast of a comparison with the full matrices exceeds the memory there is.
    #[error(
        "the comparison with the full matrices needs {} – {} of memory is available – free memory, raise run.memory_gib of the \
        job, or verify the file by itself",
        bytes(*needed), bytes(*available)
    )]
    MemoryComparison {
        /// Bytes needed.
        needed: u64,
        /// Bytes available.
        available: u64,
    },
    /// An allocation failed.
    #[error("out of memory – {what} could not be allocated – free memory or reduce a smaller model")]
    OutOfMemory {
        /// What was to be allocated.
        what: &'static str,
    },
    /// Conjugate gradients did not bring a solve down to rounding.
    #[error(
        "a solve with the factor kept in single precision stays inaccurate – right-hand side {column} of its block, \
        residual {residual:.1e} of its terms in the worst row after {} of conjugate gradients – expected {aim:.1e} – use \
        precision = \"double\"",
        counted(*steps, "step", "steps")
    )]
    NotRefined {
        /// The right-hand side, from zero.
        column: usize,
        /// max |b − Ax| / (|A||x| + |b|).
        residual: f64,
        /// What was aimed at.
        aim: f64,
        /// Steps that were taken.
        steps: usize,
    },
    /// A pivot of a Sturm count is zero or not a number.
    #[error(
        "the Sturm count met a pivot without a sign – the shift lies on an eigenvalue – ask for one mode more or less"
    )]
    SturmPivot,
    /// Lanczos did not converge.
    #[error(
        "the eigensolver stalled after {} – found {} – ask for another number of modes or another band, or set the \
        other eigensolver in the job",
        counted(*restarts, "restart", "restarts"), counted(*converged, "converged mode", "converged modes")
    )]
    LanczosStalled {
        /// Restarts done.
        restarts: usize,
        /// Pairs that had converged.
        converged: usize,
    },
    /// More zero-energy motions than rigid-body modes.
    #[error(
        "the component is a mechanism – found {} without energy in addition to the {} – expected none – close hinges and \
        sliding joints or give them stiffness",
        counted(*n_more, "motion", "motions"), counted(*n_rigid, "rigid-body mode", "rigid-body modes")
    )]
    Mechanism {
        /// Rigid-body modes.
        n_rigid: usize,
        /// Further zero modes.
        n_more: usize,
    },
    /// The modes found are not all there are.
    #[error(
        "modes are missing below {below_hz:.6} Hz – found {found}, the Sturm count says {counted} – neither another \
        start nor slices of the band found more – use reduction.eigensolver = \"arpack\" (reduce --eigensolver) to \
        compare"
    )]
    ModesMissing {
        /// Frequency of the shift.
        below_hz: f64,
        /// Eigenvalues found, rigid-body modes included.
        found: usize,
        /// Eigenvalues counted.
        counted: usize,
    },
    /// The second eigensolver is not built in.
    #[error(
        "the eigensolver arpack needs the feature \"arpack\", which this program was built without – leave \
        reduction.eigensolver (reduce --eigensolver) out"
    )]
    EigensolverMissing,
    /// The second eigensolver failed.
    #[error(
        "ARPACK failed with status {status} after {converged} converged modes – set eigensolver = \"lanczos\" in the \
        job"
    )]
    Arpack {
        /// Its `info`.
        status: i32,
        /// Pairs that had converged.
        converged: usize,
    },
    /// A file is not a superelement, or cannot be made one.
    #[error("{}: {source}", path.display())]
    SuperelementFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: FileError,
    },
}

impl Error {
    /// The error of this crate for what the superelement file's crate says of the superelement at `path`, read or made.
    pub fn of_superelement(path: &Path, error: FileError) -> Self {
        match error {
            FileError::Read { path, source } => Self::Read { path, source },
            FileError::NotAFile { path } => Self::NotAFile { path },
            source => Self::SuperelementFile { path: path.to_owned(), source },
        }
    }

    /// The error of this crate for what the superelement file's crate says of writing files, whatever is in them.
    pub fn of_writing(error: FileError) -> Self {
        match error {
            FileError::Write { path, source } if source.kind() == std::io::ErrorKind::NotFound => {
                let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
                let folder = folder.unwrap_or(Path::new(".")).to_owned();
                let reason = if folder.is_dir() { "takes no new files" } else { "does not exist" };
                Self::NoFolder { path, folder, reason }
            }
            FileError::Write { path, source } => Self::Write { path, source },
            FileError::NotSynced { path, source } => Self::NotSynced { path, source },
            FileError::HalfWritten { path, source, left } => Self::HalfWritten { path, source, left },
            FileError::NotAFile { path } => Self::OutputKind { path },
            // Content is not looked at.
            source => Self::SuperelementFile { path: PathBuf::from("an output"), source },
        }
    }
}

/// How to go on where a dof map cannot be used.
const BY_ROWS: &str = "go on by rows: leave dof map and nodes out and give interfaces as rows from zero, as in reduce --interface hub=rows:0,1,2";

/// `:12` after a path, where the line is known.
struct At(Option<usize>);

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.map_or(Ok(()), |line| write!(f, ":{line}"))
    }
}

/// The advice after an unknown key.
struct Suggested<'a>(&'a Option<String>);

impl fmt::Display for Suggested<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(key) => write!(f, " – did you mean `{key}`?"),
            None => write!(f, " – remove it; the keys are listed in schemas/job.schema.json"),
        }
    }
}

/// A document as a JSON value; `what` is what an error calls it.
///
/// # Errors
/// [`Error::NotJson`] where a path in it is not UTF-8.
pub(crate) fn json_value(what: &'static str, document: &impl Serialize) -> Result<serde_json::Value> {
    serde_json::to_value(document).map_err(|source| Error::NotJson { what, source })
}

/// What was held while a matrix was factored; a component need not have an interface.
pub(crate) fn held_words(boundary: &str) -> &'static str {
    if boundary == "held" { "the interface held" } else { "no interface held" }
}

/// The first part of a path that is not UTF-8.
fn not_text(path: &Path) -> &OsStr {
    path.iter().find(|part| part.to_str().is_none()).unwrap_or(path.as_os_str())
}

/// The groups of a file of nodes; a table and some meshes have none.
fn groups(known: &[String]) -> String {
    match known {
        [] => "the file of the nodes has no groups, as a table of nodes – list node labels or give a region".to_owned(),
        _ => format!("the mesh has {} – name one of them", listed(known)),
    }
}

/// Names for a message: the first few, and how many more there are.
fn listed(names: &[String]) -> String {
    const SHOWN: usize = 12;
    match names.len() {
        0 => "nothing".to_owned(),
        n if n > SHOWN => format!("{} and {} more", names[..SHOWN].join(", "), n - SHOWN),
        _ => names.join(", "),
    }
}

/// The parts of a forecast, the largest first, and what makes that one smaller.
fn forecast(available: u64, [factors, matrices, vectors]: [u64; 3], in_single: Option<u64>) -> String {
    let mut parts = [
        (factors, "factors", "use a weaker run.certify (reduce --certify), which needs fewer factors"),
        (vectors, "vectors", "keep fewer modes or interface dofs"),
        (matrices, "matrices", "reduce a smaller model"),
    ];
    parts.sort_by_key(|(size, ..)| std::cmp::Reverse(*size));
    let needed = parts.iter().fold(0, |sum: u64, (size, ..)| sum.saturating_add(*size));
    let largest_first = parts.map(|(size, name, _)| format!("{name} {}", bytes(size))).join(", ");
    let (needed, available) = (bytes(needed), bytes(available));
    let advice = match in_single {
        Some(needed) => format!("set run.precision = \"mixed\", which needs {}", bytes(needed)),
        None => parts[0].2.to_owned(),
    };
    format!(
        "the run needs {needed} – largest first: {largest_first} – {available} of memory is available – free memory, raise \
        run.memory_gib, or {advice}"
    )
}

/// A point, to six digits.
fn place(point: [f64; 3]) -> String {
    point.map(|x| quantity(x, 6)).join(", ")
}
