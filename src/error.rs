//! Every way in which a run can fail. Each has one variant, with the values that explain it.
//!
//! A message reads *what – where – found – expected – what to do*, in lower case and without a full stop. The variant
//! decides the exit code, so that a CI job can tell bad input from a bad model from a full disk. Everything that is said of an error
//! stands at its variant, and `docs/errors.md` is made from it; so this is one long table, in the order of the stages. Nobody handles the
//! errors of one stage apart from those of another, so that stages have no types of their own.

mod code;
mod selector;
mod warning;
mod words;

use std::path::{Path, PathBuf};

use macro_rules_attribute::apply;
use serde::Serialize;
use supel_runtime::{FileError, MatrixKind};

use code::catalogued;
use words::{
    At, BY_ROWS, OFF_THE_AXIS, Offered, ROWS_THAT_MOVE, SIX_DOFS, SOFTER_THAN_DIGITS, STATE_DIGITS, Suggested,
    and_more, at_line, column_words, forecast, groups, kinetic_energy, listed, multipliers, named_matrices, not_text,
    of_file, place, quoted, unloaded_reacts_nothing,
};

use crate::number::{bytes, count, counted, quantity, typed};

pub use code::{ErrorClass, ErrorEntry, INTERNAL_CODE, USAGE_CODE};
pub use selector::Selector;
pub use warning::Warning;
pub(crate) use words::held_words;
pub use words::{Uncertain, Unnamed};

/// The result of every fallible call of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why a run failed. Each variant belongs to one [`ErrorClass`], which is its exit code.
#[apply(catalogued)]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be opened or read.
    #[entry("E-READ", Io, "check the path and the permissions; the system's reason is in the message")]
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file cannot be written.
    #[entry("E-WRITE", Io, "check that the folder exists, is writable and has room")]
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The folder of an output does not exist or takes no files.
    #[entry("E-FOLDER", Io, "create it, or give the output another place")]
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
    /// The outputs are written, but the system did not confirm that they are on the disk.
    #[entry("E-SYNC", Io, "sync the disk or write them again; they may not outlive a power cut")]
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
    /// An output cannot be written, and those before it cannot be taken back.
    #[entry(
        "E-HALF-WRITTEN",
        Io,
        "the message says which files are new and where their old content is: put it back or run again"
    )]
    #[error("{}: cannot be written: {source} – {left} – put the old files back or run again", path.display())]
    HalfWritten {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
        /// Which files are new and where their old content is, in words.
        left: String,
    },
    /// The answer could not be written to stdout; files were written all the same.
    #[entry("E-STDOUT", Io, "give stdout a place with room; `reduce` and `verify` give no answer with `--quiet`")]
    #[error("the answer could not be written to stdout: {source} – give stdout a place with room")]
    Answer {
        /// What the system said.
        source: std::io::Error,
    },
    /// A path is a folder, a pipe, a device or made up by the kernel.
    #[entry("E-NOT-A-FILE", InputData, "give a regular file; write a pipe to disk first")]
    #[error("{}: not a regular file – give the path of a file on disk", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// A file was written, cut or exchanged while it was read.
    #[entry("E-CHANGED", Io, "wait until it is written and run again")]
    #[error(
        "{}: changed while it was read – expected one size, time and file from beginning to end – wait until it is \
        written and run again",
        path.display()
    )]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// An XDMF file is not UTF-8; rows of a table that are not end with E-TABLE-FIELD, and matrices, dof maps and comments may hold any
    /// bytes where no number belongs.
    #[entry("E-UTF8", InputData, "write it as UTF-8")]
    #[error("{}: byte {offset} is not UTF-8 text – write the file as UTF-8", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Where the first byte is that is none, from 0.
        offset: usize,
    },
    /// What the input files hold does not fit into the memory.
    #[entry("E-MEM-READ", Resources, "free memory, raise `run.memory_gib` or reduce a smaller model")]
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
    /// A file of a known format that is not read: NumPy, MATLAB before 7.3, Gmsh, an input deck, CalculiX results, zip.
    #[entry("E-FORMAT", InputData, "convert it as the message says")]
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
    /// Packed data (gzip, bzip2, zstd, members of a zip archive) are damaged or cut short.
    #[entry("E-PACKED", InputData, "copy or create the file again")]
    #[error(
        "{}: the {data} are damaged or cut short behind the first {} that could be unpacked – {source} – copy or create the file again",
        path.display(),
        counted(*unpacked, "byte", "bytes")
    )]
    PackedDamaged {
        /// The file.
        path: PathBuf,
        /// How they are packed, in words.
        data: &'static str,
        /// Bytes that were unpacked before the damage.
        unpacked: u64,
        /// What the decoder said.
        source: std::io::Error,
    },
    /// Packed data (gzip, bzip2, zstd) expand more than a table of numbers can.
    #[entry("E-PACKED-BOMB", InputData, "check where the file comes from")]
    #[error(
        "{}: the {data} expand too far – found {unpacked} bytes from {packed} – expected at most {limit} \
        times their size, which tables of numbers keep to – check where the file comes from",
        path.display()
    )]
    PackedExpansion {
        /// The file.
        path: PathBuf,
        /// How they are packed, in words.
        data: &'static str,
        /// Packed bytes read so far.
        packed: u64,
        /// Bytes they became.
        unpacked: u64,
        /// Largest ratio that is accepted.
        limit: u64,
    },
    /// A line is longer than any line of numbers.
    #[entry("E-LINE", InputData, "check that the file is text")]
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
    #[entry("E-NO-DATA", InputData, "export it again; the message says what belongs there")]
    #[error("{}: the file holds no data – expected {expected}", path.display())]
    NoData {
        /// The file.
        path: PathBuf,
        /// What belongs there.
        expected: &'static str,
    },
    /// The first line of a matrix is neither a Matrix Market banner nor numbers.
    #[entry(
        "E-BANNER",
        InputData,
        "write `%%MatrixMarket matrix coordinate real symmetric`, or lines `row column value`"
    )]
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
    /// A Matrix Market flavour other than coordinate or array, real or integer, symmetric or general.
    #[entry(
        "E-FLAVOUR",
        InputData,
        "export a real matrix, as coordinate or as array; complex and pattern matrices are no stiffness or mass"
    )]
    #[error(
        "{}:{line}: a Matrix Market flavour that is not read – found `{found}` – expected `coordinate` or `array`, of `real` or \
        `integer`, each `symmetric` or `general`, or of a further matrix `skew-symmetric`",
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
    /// The size line of a matrix cannot be read.
    #[entry("E-SIZE-LINE", InputData, "write `rows columns entries` below the banner")]
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
    #[entry("E-DIM-SQUARE", InputData, "export K and M as square matrices")]
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
    /// A matrix has no rows, or more than 2³¹ − 1.
    #[entry("E-DIM-ORDER", InputData, "check the size line and the largest index")]
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
    /// A large matrix has hardly any entries.
    #[entry("E-MOSTLY-EMPTY", InputData, "check the size line and the indices")]
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
    #[entry("E-ENTRY", InputData, "correct the line; decimal commas are not read")]
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
    /// A line goes on after the value.
    #[entry("E-ENTRY-EXCESS", InputData, "leave one entry on a line")]
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
    /// An index is 0 or larger than the matrix.
    #[entry("E-INDEX", InputData, "count rows and columns from 1")]
    #[error(
        "{}:{line}: {field} {} lies outside the matrix – expected 1 to {n}, because indices count from 1",
        path.display(),
        if *found == u64::MAX { format!("{found} or more") } else { found.to_string() }
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
    /// A matrix entry is NaN or infinite.
    #[entry("E-NONFINITE", InputData, "find out why the finite element program wrote it")]
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
    /// A file holds fewer entries than it declares.
    #[entry("E-NNZ", InputData, "the file is cut short: export or copy it again")]
    #[error(
        "{}:{line}: entries are missing – found the end of the file after {found} – expected the {declared} that the size line \
        declares – the file may be cut short: write or copy it again",
        path.display()
    )]
    EntryCount {
        /// The file.
        path: PathBuf,
        /// Number of its last line, from 1.
        line: u64,
        /// Entries declared.
        declared: u64,
        /// Entries found.
        found: u64,
    },
    /// A file holds more entries than it declares.
    #[entry("E-NNZ-SURPLUS", InputData, "correct the size line or export again")]
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
    /// Entries repeat a position, with `--strict` or `duplicates = "refuse"`.
    #[entry(
        "E-DUPLICATES",
        InputData,
        "assemble the matrix before exporting it, or leave both out: repeated entries are then added"
    )]
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
    /// A matrix declared symmetric gives a pair of a row and a column twice.
    #[entry(
        "E-DOUBLE-TRIANGLE",
        InputData,
        "give each pair of a row and a column once, in whichever order, declare the matrix general, or say which triangle holds with \
        `model.symmetric` (`reduce --symmetric`)"
    )]
    #[error(
        "{}: declared {declared} – found a pair given twice, at ({}, {}) and ({}, {}) – expected each pair of a row and \
        a column once – {remedy}",
        path.display(), lower.0, lower.1, upper.0, upper.1
    )]
    DoubleTriangle {
        /// The file.
        path: PathBuf,
        /// What the file declares.
        declared: &'static str,
        /// What to do.
        remedy: &'static str,
        /// Row and column, from 1, of the entry below the diagonal.
        lower: (u64, u64),
        /// Row and column, from 1, of the entry above the diagonal.
        upper: (u64, u64),
    },
    /// A matrix declared skew-symmetric has an entry on its diagonal.
    #[entry("E-SKEW-DIAGONAL", InputData, "leave the diagonal out, or declare the matrix general")]
    #[error(
        "{}: declared skew-symmetric – at row {row} – found {value} on the diagonal – expected none, as it would be its own \
        negative – leave the diagonal out, or declare the matrix general",
        path.display()
    )]
    SkewDiagonal {
        /// The file.
        path: PathBuf,
        /// Row and column, from 1.
        row: u64,
        /// The entry.
        value: f64,
    },
    /// A superelement is not the model that it is read as.
    #[entry("E-NO-MODEL", InputData, "reduce the full model, or what `supel export` writes")]
    #[error("{}: this superelement {found} – expected one that is a model – {remedy}", path.display())]
    NoModel {
        /// The file.
        path: PathBuf,
        /// What speaks against it.
        found: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// Parts of a model come from several superelements.
    #[entry("E-OTHER-SUPERELEMENT", InputData, "give one superelement for all that superelements are to say")]
    #[error(
        "{}: a superelement for {what} of a job whose stiffness is {}, another file – expected the same one, because rows of modal \
        amplitudes mean something else in every superelement – give the file of the stiffness",
        path.display(), stiffness.display()
    )]
    OtherSuperelement {
        /// The file.
        path: PathBuf,
        /// What it is read for.
        what: &'static str,
        /// The file of K.
        stiffness: PathBuf,
    },
    /// K and M are one matrix.
    #[entry("E-SAME-MATRIX", InputData, "give the file of the other one")]
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
    #[entry("E-DIM", InputData, "export both for the same degrees of freedom")]
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
    #[entry("E-TABLE-COLUMN", InputData, "name the columns as the message says")]
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
    /// A row of a table has fewer or more fields than its header.
    #[entry("E-TABLE-ROW", InputData, "give each column one field; decimals take a point")]
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
    /// A table of states lacks a column of a coordinate, has one twice, or has another one.
    #[entry(
        "E-STATE-COLUMN",
        InputData,
        "give each coordinate one column, as `supel inspect --coordinates` prints them"
    )]
    #[error(
        "{}: {found} – expected one column for each of {}, and `time` where it is known{} –         `supel inspect --coordinates` prints such a header",
        path.display(), counted(*n as u64, "coordinate", "coordinates"), Offered(suggestion)
    )]
    StateColumn {
        /// The file.
        path: PathBuf,
        /// What is wrong with the header.
        found: String,
        /// Coordinates of the superelement.
        n: usize,
        /// The coordinate that was probably meant.
        suggestion: Option<String>,
    },
    /// Velocities or accelerations are those of other states.
    #[entry("E-STATE-ROWS", InputData, "write all tables from the same steps")]
    #[error("{}: {found} – expected the states of {}, row by row – write both from the same steps", path.display(), of.display())]
    StateRows {
        /// The table of the velocities or accelerations.
        path: PathBuf,
        /// What is different.
        found: String,
        /// The table of the states.
        of: PathBuf,
    },
    /// A field of a table cannot be read.
    #[entry("E-TABLE-FIELD", InputData, "correct it; decimals take a point")]
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
    #[entry("E-NODE-REPEATED", InputData, "list each node once")]
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
    /// Coordinates are so large or so small that their squares leave the range of double precision.
    #[entry("E-NODE-RANGE", InputData, "check the number, or write the nodes in other units")]
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
    #[entry("E-MAP-TEXT", InputData, "write for example 412.1")]
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
    #[entry("E-MAP-DIRECTION", InputData, "write 1 to 6 or ux to rz")]
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
    #[entry(
        "E-MAP-REPEATED",
        InputData,
        "give every row its own; of shells and beams of CalculiX leave .12d and .frd next to the map; or go on by rows"
    )]
    #[error(
        "{}: rows {first_row} and {row} are both {direction} of node {node}, and {repeated} repeat a dof – expected \
        every degree of freedom once (rows count from 1; programs that expand shells or beams into solids repeat \
        labels) – where CalculiX did, put `*NODE OUTPUT, OUTPUT=3D` into a step before the one that stores the matrices \
        and leave its .12d and .frd next to the map, or {BY_ROWS}",
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
    /// Row numbers of a dof map are not in order.
    #[entry("E-MAP-ORDER", InputData, "sort the map by row; every row of the matrices needs one")]
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
    #[entry("E-MAP-COUNT", InputData, "export map and matrices together")]
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
    /// A node of the dof map has no position.
    #[entry("E-MAP-NODE", InputData, "add it to the nodes, leave the nodes out, or go on by rows")]
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
    /// Axes of a node or of a coordinate system are none.
    #[entry(
        "E-FRAME-AXES",
        InputData,
        "give two directions that span a plane, and the third axis right-handed or not at all"
    )]
    #[error(
        "{}:{line}: {found} – expected right-handed axes – correct the directions, or write the matrices along the axes of the model",
        path.display()
    )]
    FrameAxes {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What was found, in words.
        found: String,
    },
    /// Axes of nodes have too few digits: rigid-body motions make forces that only their rounding explains.
    #[entry(
        "E-FRAME-DIGITS",
        InputData,
        "write the axes with all their digits, five decimals at least; a direction may have any length, so that whole numbers can stand \
         for it"
    )]
    #[error(
        "{}:{line}: {found}: rows and axes of the model are turned against each other by {} rad at least – expected axes with all their digits, \
         {} decimals at least: the stiffness knows the angle better – write more digits; a direction may have any length, so that 1,1,0 \
         is exact and 0.7,0.7,0 is taken as rounded",
        path.display(), quantity(*angle, 2), crate::dofs::AxisDigits::ENOUGH
    )]
    FrameDigits {
        /// The table.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Node, digits and effect, in words.
        found: String,
        /// How far the axes are turned at least.
        angle: f64,
    },
    /// A node with axes of its own lacks rows of one of its directions.
    #[entry(
        "E-FRAME-ROWS",
        InputData,
        "write the matrices without the support that took the row, or along the axes of the model; check that map and axes belong together"
    )]
    #[error(
        "{}: node {node} has axes of its own, and only the rows {found} – expected all three translations, and all three rotations or \
        none: the others cannot be turned to the axes of the model – write the matrices without the support that took the rest, or \
        along the axes of the model",
        path.display()
    )]
    FrameRows {
        /// The file of the axes.
        path: PathBuf,
        /// Label of the node.
        node: i64,
        /// The rows that are there.
        found: String,
    },
    /// Axes are given for nodes of which none has rows.
    #[entry("E-FRAME-NODES", InputData, "check that the axes are of this model, and give a dof map")]
    #[error(
        "{}: axes of {}, of which {found} – expected nodes of the model – check that the file is of this model, and give a dof map",
        path.display(), counted(*n_nodes, "node", "nodes")
    )]
    FrameNodes {
        /// The file of the axes.
        path: PathBuf,
        /// Nodes in it.
        n_nodes: usize,
        /// What was found, in words.
        found: &'static str,
    },
    /// Two decks state other axes of a node.
    #[entry(
        "E-FRAME-DIFFER",
        InputData,
        "take the decks of one run, or give the axes that the rows are along with `model.frames`"
    )]
    #[error(
        "{}: node {node} is {}, and in {} it is {} – expected one set of axes for the rows of all files of a model – take the decks of \
         one run, or give the axes that the rows are along with `model.frames`",
        paths[0].display(), along[0], paths[1].display(), along[1]
    )]
    FrameDiffer {
        /// The decks.
        paths: [PathBuf; 2],
        /// Label of the first such node.
        node: i64,
        /// What each states, in words.
        along: [String; 2],
    },
    /// Without a dof map the counts do not say what the rows are.
    #[entry("E-MAP-NEEDED", InputData, "give a dof map with `model.dofs` (`reduce --dofs`)")]
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
    /// The program was built without what a file needs.
    #[entry("E-FEATURE", Usage, "rebuild with the feature that the message names")]
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
    #[entry("E-HDF5-SIGNATURE", InputData, "give the file that the name promises")]
    #[error("{}: not an HDF5 file – found {found} – expected the HDF5 signature – {advice}", path.display())]
    Hdf5Signature {
        /// The file.
        path: PathBuf,
        /// What its first bytes look like.
        found: &'static str,
        /// What to do about it.
        advice: &'static str,
    },
    /// An HDF5 file is damaged.
    #[entry("E-HDF5-OPEN", InputData, "write or copy it again")]
    #[error("{}: a damaged HDF5 file – the HDF5 library says: {reason} – write or copy the file again", path.display())]
    Hdf5Open {
        /// The file.
        path: PathBuf,
        /// The library's words.
        reason: String,
    },
    /// The HDF5 library crashes on a damaged file, or for want of memory, in the child process that reads it first.
    #[entry("E-HDF5-CRASH", InputData, "copy or create the file again, or give more memory")]
    #[error(
        "{}: the HDF5 library crashes when it reads it – a damaged file, or memory that ran out within the library – write or copy the \
         file again, or give more memory",
        path.display()
    )]
    Hdf5Crash {
        /// The file.
        path: PathBuf,
    },
    /// The HDF5 library was still reading a file long after it should have been done.
    #[entry("E-HDF5-TIME", InputData, "look at it with h5dump; write or copy it again")]
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
    /// The child process that reads HDF5 input first was ended from outside, as the system does when memory runs out.
    #[entry("E-CHILD-KILLED", Resources, "free memory and run again")]
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
    /// The child process that reads HDF5 input first cannot be started.
    #[entry("E-CHILD", Resources, "free processes or memory; the system's reason is in the message")]
    #[error("no child process can be started to read the HDF5 input first – {source}")]
    Rehearsal {
        /// What the system said.
        source: std::io::Error,
    },
    /// An object of an HDF5 file cannot be read.
    #[entry("E-HDF5-READ", InputData, "write or copy the file again; the library's reason is in the message")]
    #[error("{}:{object}: cannot be read – the HDF5 library says: {reason}", path.display())]
    Hdf5Read {
        /// The file.
        path: PathBuf,
        /// Path of the object in the file.
        object: String,
        /// The library's words.
        reason: String,
    },
    /// A group, dataset or attribute is not there.
    #[entry("E-HDF5-MISSING", InputData, "check the path after the colon")]
    #[error("{}:{object}: there is no such {kind} in the file", path.display())]
    Hdf5Missing {
        /// The file.
        path: PathBuf,
        /// Path of the object in the file.
        object: String,
        /// Group, dataset or attribute.
        kind: &'static str,
    },
    /// A path leads through a soft or external link.
    #[entry("E-HDF5-LINK", InputData, "give the path of the object itself")]
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
    /// A dataset keeps its values in other files.
    #[entry("E-HDF5-EXTERNAL", InputData, "repack the file with h5repack")]
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
    #[entry("E-HDF5-FILTER", InputData, "rewrite it with `h5repack -f GZIP=4`")]
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
    /// A dataset promises more than its bytes can hold.
    #[entry(
        "E-HDF5-SIZE",
        InputData,
        "the file is damaged or was never finished, or chunks were left out that would have fill values: write it again, all of it"
    )]
    #[error(
        "{}:{object}: promises {promised} – its stored bytes can hold at most {} – the file is damaged, or \
        not all of the dataset was written: write the values of every chunk, zeros as well",
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
    /// Groups are nested or numerous beyond reason.
    #[entry("E-HDF5-DEPTH", InputData, "write the file again; its groups may contain themselves")]
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
    /// An object or value has the wrong type.
    #[entry("E-HDF5-TYPE", InputData, "store it as the message says")]
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
    /// A number cannot be read as it is: an unsigned one of 2⁶³ or more, or a whole one that no double equals.
    #[entry("E-HDF5-VALUE", InputData, "store real numbers as 64-bit floats, indices as signed integers")]
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
    /// A dataset has the wrong length or shape.
    #[entry("E-HDF5-SHAPE", InputData, "store it as the message says")]
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
    #[entry("E-HDF5-NO-MATRIX", InputData, "give its group after a colon, as in model.h5:/K")]
    #[error(
        "{}:{group}: no sparse matrix – found {} – expected a MATLAB v7.3 or PETSc (`MATLAB_sparse`), anndata, \
        h5sparse, Exudyn, Octave, Julia or Binsparse group, or one with data, indices and indptr",
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
    /// A further matrix is not symmetric, and no number of its layout says whether rows or columns are compressed.
    #[entry(
        "E-HDF5-ORIENTATION",
        InputData,
        "write it as MATLAB does (`MATLAB_sparse`, `jc`, `ir`, `data`), or as a Matrix Market file"
    )]
    #[error(
        "{}:{group}: found a matrix that is not symmetric, in a layout that says in a text, which is not read, or nowhere whether rows or \
        columns are compressed – expected a symmetric one, or the layout of MATLAB – write a Matrix Market file",
        path.display()
    )]
    Hdf5Orientation {
        /// The file.
        path: PathBuf,
        /// The group.
        group: String,
    },
    /// An index lies outside the matrix or the mesh.
    #[entry("E-HDF5-INDEX", InputData, "write the matrix or mesh again")]
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
    /// Several matrices of a file could be meant.
    #[entry("E-MATRIX-AMBIGUOUS", InputData, "choose one, as in model.h5:/K or model.op4:KAA")]
    #[error(
        "{}: no single matrix whose name says {role} – found {} – choose one, as in {}:{}",
        path.display(), listed(matrices), path.display(), matrices.first().map_or("K", String::as_str)
    )]
    MatrixAmbiguous {
        /// The file.
        path: PathBuf,
        /// Stiffness or mass.
        role: &'static str,
        /// The matrices that could be meant.
        matrices: Vec<String>,
    },
    /// A file has several matrices of one name.
    #[entry("E-SAME-NAME", InputData, "write the file anew with one of them")]
    #[error(
        "{}: several matrices of one name – found {n} that are called {name} – expected one – write the file anew with the one that is meant: \
         what a second run writes behind the first stays there",
        path.display()
    )]
    MatrixNameTwice {
        /// The file.
        path: PathBuf,
        /// The name.
        name: String,
        /// How many there are.
        n: usize,
    },
    /// A file has no matrix of the name that follows its own.
    #[entry("E-NO-SUCH-MATRIX", InputData, "give one of the names in the message after the colon")]
    #[error("{}:{name}: no such matrix – {}", path.display(), named_matrices(holds))]
    MatrixName {
        /// The file.
        path: PathBuf,
        /// The name asked for.
        name: String,
        /// The matrices there are.
        holds: Vec<String>,
    },
    /// A file has no matrix that can be read.
    #[entry("E-NO-MATRIX", InputData, "check which file the finite element program wrote the matrices to")]
    #[error("{}: no matrix ({format}) – found {} – expected {expected}", path.display(), listed(holds))]
    MatrixNone {
        /// The file.
        path: PathBuf,
        /// The format.
        format: &'static str,
        /// What there is in place of a matrix.
        holds: Vec<String>,
        /// What would be read.
        expected: &'static str,
    },
    /// A matrix of a file with named parts is not square, has no rows, or too many.
    #[entry("E-MATRIX-SIZE", InputData, "export K and M as square matrices")]
    #[error(
        "{}:{matrix}: found a matrix of {n_rows} × {n_cols} – expected a square one of 1 to {limit} rows",
        path.display()
    )]
    MatrixSize {
        /// The file.
        path: PathBuf,
        /// The matrix in it.
        matrix: String,
        /// Number of rows.
        n_rows: u64,
        /// Number of columns.
        n_cols: u64,
        /// Most rows.
        limit: u64,
    },
    /// An array of a matrix has not as many values as the others ask.
    #[entry("E-MATRIX-LENGTH", InputData, "write the matrix again")]
    #[error("{}:{array}: found {found} – expected {expected}", path.display())]
    MatrixLength {
        /// The file.
        path: PathBuf,
        /// The array.
        array: String,
        /// Values found.
        found: String,
        /// Values expected, and where that comes from.
        expected: String,
    },
    /// Row or column pointers do not rise from zero to the number of entries.
    #[entry("E-MATRIX-POINTER", InputData, "write the matrix again")]
    #[error("{}:{array}: pointer {position} is {found} – expected {expected}", path.display())]
    MatrixPointer {
        /// The file.
        path: PathBuf,
        /// The array of the pointers.
        array: String,
        /// Position in the array, from zero.
        position: usize,
        /// The pointer there.
        found: i64,
        /// What it must be.
        expected: String,
    },
    /// An index lies outside the matrix.
    #[entry("E-MATRIX-INDEX", InputData, "write the matrix again")]
    #[error("{}:{array}: entry {position} is {found} – expected {first} to {last}", path.display())]
    MatrixIndex {
        /// The file.
        path: PathBuf,
        /// The array of the indices.
        array: String,
        /// Position in the array, from zero.
        position: usize,
        /// The index there.
        found: i64,
        /// Smallest index allowed.
        first: i64,
        /// Largest index allowed.
        last: i64,
    },
    /// An entry of a matrix in numbers of fixed size is NaN or infinite.
    #[entry("E-MATRIX-NONFINITE", InputData, "find out why the finite element program wrote it")]
    #[error(
        "{}:{matrix}: the entry of row {row}, column {col} (both from 1) is {value} – expected a finite number",
        path.display()
    )]
    MatrixNotFinite {
        /// The file.
        path: PathBuf,
        /// The matrix, or the array of its values.
        matrix: String,
        /// Row, from one.
        row: u64,
        /// Column, from one.
        col: u64,
        /// The value.
        value: f64,
    },
    /// A file of matrices is not what its format asks: cut short, damaged, or written by a program with rules of its own.
    #[entry("E-MATRIX-FORMAT", InputData, "write or copy the file again")]
    #[error("{}: {format}, {place} – found {found} – expected {expected}", path.display())]
    MatrixFormat {
        /// The file.
        path: PathBuf,
        /// The format.
        format: &'static str,
        /// Line or byte, or part of the file.
        place: String,
        /// What stands there.
        found: String,
        /// What the format asks.
        expected: Box<str>,
    },
    /// A matrix is of a kind that is not read: complex, of text, of single marks.
    #[entry("E-MATRIX-UNREAD", InputData, "write a real matrix in double precision")]
    #[error("{}: {format}, {place} – {found} – not read – expected {expected}", path.display())]
    MatrixUnread {
        /// The file.
        path: PathBuf,
        /// The format.
        format: &'static str,
        /// The matrix, or where it stands.
        place: String,
        /// What it is.
        found: String,
        /// What is read.
        expected: &'static str,
    },
    /// The content of a file fits several formats.
    #[entry("E-FORMAT-AMBIGUOUS", InputData, "name the format by `layout` in the job, or by `reduce --layout`")]
    #[error(
        "{}: its content fits several formats – found {} – name the one that it is by `layout` in the job, or by reduce --layout {}",
        path.display(), listed(formats), formats.first().map_or("", String::as_str)
    )]
    FormatAmbiguous {
        /// The file.
        path: PathBuf,
        /// Their names.
        formats: Vec<String>,
    },
    /// One matrix names nodes and directions of its rows, another one does not, and no dof map says which rows those are; or nothing names
    /// those of a matrix whose names are asked for.
    #[entry(
        "E-ROWS-UNNAMED",
        InputData,
        "give the dof map where the message asks for it, or write both matrices in one format"
    )]
    #[error("{}: {}", path.display(), of.in_words())]
    RowsUnnamed {
        /// The file of a matrix.
        path: PathBuf,
        /// What names would be needed for.
        of: Unnamed,
    },
    /// A matrix names rows that the dof map, or the other matrices, do not have.
    #[entry("E-ROW-UNKNOWN", InputData, "write dof map and matrices from one model")]
    #[error(
        "{}: rows that the others do not have – found {} – expected those of the {n_rows} rows of the dof map or of K and M – write \
        all of them from one model",
        path.display(), listed(missing)
    )]
    RowUnknown {
        /// The file of the matrix.
        path: PathBuf,
        /// Node and direction of each row that is not there.
        missing: Vec<String>,
        /// Rows that are there.
        n_rows: usize,
    },
    /// No known mesh is in the file.
    #[entry("E-MESH", InputData, "give a mesh in a format of docs/meshes.md, or a node table")]
    #[error(
        "{}: no mesh that can be read – found {} – expected .hmf (/domain/grid/Geometry), .med (/ENS_MAA), \
        .h5m (/tstt), VTKHDF (/VTKHDF), Exodus or CGNS",
        path.display(), listed(holds)
    )]
    MeshUnknown {
        /// The file.
        path: PathBuf,
        /// The objects at its top.
        holds: Vec<String>,
    },
    /// No or several meshes, time steps or geometries.
    #[entry("E-MESH-NOT-ONE", InputData, "leave one in the file")]
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
    /// A property of a mesh is not supported.
    #[entry("E-MESH-UNSUPPORTED", InputData, "export it as the message says")]
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
    /// A coordinate is NaN or infinite.
    #[entry("E-MESH-NONFINITE", InputData, "export the mesh again")]
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
    /// Two nodes of a mesh have one label.
    #[entry("E-MESH-LABEL", InputData, "renumber the nodes")]
    #[error("{}:{object}: two nodes have the label {label} – expected each label once", path.display())]
    MeshLabelTwice {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        object: String,
        /// The label.
        label: i64,
    },
    /// An XDMF file is not well-formed XML.
    #[entry("E-XDMF", InputData, "write it again")]
    #[error("{}: not well-formed XML: {source}", path.display())]
    XdmfSyntax {
        /// The file.
        path: PathBuf,
        /// What is wrong and where.
        source: roxmltree::Error,
    },
    /// An XDMF file has more attributes or namespaces than any mesh.
    #[entry("E-XDMF-SIZE", InputData, "write it again")]
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
    /// An XDMF file names data outside its own folder.
    #[entry("E-XDMF-REFERENCE", InputData, "move the data next to it")]
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
    /// A line of a mesh in text is not what its format has there, or the text ends too early.
    #[entry("E-MESH-TEXT", InputData, "correct the line, or export the mesh again where it ends too early")]
    #[error("{}:{line}: found {found} – expected {expected} – correct the line, or export the mesh again", path.display())]
    MeshText {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// What is there.
        found: String,
        /// What belongs there.
        expected: String,
    },
    /// A binary mesh holds something that its format does not have there, or ends too early.
    #[entry("E-MESH-BINARY", InputData, "export the mesh again, or as text")]
    #[error("{}: at byte {offset} – found {found} – expected {expected} – export the mesh again, or as text", path.display())]
    MeshBinary {
        /// The file.
        path: PathBuf,
        /// Where it is, from 0.
        offset: u64,
        /// What is there.
        found: String,
        /// What belongs there.
        expected: String,
    },
    /// A deck includes a file that is not in its folder, or more files than any deck does.
    #[entry(
        "E-INCLUDE",
        InputData,
        "put the file into the folder of the deck and name it by a relative path; take out what includes itself"
    )]
    #[error(
        "{}:{line}: includes `{reference}`, {reason} – expected {expected}",
        path.display()
    )]
    DeckInclude {
        /// The file with the line.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The name as it is written.
        reference: String,
        /// Why it is not read.
        reason: &'static str,
        /// What is expected in its place, and what to do.
        expected: &'static str,
    },
    /// A deck makes its mesh by something that is not read.
    #[entry("E-DECK", InputData, "have the program write out the mesh, as the message says")]
    #[error("{}:{line}: {found} – {advice}", path.display())]
    DeckUnsupported {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// What is there, in words.
        found: String,
        /// The way round.
        advice: &'static str,
    },
    /// The groups of a mesh have more members than nodes and elements of a real mesh.
    #[entry("E-GROUPS", InputData, "export the mesh again with fewer groups")]
    #[error(
        "{}: its groups have more than {limit} members – expected no more than 64 groups at a node or element – export it \
        again with fewer groups",
        path.display()
    )]
    MeshGroups {
        /// The file.
        path: PathBuf,
        /// Members that are too many.
        limit: usize,
    },
    /// The job document is not valid TOML or JSON, or a value has the wrong kind.
    #[entry("E-JOB", Usage, "correct the line")]
    #[error("{}{}: {message}", path.display(), At(*line))]
    JobSyntax {
        /// The job document.
        path: PathBuf,
        /// Line of the document, from one, where it is known.
        line: Option<usize>,
        /// What the parser said.
        message: String,
    },
    /// The job document holds an unknown key.
    #[entry("E-JOB-KEY", Usage, "use the key the message offers, or remove it")]
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
    #[entry("E-ARG", Usage, "give one in the range of the message")]
    #[error("`{key}` is {} – expected {expected}", typed(*value))]
    JobNumber {
        /// Path of the key.
        key: String,
        /// The number found.
        value: f64,
        /// The range.
        expected: &'static str,
    },
    /// A text or list of the job is empty.
    #[entry("E-JOB-EMPTY", Usage, "fill it or remove the key")]
    #[error("`{key}` is empty – expected {expected}")]
    JobEmpty {
        /// Path of the key.
        key: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// The job has no modes where its method needs them, or modes that its method does not take.
    #[entry(
        "E-JOB-MODES",
        Usage,
        "say how many modes are kept, name their file with the method mode-acceleration, or remove the key with the method \
         guyan"
    )]
    #[error("`reduction.modes` is {found} – {expected}")]
    JobModes {
        /// Whether the key is there.
        found: &'static str,
        /// What the method needs.
        expected: String,
    },
    /// A preloaded state without its internal forces, or internal forces without the state.
    #[entry(
        "E-JOB-PRELOAD",
        Usage,
        "give `model.state = \"preloaded\"` and `model.internal_forces` together, or neither of them"
    )]
    #[error("`model.internal_forces` is {found} {}", if *found == "given" { "without `model.state = \"preloaded\"` – say so, or remove the key" } else { "with `model.state = \"preloaded\"` – expected the file of the forces that rotations are compared with; the state is not taken without" })]
    JobPreload {
        /// Whether the key is there.
        found: &'static str,
    },
    /// The job names no mass, and what it asks depends on one.
    #[entry(
        "E-JOB-MASS",
        Usage,
        "name the file of M; a static scene with `gravity = false`, without loads of rotation, added masses or an expected mass needs none"
    )]
    #[error(
        "`model.mass` is missing – expected the file of M; a scene with analysis = \"static\" and gravity = false needs none, unless loads \
        of rotation, added masses, an expected mass or a preloaded state do"
    )]
    JobMass,
    /// Two interfaces have one name.
    #[entry("E-INTERFACE-NAME", Usage, "give each its own")]
    #[error("interface `{name}` is defined twice – names must be unique")]
    InterfaceTwice {
        /// The name.
        name: String,
    },
    /// What is held while modes are computed is missing with the method of mixed boundaries, or there with another method.
    #[entry(
        "E-JOB-HELD",
        Usage,
        "say what is held while the modes of mixed-interface are computed, an empty list for nothing; remove the key with any other method"
    )]
    #[error("`reduction.held` is {found} with {method} – {}", if *found == "given" { "remove the key or use mixed-interface" } else { "expected interfaces and directions: held = [\"base\", \"hub.ux\"]" })]
    JobHeld {
        /// Whether the key is there.
        found: &'static str,
        /// The method as the job has it.
        method: String,
    },
    /// What is held while modes are computed names no interface, or a direction that none of its nodes has.
    #[entry(
        "E-HELD-INTERFACE",
        Usage,
        "use the name of an interface, or a name, a dot and a direction that its nodes have: hub.ux; the message lists the names"
    )]
    #[error("reduction.held: `{held}` is no interface and no direction of one – the job has {}", listed(known))]
    HeldInterface {
        /// What the job says.
        held: String,
        /// Names of the job's interfaces.
        known: Vec<String>,
    },
    /// A boundary of the scene is about an interface that the job does not have.
    #[entry("E-SCENE-INTERFACE", Usage, "use the name of an interface; the message lists them")]
    #[error("scene.boundaries: `{boundary}`: no interface is called `{name}` – the job has {}", listed(known))]
    SceneInterface {
        /// The boundary.
        boundary: String,
        /// The name in it.
        name: String,
        /// Names of the job's interfaces.
        known: Vec<String>,
    },
    /// A statement of the scene names no interface, or a direction of none.
    #[entry(
        "E-SCENE-PART",
        Usage,
        "use the name of an interface, or a name, a dot and a direction: hub.ux; the message lists the names"
    )]
    #[error("scene.{key}: `{part}` is no interface and no direction of one – the job has {}", listed(known))]
    ScenePart {
        /// The key of the scene.
        key: &'static str,
        /// What it names.
        part: String,
        /// Names of the job's interfaces.
        known: Vec<String>,
    },
    /// The scene says two things of one interface dof.
    #[entry("E-SCENE-CONFLICT", Usage, "say one of them: connected, unloaded, grounded or prescribed")]
    #[error("scene: `{part}` is {first} and {second} – say one of them")]
    SceneConflict {
        /// The interface, or the direction of one.
        part: String,
        /// What is said first.
        first: &'static str,
        /// What is said second.
        second: &'static str,
    },
    /// A rigid body that the scene prescribes has no name of its own, or no interfaces.
    #[entry(
        "E-SCENE-CARRIER",
        Usage,
        "give it a name that no other interface has, and the interfaces that are parts of it"
    )]
    #[error("scene.prescribed: `{name}` {found} – expected a name of its own and the interfaces that are parts of it")]
    SceneCarrier {
        /// Its name.
        name: String,
        /// What is wrong.
        found: String,
    },
    /// A key of the job names an interface that the scene leaves out.
    #[entry(
        "E-SCENE-LEFT-OUT",
        Usage,
        "take the interface out of the one or of the other; a carrier has a name of its own"
    )]
    #[error(
        "{key}: `{said}`: the scene says that `{name}` is {of}, so that the superelement has no such interface – say one of the two"
    )]
    SceneLeftOut {
        /// The key.
        key: &'static str,
        /// What it says.
        said: String,
        /// The interface.
        name: String,
        /// What the scene says of it.
        of: &'static str,
    },
    /// The scene states gravity along another direction than the superelement whose matrices are reduced, or along any.
    #[entry("E-ASSUMED-GRAVITY", Usage, "reduce the full model for this direction of gravity")]
    #[error(
        "scene.gravity has another direction than that of the superelement whose matrices are reduced – found {} – expected ({}, {}, {}) \
        or none – reduce the full model for this direction of gravity",
        match gravity {
            Some([x, y, z]) => format!("({x}, {y}, {z})"),
            None => "true, which is any direction".to_owned(),
        },
        assumed[0], assumed[1], assumed[2]
    )]
    AssumedGravity {
        /// The direction of the scene; none where it states that any may be.
        gravity: Option<[f64; 3]>,
        /// That of the model, zero where there is none.
        assumed: [f64; 3],
    },
    /// A job of a superelement does not say what that takes for granted.
    #[entry("E-ASSUMED", Usage, "use the job that `supel export` writes, or `supel reduce FILE.supel`")]
    #[error(
        "{}: takes for granted: {sentence} – found nothing of it in `model.assumes` – expected it there, so that the new file says it as well – use \
        the job that `supel export` writes, or `supel reduce FILE.supel`",
        path.display()
    )]
    AssumedUnsaid {
        /// The superelement.
        path: PathBuf,
        /// What it takes for granted.
        sentence: String,
    },
    /// A load of the job acts on what the scene says is unloaded.
    #[entry("E-SCENE-LOAD", Usage, "take it out of what is unloaded, or leave the load off it")]
    #[error(
        "load {load} acts on what the scene says is unloaded – found a force on {found} – expected none – take it out of what is unloaded, or \
        leave the load off it"
    )]
    SceneLoad {
        /// The load.
        load: String,
        /// Interface dofs on which it acts.
        found: String,
    },
    /// A mass or springs act on an interface that moves in a direction which is none of its dofs.
    #[entry(
        "E-BOUNDARY-DOFS",
        Usage,
        "make every translation of it a dof of the interface, or compare another boundary"
    )]
    #[error(
        "scene.boundaries: `{boundary}` acts along every translation of {name} – found {left_out} left out of its dofs, by `dofs` or by the scene – \
        expected all of them – make them dofs of the interface, or compare another boundary"
    )]
    BoundaryDofs {
        /// What the scene says.
        boundary: String,
        /// The interface.
        name: String,
        /// The directions that it lacks.
        left_out: String,
    },
    /// A static analysis is asked for together with something that moves.
    #[entry("E-SCENE-STATIC", Usage, "leave out the key, or ask for another analysis")]
    #[error("scene.{key}: a static analysis has nothing that moves – leave out the key, or ask for another analysis")]
    SceneStatic {
        /// The key of the scene.
        key: &'static str,
    },
    /// An interface or held dofs list a node, row or direction twice.
    #[entry("E-DUP-INTERFACE", Usage, "list each once")]
    #[error("{selector}: {what} is listed twice – list each once")]
    InterfaceRepeats {
        /// Who selects.
        selector: Selector,
        /// What is repeated: `node 12`.
        what: String,
    },
    /// Two parts of `fixed` have one name.
    #[entry("E-FIXED-NAME", Usage, "give each its own, or none")]
    #[error("fixed `{name}` is defined twice – names must be unique – give each its own, or none")]
    FixedTwice {
        /// The name.
        name: String,
    },
    /// Two loads have one name.
    #[entry("E-LOAD-NAME", Usage, "give each its own")]
    #[error("load `{name}` is defined twice – names must be unique – give each its own")]
    LoadTwice {
        /// The name.
        name: String,
    },
    /// The keys of a load are those of no load, or of several.
    #[entry("E-LOAD-KEYS", Usage, "give `nodes` with `force` or `pressure`, or `file`, or `rotation`")]
    #[error(
        "load `{load}` has {} – expected `nodes` with `force` or with `pressure`, or `file` (with `column`, where it has several), or \
        `rotation` – leave the others out",
        quoted(found)
    )]
    LoadKeys {
        /// Name of the load.
        load: String,
        /// The keys that are there.
        found: Vec<&'static str>,
    },
    /// Two interfaces list the same node or row.
    #[entry("E-INTERFACE-OVERLAP", Usage, "leave it in one of them")]
    #[error("interfaces `{first}` and `{second}` both list {what} – it can belong to one of them")]
    InterfaceOverlap {
        /// Name of the earlier interface.
        first: String,
        /// Name of the later interface.
        second: String,
        /// What is shared: `node 12`.
        what: String,
    },
    /// A selection of nodes cannot be understood.
    #[entry("E-INTERFACE-NODES", Usage, "write a list, \"group:NAME\", a region or rows")]
    #[error("{selector}: nodes `{text}` – expected \"group:NAME\", a list of node labels, a region or rows")]
    InterfaceNodes {
        /// Who selects.
        selector: Selector,
        /// The text found.
        text: String,
    },
    /// A key of an interface or of held dofs contradicts nodes or coupling.
    #[entry("E-INTERFACE-KEY", Usage, "remove it, or do as the message says")]
    #[error("{selector}: `{key}` has no meaning for {situation} – remove it{remedy}")]
    InterfaceConflict {
        /// Who selects.
        selector: Selector,
        /// The key.
        key: String,
        /// What it does not go with.
        situation: &'static str,
        /// Another way out, with its leading word, or nothing.
        remedy: &'static str,
    },
    /// A file or a folder of the job has a name that is not UTF-8, which the report and the superelement cannot keep.
    #[entry("E-NAME", Usage, "rename the one that the message names")]
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
    /// A report or a job cannot be written as JSON.
    #[entry("E-JSON", Usage, "rename files and folders whose names are not UTF-8")]
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
    /// An output has the wrong extension.
    #[entry("E-OUTPUT-NAME", Usage, "name it as the message says")]
    #[error("`{key}` is {} – expected a name that ends in {expected}", path.display())]
    OutputName {
        /// Path of the key.
        key: &'static str,
        /// The file asked for.
        path: PathBuf,
        /// The extension, with its dot.
        expected: &'static str,
    },
    /// An output would be written over an input, by whatever name or link.
    #[entry("E-OVERWRITE", Usage, "give the output another name")]
    #[error(
        "{key} is {}, the same file as {role}, {} – expected a file of its own – give the output another name",
        path.display(), input.display()
    )]
    OutputIsInput {
        /// The key of the output, and whose it is.
        key: String,
        /// Its path.
        path: PathBuf,
        /// What the input is, and of which job.
        role: String,
        /// Its path.
        input: PathBuf,
    },
    /// A format of exports cannot hold the label of a node.
    #[entry("E-EXPORT-LABEL", Usage, "recover other nodes, or export to matrix-market")]
    #[error(
        "node {node} is recovered – expected a label of at most 2^53, which this format can hold – recover other nodes, or export to \
         matrix-market"
    )]
    ExportLabel {
        /// Its label.
        node: i64,
    },
    /// A file would stand beside an export as if it belonged to it.
    #[entry("E-EXPORT-LEFT", Usage, "remove the files of the export before, or give this one another name")]
    #[error(
        "{}{} would stand beside the export as if it were a file of it – found a file that this export does not have – remove it, or give \
         the export another name",
        path.display(), and_more(*n_more)
    )]
    ExportLeftOver {
        /// The file.
        path: PathBuf,
        /// How many others there are.
        n_more: usize,
    },
    /// Two outputs would be written over each other.
    #[entry("E-OUTPUT-TWICE", Usage, "give one of them another name")]
    #[error(
        "{key} is {}, the same file as {other} – expected a file of its own – give one of them another name",
        path.display()
    )]
    OutputTwice {
        /// The key of the later output, and whose it is.
        key: String,
        /// Its path.
        path: PathBuf,
        /// The key of the earlier one, and whose it is.
        other: String,
    },
    /// A folder whose jobs are to be reduced has none, or an assembly has no components.
    #[entry(
        "E-NO-JOBS",
        Usage,
        "name the folder of the jobs, whose names end in .toml, or give the assembly components"
    )]
    #[error(
        "{}: no job in it – expected documents NAME.toml with the tables of a job, or an assembly with components – name the folder \
         that has them",
        path.display()
    )]
    NoJobs {
        /// The folder or the assembly.
        path: PathBuf,
    },
    /// The process that runs one of several jobs cannot be started, or a signal ended it.
    #[entry(
        "E-JOB-PROCESS",
        Resources,
        "run the job alone; where a signal ended it, there was probably too little memory"
    )]
    #[error(
        "{}: the process of this job left no exit code: {cause} – the system ends processes when memory runs out – run the job alone",
        document.display()
    )]
    JobProcess {
        /// The job document.
        document: PathBuf,
        /// How it ended, or why it did not start.
        cause: String,
    },
    /// The name of an output is taken by a folder, a pipe or a device.
    #[entry("E-OUTPUT-KIND", Io, "give the output another name")]
    #[error(
        "{}: not a regular file – expected a name that is free or that of a file – give the output another name",
        path.display()
    )]
    OutputKind {
        /// The path.
        path: PathBuf,
    },
    /// Neither a job document nor the flags that replace it.
    #[entry("E-FLAGS", Usage, "give one or the other")]
    #[error("no job document, and without one {} {} missing – give a job document or these flags",
        flags.join(", "), if flags.len() == 1 { "is" } else { "are" })]
    MissingFlags {
        /// The flags that are missing.
        flags: Vec<&'static str>,
    },
    /// The text of a flag cannot be understood.
    #[entry("E-FLAG-TEXT", Usage, "write it as the message says")]
    #[error("{flag} {text} – expected {expected}")]
    FlagText {
        /// The flag.
        flag: &'static str,
        /// What was typed.
        text: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// `verify --reproduce` of a file that another program or version made.
    #[entry("E-OTHER-VERSION", Usage, "run that version, or compare with `verify --job` alone")]
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
    /// `verify --reproduce` of a file that a run made from parts of what earlier runs had kept.
    #[entry("E-PARTS", Usage, "run its job again without a cache, or compare with `verify --job` alone")]
    #[error(
        "{}: made from {} of what earlier runs had kept in a cache – right to the error bars, but no other run has their last \
        bits – run its job again without a cache, or compare by verify --job without --reproduce",
        path.display(), counted(*parts, "part", "parts")
    )]
    MadeOfParts {
        /// The file.
        path: PathBuf,
        /// Results that were parts.
        parts: usize,
    },
    /// `verify --reproduce` or `inspect --job` of a file that keeps no job of this version.
    #[entry("E-KEPT-JOB", Usage, "run the version that made it, or give the job by `verify --job`")]
    #[error(
        "{}: the job kept in the file is none of {} {} – found one of another version, or none – run that version, or \
        give the job by verify --job",
        path.display(), env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION")
    )]
    KeptJob {
        /// The file.
        path: PathBuf,
    },
    /// The working threads cannot be started.
    #[entry("E-THREADS", Resources, "ask for fewer with `--threads`")]
    #[error("{} cannot be started: {source} – ask for fewer with --threads", counted(*n_threads, "thread", "threads"))]
    Threads {
        /// How many were asked for.
        n_threads: usize,
        /// What the system said.
        source: rayon::ThreadPoolBuildError,
    },
    /// K or M is not symmetric.
    #[entry(
        "E-UNSYMMETRIC",
        InputData,
        "give follower forces, gyroscopic and friction terms as matrices of their own (`[[matrix]]`); where a triangle is \
        incomplete, say which one holds with `model.symmetric` (`reduce --symmetric`)"
    )]
    #[error(
        "the {matrix} matrix is not symmetric – worst at {place} – found a difference of {asymmetry:.1e} of its rows, and {of_largest:.1e} of \
        the largest entry – \
        expected below 1e-3, and below 1e-6 of the largest entry – take follower forces, gyroscopic and friction terms out and give them as matrices of \
        their own, [[matrix]] in the job; where the file lacks part of a triangle, take the other one: \
        model.symmetric = \"lower\" or \"upper\" (reduce --symmetric)"
    )]
    Unsymmetric {
        /// `stiffness` or `mass`.
        matrix: &'static str,
        /// The largest |A_ij − A_ji| / √(A_ii A_jj).
        asymmetry: f64,
        /// max |A − Aᵀ| / max |A|.
        of_largest: f64,
        /// Row and column of the first difference, from one, with their dofs where known.
        place: String,
        /// Entries below and above the diagonal that have none at their mirror image.
        unpaired: [usize; 2],
    },
    /// K and M are exchanged.
    #[entry("E-SWAPPED", InputData, "exchange the two files")]
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
    /// The mass matrix is zero.
    #[entry("E-NO-MASS", InputData, "give the mass matrix")]
    #[error(
        "the mass matrix is zero – found no entry other than zero – expected a mass – give the mass matrix of the model"
    )]
    NoMass,
    /// M gives some motion a negative kinetic energy.
    #[entry("E-INDEF-MASS", ModelPhysics, "check point masses, offsets and the coupling terms of the mass")]
    #[error(
        "the mass matrix is indefinite – {place} – found {} – expected none below zero – check \
        point masses, offsets and the coupling terms of the mass",
        kinetic_energy(*energy)
    )]
    IndefiniteMass {
        /// The entry or the dof where it is worst, in words.
        place: String,
        /// The energy relative to the diagonal, negative; −∞ where a dof without mass is coupled to another one's.
        energy: f64,
    },
    /// A file of loads is no Matrix Market file of loads.
    #[entry(
        "E-LOAD-FORMAT",
        InputData,
        "write `%%MatrixMarket matrix array real general`, then `rows columns`, then the values"
    )]
    #[error("{}:{line}: not a load – found `{found}` – expected {expected}", path.display())]
    LoadFormat {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The line.
        found: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A file of quantities is not one of the two forms of Matrix Market that are read.
    #[entry(
        "E-QUANTITY-FORMAT",
        InputData,
        "write `%%MatrixMarket matrix coordinate real general`, then `rows columns entries`, then `row column value`"
    )]
    #[error("{}:{line}: no rows of quantities – found `{found}` – expected {expected}", path.display())]
    QuantityFormat {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// The line.
        found: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A file of quantities has another size than names and matrices say.
    #[entry("E-QUANTITY-SIZE", InputData, "give it one row for each name and one column for each row of the matrices")]
    #[error(
        "{}: {rows} × {columns} – expected {n_names} × {n} – give it one row for each name and one column for each row of \
        the matrices",
        path.display()
    )]
    QuantitySize {
        /// The file.
        path: PathBuf,
        /// Its rows.
        rows: u64,
        /// Its columns.
        columns: u64,
        /// Names.
        n_names: u64,
        /// Rows of the matrices as they are in their files.
        n: u64,
    },
    /// A quantity has no name, or that of another one.
    #[entry("E-QUANTITY-NAME", InputData, "give each quantity a name of its own")]
    #[error("{}:{line}: {found} – expected a name for each quantity, all different", path.display())]
    QuantityName {
        /// The table.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// What is wrong.
        found: String,
    },
    /// A file of loads has another number of rows than the matrices.
    #[entry("E-LOAD-ROWS", InputData, "export it from the model of the matrices, in the order of their rows")]
    #[error(
        "{}: load `{load}` has {} – expected {n}, one for each row of the matrices – export it from the model of the \
        matrices, in the order of their rows",
        path.display(), counted(*found, "row", "rows")
    )]
    LoadRows {
        /// The file.
        path: PathBuf,
        /// Name of the load.
        load: String,
        /// Its rows.
        found: u64,
        /// Rows of the matrices as they are in their files.
        n: usize,
    },
    /// A file of loads does not have the column that is asked for, or has several where none is.
    #[entry("E-LOAD-COLUMN", InputData, "give `column`, which counts from zero")]
    #[error(
        "{}: load `{load}` asks for {} of a file of {} – expected one of them – give `column`, which counts from zero",
        path.display(), column_words(*asked), counted(*n_columns, "column", "columns")
    )]
    LoadColumn {
        /// The file.
        path: PathBuf,
        /// Name of the load.
        load: String,
        /// The column asked for, from zero.
        asked: Option<usize>,
        /// Columns of the file.
        n_columns: u64,
    },
    /// The centrifugal load of a rotation needs to know where the rows are.
    #[entry("E-LOAD-COORDINATES", InputData, "give `model.dofs` and `model.nodes`, or write the load to a file")]
    #[error(
        "load `{load}` is that of a rotation – the model has no dof map or no nodes, so that distances from its axis \
        are unknown – give model.dofs and model.nodes, or write the load to a file"
    )]
    LoadNeedsCoordinates {
        /// Name of the load.
        load: String,
    },
    /// The centrifugal load of a superelement: its mass does not tell where the mass inside it is.
    #[entry(
        "E-LOAD-CONDENSED",
        InputData,
        "name the load where the component itself is reduced; its superelement is a file of it"
    )]
    #[error(
        "load `{load}` is that of a rotation – found the mass of a superelement, {}, which does not tell how far the \
        mass inside is from the axis – name the rotation where the component itself is reduced, and take the load from \
        its superelement by `file`",
        path.display()
    )]
    LoadOfCondensed {
        /// Name of the load.
        load: String,
        /// The superelement.
        path: PathBuf,
    },
    /// The square of a load leaves the range of double precision.
    #[entry("E-LOAD-RANGE", InputData, "check its numbers, or write it in other units")]
    #[error(
        "the largest entry of load `{load}`{relative} is of the size 2^{exponent} – expected sizes between 2^-{bits} and \
        2^{bits} – check its numbers, or write it in other units"
    )]
    LoadRange {
        /// Name of the load.
        load: String,
        /// To what the size is relative, in words; empty for the user's units.
        relative: &'static str,
        /// The size as a power of two.
        exponent: i32,
        /// The largest exponent that is taken.
        bits: i32,
    },
    /// A load is zero, or held dofs take all of it.
    #[entry("E-LOAD-NOTHING", InputData, "load dofs that move, or leave the load out")]
    #[error("load `{load}` moves nothing – found {found} – expected a force on a dof that moves – leave it out")]
    LoadNothing {
        /// Name of the load.
        load: String,
        /// What was found, in words.
        found: &'static str,
    },
    /// A mass cannot be added to a node.
    #[entry(
        "E-ADDED-MASS",
        InputData,
        "add it to a node that has dofs, with rotations where it has inertia or an offset: the node of a rigid element for instance"
    )]
    #[error("added mass at node {node} – found {found} – expected {expected}")]
    AddedMass {
        /// Label of the node.
        node: i64,
        /// What was found, in words.
        found: String,
        /// What it takes.
        expected: &'static str,
    },
    /// Two further matrices have one name.
    #[entry("E-MATRIX-NAME", Usage, "give each its own")]
    #[error("matrix `{name}` is defined twice – names must be unique – give each its own")]
    MatrixTwice {
        /// The name.
        name: String,
    },
    /// A further matrix has another size than stiffness and mass.
    #[entry("E-MATRIX-ROWS", InputData, "export it from the model of stiffness and mass, in the order of their rows")]
    #[error(
        "{}: matrix `{matrix}` has {} – expected {n}, as stiffness and mass have – export it from the same model",
        path.display(), counted(*found, "row", "rows")
    )]
    MatrixRows {
        /// The file.
        path: PathBuf,
        /// Name of the matrix.
        matrix: String,
        /// Its rows.
        found: usize,
        /// Rows of stiffness and mass as they are in their files.
        n: usize,
    },
    /// A further matrix is not what its kind demands: gyroscopic ones are skew, geometric stiffness is symmetric.
    #[entry(
        "E-MATRIX-KIND",
        InputData,
        "write one triangle under a banner that ends in `symmetric` or `skew-symmetric`, or say `kind = \"other\"`"
    )]
    #[error(
        "{}: matrix `{matrix}` of kind {kind} – found {:e} at row {}, column {} and {:e} across the diagonal – expected {} to the \
        last digit – write one triangle under a banner that says so, or say `kind = \"other\"`",
        path.display(), values[0], place[0], place[1], values[1],
        if *kind == MatrixKind::Gyroscopic { "opposite numbers" } else { "equal ones" }
    )]
    MatrixKind {
        /// The file.
        path: PathBuf,
        /// Name of the matrix.
        matrix: String,
        /// What the job says it is.
        kind: MatrixKind,
        /// Row and column of the first such entry, from 1.
        place: [usize; 2],
        /// The entry, and the one across the diagonal.
        values: [f64; 2],
    },
    /// A further matrix is zero on all that moves, or what rounding leaves of zero.
    #[entry("E-MATRIX-NOTHING", InputData, "check that its file is the right one, or leave the matrix out")]
    #[error("matrix `{matrix}` does nothing – found {found} – expected an entry on dofs that move – leave it out")]
    MatrixNothing {
        /// Name of the matrix.
        matrix: String,
        /// What was found, in words.
        found: &'static str,
    },
    /// Damping resists a rigid-body motion, one of those that are free.
    #[entry(
        "E-DAMPING-RIGID",
        ModelPhysics,
        "take out dampers to the ground, let the share of the mass act on the deformation (`damping.rayleigh.mass_acts_on`), or say \
        `damping.rigid_motion = \"resist\"`"
    )]
    #[error(
        "damping resists a motion in which nothing deforms – found {found} – expected none, because nothing inside a body resists its \
        motion as a whole – {remedy}, or say `damping.rigid_motion = \"resist\"` where that is meant"
    )]
    DampingRigid {
        /// What resists which motion, and where.
        found: String,
        /// What to do about it, in words.
        remedy: &'static str,
    },
    /// Modal damping names more modes than the reduced component has.
    #[entry("E-DAMPING-MODES", Usage, "leave the last ones out of `damping.modal.ratios`, or keep more modes")]
    #[error(
        "damping.modal.ratios names {} – found {n_modes} with the interface free – expected as many at most – leave the last ones out",
        counted(*n_named, "elastic mode", "elastic modes")
    )]
    DampingModes {
        /// How many the job names.
        n_named: usize,
        /// Elastic modes of the reduced component.
        n_modes: usize,
    },
    /// A file of modes is none.
    #[entry(
        "E-MODES-FORMAT",
        InputData,
        "write them by scipy.io.mmwrite(\"modes.mtx\", V, precision=17) or numpy.save(\"modes.npy\", V), one mode in each \
         column"
    )]
    #[error("{}{}: not the modes of a reduction – found {found} – expected {expected}", path.display(), at_line(*line))]
    ModesFormat {
        /// The file.
        path: PathBuf,
        /// Line number, from 1, of a text.
        line: Option<u64>,
        /// What is there, in words.
        found: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// Modes that a file gives at nodes are not those of one frequency step, or have no value for a row of K and M.
    #[entry(
        "E-MODES-NODES",
        InputData,
        "write the displacements of all nodes in the frequency step, name that step where there are several, and give the dof \
         map of the matrices"
    )]
    #[error("{}: found {found} – expected {expected}", path.display())]
    ModesNodes {
        /// The file.
        path: PathBuf,
        /// What is there, in words.
        found: String,
        /// What belongs there, and what to do.
        expected: &'static str,
    },
    /// A file of modes has another number of rows than the matrices.
    #[entry("E-MODES-ROWS", InputData, "give each mode a value for every row of the matrices, in their order")]
    #[error(
        "{}: the modes have {} – expected {n}, one for each row of the matrices – give each mode a value for every row, in \
        the order of the matrices",
        path.display(), counted(*found, "row", "rows")
    )]
    ModesRows {
        /// The file.
        path: PathBuf,
        /// Its rows.
        found: u64,
        /// Rows of the matrices as they are in their files.
        n: usize,
    },
    /// A file of modes has no mode, or more than there can be.
    #[entry("E-MODES-COUNT", InputData, "write one mode in each column")]
    #[error(
        "{}: the file has {} – expected one mode in each column, from 1 to {n_rows} of them – write one mode in each column",
        path.display(), counted(*found, "column", "columns")
    )]
    ModesColumns {
        /// The file.
        path: PathBuf,
        /// Its columns.
        found: u64,
        /// Rows of the matrices as they are in their files, which is the most that independent modes can be.
        n_rows: usize,
    },
    /// A mode of a file is zero, or held dofs take all of it.
    #[entry("E-MODES-NOTHING", InputData, "leave the mode out of the file")]
    #[error(
        "mode {mode} of the file moves nothing – found {found} – expected a motion with mass – leave it out of the file"
    )]
    ModesNothing {
        /// Number of the mode, from 1.
        mode: usize,
        /// What was found, in words.
        found: &'static str,
    },
    /// The frequencies of modes cannot be read.
    #[entry("E-VALUES", InputData, "write a number on each line, or all of them on one")]
    #[error("{}{}: frequencies of modes – found {found} – expected {expected}", path.display(), at_line(*line))]
    ValuesFormat {
        /// The file.
        path: PathBuf,
        /// Line number, from 1, of a text.
        line: Option<u64>,
        /// What is there, in words.
        found: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// There are more or fewer frequencies than modes.
    #[entry("E-VALUES-COUNT", InputData, "give a frequency for each mode, in their order")]
    #[error(
        "{}the frequencies do not go with the modes – found {} – expected {n_modes} – give one for each mode, in their order",
        of_file(path.as_deref()), counted(*found, "frequency", "frequencies")
    )]
    ValuesCount {
        /// The file, where they are in one.
        path: Option<PathBuf>,
        /// Frequencies, or as many as were read.
        found: u64,
        /// Modes.
        n_modes: usize,
    },
    /// A reduced matrix of another size than its basis.
    #[entry(
        "E-REDUCED-SIZE",
        InputData,
        "give K̂ and M̂ of the basis that is given, a row for each of its columns, with the same names for the same rows"
    )]
    #[error(
        "{}: the reduced matrix does not go with the basis – found {}{of} – expected {n_columns}, one for each column of the basis",
        path.display(), counted(*found, "row", "rows")
    )]
    ReducedSize {
        /// The file of the matrix.
        path: PathBuf,
        /// Its rows.
        found: usize,
        /// What these are the rows of, where that is not the file alone.
        of: &'static str,
        /// Columns of the basis.
        n_columns: usize,
    },
    /// A job that is there already.
    #[entry(
        "E-OUTPUT-EXISTS",
        Usage,
        "give another name, or move the file away: what was written by hand is not replaced"
    )]
    #[error("--output: {} is there already – give another name, or move it away", path.display())]
    OutputExists {
        /// The file.
        path: PathBuf,
    },
    /// A code that nothing has.
    #[entry("E-CODE", Usage, "take the code that the message offers, or see all by `supel explain`")]
    #[error("no error, warning or check has the code {code}{}", Offered(suggestion))]
    CodeUnknown {
        /// What was typed.
        code: String,
        /// A code that looks like it.
        suggestion: Option<String>,
    },
    /// Frequencies that modes are said to have are theirs in another unit.
    #[entry("E-VALUES-UNIT", Usage, "say the unit that the message names")]
    #[error(
        "the numbers of the modes are not {stated} – found that {n_agree} of {n_modes} are {found}, by the shapes of the modes – \
        expected numbers in the unit that is said – say {flag}"
    )]
    ValuesUnit {
        /// What they were said to be.
        stated: &'static str,
        /// What they are.
        found: String,
        /// How many of them.
        n_agree: usize,
        /// Modes.
        n_modes: usize,
        /// The flag that says so, or what to do.
        flag: String,
    },
    /// Mode acceleration answers inertia forces while something holds the component.
    #[entry("E-MODES-UNHELD", ModelPhysics, "name an interface, or hold dofs by [[fixed]]")]
    #[error(
        "mode-acceleration answers the inertia forces of its modes with the interface held – found a free component without \
        an interface – expected one that something holds – name an interface, or hold dofs by [[fixed]]"
    )]
    ModesUnheld,
    /// K, M or the frequencies leave the range of double precision.
    #[entry("E-RANGE", InputData, "write the matrices in other units")]
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
    /// The shapes of `write.recovery` are too large or too small for single precision.
    #[entry("E-RECOVERY-RANGE", InputData, "set its precision to `\"double\"`, or write the matrices in other units")]
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
    /// Rows have neither stiffness nor mass.
    #[entry(
        "E-EMPTY-ROWS",
        InputData,
        "leave unused and constrained dofs out of both matrices, or drop them with `model.drop_empty` (`reduce \
        --drop-empty`)"
    )]
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
    /// K has rows of constraint multipliers.
    #[entry(
        "E-LAGRANGE",
        InputData,
        "export K and M without multipliers and give the constraints as `model.constraints`, or eliminate constraints before exporting"
    )]
    #[error(
        "{} in the stiffness, {} – the first is row {row}{dof} – expected none – export K and M without them and \
        give the constraints as model.constraints, a matrix G with G u = 0, or eliminate constraints before exporting",
        counted(n_single + n_of_pairs, "row of a constraint multiplier", "rows of constraint multipliers"),
        multipliers(*n_single, *n_of_pairs)
    )]
    MultiplierRow {
        /// How many have a zero on the diagonal and other entries.
        n_single: usize,
        /// How many are one of two that belong to one constraint.
        n_of_pairs: usize,
        /// The first row, from one.
        row: usize,
        /// Its dof.
        dof: String,
    },
    /// A diagonal entry of K is negative.
    #[entry("E-NEG-DIAG", ModelPhysics, "the structure is unstable or loaded beyond buckling: reduce it unloaded")]
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
    /// A diagonal entry of M is negative.
    #[entry(
        "E-NEG-MASS",
        ModelPhysics,
        "check point masses and offsets; where rows of second-order elements were summed up to a lumped mass, which is negative at corners, \
        write the consistent mass or one that is scaled by its diagonal"
    )]
    #[error(
        "row {row}{dof} of the mass has the diagonal {value:.3e} – expected none below zero – check point masses and \
        offsets of the model; where rows of second-order elements were summed up, which is negative at corners, write the consistent mass"
    )]
    NegativeMass {
        /// The row, from one.
        row: usize,
        /// Its dof.
        dof: String,
        /// The entry.
        value: f64,
    },
    /// A line of a file of constraints is none of its format.
    #[entry(
        "E-CONSTRAINT-FORMAT",
        InputData,
        "write G as Matrix Market, a row for each constraint, as scipy.io.mmwrite does"
    )]
    #[error("{}:{line}: `{found}` – expected {expected} – write G as Matrix Market, as scipy.io.mmwrite does", path.display())]
    ConstraintFormat {
        /// The file.
        path: PathBuf,
        /// The line, from one.
        line: u64,
        /// What stands there.
        found: String,
        /// What should stand there.
        expected: &'static str,
    },
    /// A file of constraints has another number of columns than the matrices have rows.
    #[entry(
        "E-CONSTRAINT-SIZE",
        InputData,
        "give G a column for each row of K and M in their order, and a row for each constraint"
    )]
    #[error(
        "{}: {columns} columns – expected {n}, one for each row of the matrices – give G a row for each constraint \
        and a column for each row of K and M in their order",
        path.display()
    )]
    ConstraintSize {
        /// The file.
        path: PathBuf,
        /// Its columns.
        columns: u64,
        /// Rows of K and M in their files.
        n: u64,
    },
    /// Constraints resist a rigid-body motion of the component.
    #[entry(
        "E-CONSTRAINT-GROUND",
        ModelPhysics,
        "check signs, levers and coordinates of the constraint named; say `model.constraints_to_ground = \"accept\"` \
        (`doctor`, `certify` and `init --constraints-to-ground accept`) where it is meant"
    )]
    #[error(
        "constraint row {row} ({}) resists the {motion} of the component by {share:.1e} of the displacements that it compares, and \
        {} – expected {:.0e} at most – check its signs and levers and the coordinates, or say model.constraints_to_ground = \"accept\" \
        (doctor, certify and init --constraints-to-ground accept) if it holds the component to the ground",
        listed(dofs),
        counted(*n_rows, "constraint does so in all", "constraints do so in all"),
        1e-4
    )]
    ConstraintGround {
        /// The row, from one.
        row: usize,
        /// Its dofs.
        dofs: Vec<String>,
        /// The motion.
        motion: &'static str,
        /// How much of it is resisted.
        share: f64,
        /// How many constraints resist some motion.
        n_rows: usize,
    },
    /// Constraints tie interface dofs to each other.
    #[entry(
        "E-CONSTRAINT-INTERFACE",
        InputData,
        "leave all but one of the dofs that follow each other out of the interfaces, or join their nodes in a patch"
    )]
    #[error(
        "constraint row {row} ({}) leaves an equation between dofs of interfaces – expected dofs that move independently – leave \
        one of them out of the interface with its key `dofs`, or take the nodes together with coupling = \"rigid\"",
        listed(dofs)
    )]
    ConstraintInterface {
        /// The row, from one.
        row: usize,
        /// Its dofs.
        dofs: Vec<String>,
    },
    /// A constraint nearly follows from others.
    #[entry(
        "E-CONSTRAINT-RANK",
        InputData,
        "write the coefficients with all their digits, or leave the constraint out where it says the same as others"
    )]
    #[error(
        "constraint row {row} ({}) follows from others but for {left:.1e} – expected less than 1e-10, or more than {most:.0e} – write the \
        coefficients with all digits of a double, or leave it out if it says the same as others",
        listed(dofs)
    )]
    ConstraintRank {
        /// The row, from one.
        row: usize,
        /// Its dofs.
        dofs: Vec<String>,
        /// What is left of it.
        left: f64,
        /// From what on it would not follow from others, by the digits of the coefficients.
        most: f64,
    },
    /// A dof would follow others by too large a factor.
    #[entry(
        "E-CONSTRAINT-SPREAD",
        InputData,
        "leave dofs with small coefficients out of the interface, so that others follow them, or mend the coefficients"
    )]
    #[error(
        "{dof} follows other dofs by a factor of {factor:.1e} – expected {limit:.0e} at most, beyond which the stiffness loses its \
        digits – check the coefficients of its constraints, or leave it out of them"
    )]
    ConstraintSpread {
        /// The dof.
        dof: String,
        /// The factor, a rotation in the scale of displacements.
        factor: f64,
        /// The largest there may be.
        limit: f64,
    },
    /// Too many constraints hang together.
    #[entry(
        "E-CONSTRAINT-BLOCK",
        InputData,
        "write them so that each has a dof of its own, as the slave of a tie is, or tie with fewer"
    )]
    #[error(
        "constraint row {row} ({}) is {found} – expected constraints of which each has a dof that no other has, or blocks of less \
        than 4000 – write a slave dof into each, or leave the interface fewer of their dofs",
        listed(dofs)
    )]
    ConstraintBlock {
        /// The row, from one.
        row: usize,
        /// Its dofs.
        dofs: Vec<String>,
        /// What it is part of.
        found: String,
    },
    /// Constraints tie dofs without stiffness and mass to nothing that has any.
    #[entry(
        "E-CONSTRAINT-LOOSE",
        InputData,
        "tie the node by more constraints, or by nodes that are not in line, or leave its dof out of the matrices"
    )]
    #[error(
        "{} neither stiffness nor mass after the constraints, the first is {dof} – expected that constraints tie it to others – tie \
        its node by more constraints or by nodes that are not in line, or leave the dof out of the matrices",
        counted(*n_dofs, "dof has", "dofs have")
    )]
    ConstraintLoose {
        /// How many.
        n_dofs: usize,
        /// The first.
        dof: String,
    },
    /// Constraints leave nothing that deforms.
    #[entry(
        "E-CONSTRAINT-ALL",
        InputData,
        "leave out constraints: what is at rest, or moves as a whole alone, has no modes"
    )]
    #[error("the constraints {left} – expected a component that deforms – leave out constraints")]
    ConstraintAll {
        /// What they leave, in words.
        left: String,
    },
    /// The coordinates or the dof map do not belong to K.
    #[entry(
        "E-COORD",
        InputData,
        "check units, axes and the order of nodes and rows, first at the nodes named; give the axes of nodes that have their own with \
        `model.frames`; use the coordinates of the state that K was made in; or leave the nodes out"
    )]
    #[error(
        "the coordinates do not belong to the stiffness – {found} – expected below {} – check units, axes and local \
        node frames, the order of nodes and rows, and the state that the coordinates are of, or leave the nodes out",
        quantity(*expected, 2)
    )]
    CoordinatesDoNotFit {
        /// What was found, in words.
        found: String,
        /// The largest energy of a motion by the coordinates, relative to another; of nodes out of place their distance, relative to
        /// the size of the component; of motions without energy that cost as little by the coordinates how many there are.
        energy: f64,
        /// What rounding of coordinates may make of it.
        expected: f64,
        /// Where the forces are largest.
        dof: String,
    },
    /// A preloaded state of a model whose rows nothing places.
    #[entry("E-PRELOAD-COORDINATES", InputData, "give `model.dofs` and `model.nodes`, in the preloaded state")]
    #[error(
        "the state is preloaded – the model has no dof map or no nodes, so that rotations cannot be compared with the internal forces – \
        give model.dofs and model.nodes, with the coordinates of the preloaded state"
    )]
    PreloadCoordinates,
    /// An internal force at a row that was dropped.
    #[entry("E-PRELOAD-EMPTY", InputData, "give the internal forces of the model of K, in the order of its rows")]
    #[error(
        "row {row} has an internal force – found neither stiffness nor mass there, and the row was dropped – expected none – give the \
        internal forces of the model of K, in the order of its rows"
    )]
    PreloadEmptyRow {
        /// The row of the files, from one.
        row: usize,
    },
    /// K of a preloaded state resists a translation.
    #[entry(
        "E-PRELOAD-HELD",
        InputData,
        "give K and the internal forces of the free component, and hold its supports by `[[fixed]]`"
    )]
    #[error(
        "the stiffness of the preloaded state resists translation at {} of {}, {dof} the first – expected a free component, whose \
        supports took no rows out – give K and the internal forces of the free component and hold its supports by [[fixed]]",
        counted(*n_touched, "node", "nodes"), n_nodes
    )]
    PreloadHeld {
        /// Nodes where a translation makes a force.
        n_touched: usize,
        /// Nodes of the model.
        n_nodes: usize,
        /// A dof of the first.
        dof: String,
    },
    /// The internal forces have a resultant.
    #[entry(
        "E-PRELOAD-BALANCE",
        InputData,
        "give the forces of the elements at all nodes, those at supports and interfaces among them, without external forces"
    )]
    #[error(
        "the internal forces are not in balance – found a resultant along the {motion} of {} of the sizes of its terms, the largest at \
        {dof} – expected {} at most, because the elements of a free component make none – give the forces of the elements at all nodes, \
        those at supports and interfaces among them, in the order of the rows of K and at the coordinates of the preloaded state",
        quantity(*share, 2), quantity(*limit, 1)
    )]
    PreloadUnbalanced {
        /// The motion whose work is not zero.
        motion: &'static str,
        /// Resultant over the sum of its terms.
        share: f64,
        /// What is allowed.
        limit: f64,
        /// The dof with the largest term.
        dof: String,
    },
    /// K and the internal forces are not of one state.
    #[entry(
        "E-PRELOAD-FORCES",
        InputData,
        "check sign, unit, order of rows and load step of the internal forces, and take the coordinates of the preloaded state"
    )]
    #[error(
        "the internal forces do not belong to the stiffness – a rotation about {axis} makes {} at {dof}, and turning the internal forces \
        {} per radian; over all rows the stiffness answers with {} times the internal forces – expected the same within {} of the largest \
        – check sign, unit, order of rows and load step of the forces, and take the coordinates of the preloaded state",
        quantity(*found, 4), quantity(*expected, 4), quantity(*factor, 3), quantity(*limit, 1)
    )]
    PreloadMisfit {
        /// The axis of the rotation.
        axis: &'static str,
        /// The dof with the largest difference.
        dof: String,
        /// What K makes there, in the units of the files per radian.
        found: f64,
        /// What turning the internal forces makes there.
        expected: f64,
        /// The factor of the internal forces that comes nearest to K.
        factor: f64,
        /// Difference allowed, relative to the largest force.
        limit: f64,
    },
    /// Internal forces that K cannot be compared with.
    #[entry(
        "E-PRELOAD-NONE",
        InputData,
        "leave `model.state` out where no node has an internal force; write K with more digits where they are small, and with the rows of all directions that the forces have"
    )]
    #[error(
        "the state is preloaded – turning its internal forces makes {largest:.1e} of the terms of the stiffness at most, which rounding of \
        the stiffness makes too – expected forces that tell a preload – leave model.state out where no node has an internal force: \
        rotations are free then; write K with more digits where they are small, and with the rows of all directions that the forces have"
    )]
    PreloadNone {
        /// Largest force of a unit rotation over the terms of its row.
        largest: f64,
    },
    /// Internal forces at nodes that an average or a constraint ties to rotations.
    #[entry(
        "E-PRELOAD-TIED",
        InputData,
        "couple nodes that have internal forces by `coupling = \"direct\"` or `\"rigid\"`, or keep averages and constraints away from them"
    )]
    #[error(
        "{dof} has an internal force, {} of the largest, and {tie} ties it to rotations – expected {} at most, because the arm of the force \
        turns with the tie, which does not say how – couple the node by coupling = \"direct\" or \"rigid\", or keep averages and \
        constraints away from it",
        quantity(*share, 2), quantity(*limit, 1)
    )]
    PreloadTied {
        /// The dof.
        dof: String,
        /// What ties it.
        tie: &'static str,
        /// Its force over the largest.
        share: f64,
        /// What is allowed.
        limit: f64,
    },
    /// Internal forces in a rigid patch whose node moves with a carrier in some directions alone.
    #[entry("E-PRELOAD-CARRIED", InputData, "give the patch all six directions, or leave it out of `scene.prescribed`")]
    #[error(
        "nodes of the interface {interface:?} have internal forces, and {carrier:?} moves its node but does not turn it – expected a patch \
        that turns with its carrier, for what its forces do when both turn is not known – give the interface all six directions, or leave \
        it out of scene.prescribed"
    )]
    PreloadCarried {
        /// The interface.
        interface: String,
        /// The carrier.
        carrier: String,
    },
    /// A rotation of a patch with internal forces that constraints let follow other dofs.
    #[entry(
        "E-PRELOAD-DEPENDENT",
        InputData,
        "keep constraints between nodes of a rigid patch that has internal forces out of `model.constraints`, or make the rotation an \
        interface dof"
    )]
    #[error(
        "{dof} follows other dofs by constraints, and nodes of its patch have internal forces – expected a rotation of its own, whose \
        stiffness these forces have a part in – keep constraints on nodes of this patch out of model.constraints, or make the rotation a \
        dof of the interface"
    )]
    PreloadDependent {
        /// The rotation.
        dof: String,
    },
    /// A preloaded component that turns with negative stiffness.
    #[entry(
        "E-PRELOAD-NEGATIVE",
        ModelPhysics,
        "hold the component by `[[fixed]]` where its neighbours hold it, reduce it at a state in which it is in tension, or put the \
         origin of a rigid patch on the line of the forces that pass it"
    )]
    #[error(
        "the preloaded component turns as a whole with the negative stiffness {energy:.1e} – expected none below -{noise:.1e} – {cause}, so \
        that modes and counts of modes are not those of a stable structure – hold it by [[fixed]] where its neighbours hold it, reduce \
        it at a state in which it is in tension, or put the origin of a rigid patch on the line of the forces that pass it"
    )]
    NegativePreload {
        /// Why, in words.
        cause: &'static str,
        /// Rayleigh quotient of the motion, scaled.
        energy: f64,
        /// What rounding can make of it.
        noise: f64,
    },
    /// K lets the component move in every direction but not turn.
    #[entry(
        "E-ROTATIONS-HELD",
        InputData,
        "check map, order of nodes, local frames, the state of the coordinates and the digits of K; look for springs between \
        distant nodes; where supports hold rotations alone, list them in `model.held_rotations`"
    )]
    #[error(
        "by these coordinates the stiffness lets the component move in every direction but not turn – {rotations} cost up to {} of the \
        energy of the first elastic mode, most of it at {dof}, and {} none – expected free \
        rotations, because no support holds a rotation and no translation of a solid – check the dof map, the order \
        of nodes, local node frames and the state that the coordinates are of; where K has fewer digits than its numbers \
        show, state `stiffness_digits`; where supports hold rotations alone, list these in model.held_rotations",
        quantity(*energy, 2), counted(*n_zero, "motion costs", "motions cost")
    )]
    RotationsHeld {
        /// The rotations.
        rotations: String,
        /// What `model.held_rotations` calls them.
        directions: Vec<crate::dofs::Direction>,
        /// Zero modes of K.
        n_zero: usize,
        /// Largest Rayleigh quotient of a rotation over the first elastic eigenvalue.
        energy: f64,
        /// Where the forces are largest.
        dof: String,
    },
    /// M couples other nodes than K.
    #[entry("E-MASS-ORDER", InputData, "write K and M with their rows in one order, that of the dof map")]
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
    /// The rows of a direction are coupled as those of other nodes are.
    #[entry(
        "E-DIRECTION-ORDER",
        InputData,
        "check the dof map: the rows of each direction have to be in the order of the nodes"
    )]
    #[error(
        "at {n_strayed} of {n_nodes} nodes the {what} couples a direction with the neighbours of another node, the first at {first} – \
        expected those that it couples all other directions with, because elements take part in all directions of their nodes – check \
        the dof map, and that the rows of each direction are in the order of the nodes"
    )]
    DirectionInAnotherOrder {
        /// The matrix.
        what: &'static str,
        /// Nodes at which they are.
        n_strayed: usize,
        /// Nodes of the model.
        n_nodes: usize,
        /// The row of the first of them.
        first: String,
    },
    /// The rows of nodes are coupled as those of other nodes are, by the cells of the mesh.
    #[entry(
        "E-CELL-ORDER",
        InputData,
        "check that dof map and mesh are those of the matrices; where the cells are not those of its elements, take the nodes from a table"
    )]
    #[error(
        "the stiffness couples {n_strayed} of {n_nodes} nodes with other nodes than the cells of the mesh do, the first is node {first} – \
        expected the nodes that cells have together with it, because an element couples the nodes of its cell – check that dof map and \
        mesh are those of the matrices; where the cells are not those of its elements, take the nodes from a table"
    )]
    CellsOfOthers {
        /// Nodes that are coupled as others.
        n_strayed: usize,
        /// Nodes of cells.
        n_nodes: usize,
        /// The label of the first of them.
        first: i64,
    },
    /// A motion as a whole, or of a mechanism, has negative energy, and a count finds the eigenvalue.
    #[entry("E-NEG-RIGID", ModelPhysics, "check preload and negative springs")]
    #[error(
        "a motion that strains nothing has the negative energy {energy:.1e}{} – expected zero within {noise:.1e} – a Sturm count \
        finds {} below half of it: the stiffness is indefinite – check preload and negative springs; {STATE_DIGITS}",
        at.as_ref().map_or_else(String::new, |at| format!(", its force is largest at {at}")),
        counted(*count, "eigenvalue", "eigenvalues")
    )]
    NegativeRigidEnergy {
        /// Its Rayleigh quotient, scaled.
        energy: f64,
        /// What rounding of the data allows.
        noise: f64,
        /// Eigenvalues of K − σM below half of it, counted.
        count: usize,
        /// Where its force is largest, where that is known.
        at: Option<String>,
    },
    /// A rigid-body motion moves no mass.
    #[entry("E-RIGID-MASS", ModelPhysics, "give the massless part its mass")]
    #[error(
        "a rigid-body motion moves no mass – found a modal mass of {relative_mass:.1e} relative to the largest – \
        expected above 1e-12 – give the massless part of the model its mass"
    )]
    MasslessRigidMotion {
        /// Its modal mass over the largest.
        relative_mass: f64,
    },
    /// A motion has neither stiffness nor mass.
    #[entry(
        "E-MASSLESS-MECHANISM",
        ModelPhysics,
        "give the dof named stiffness or mass, or leave it out of both matrices"
    )]
    #[error(
        "a motion has neither stiffness nor mass – it is largest at {dof} – expected one of them for every motion – \
        give the dof stiffness or mass, or leave it out of both matrices"
    )]
    MasslessMechanism {
        /// The dof it moves most.
        dof: String,
    },
    /// Free modes of a component with a rigid-body motion that moves no mass.
    #[entry(
        "E-FREE-MASSLESS",
        ModelPhysics,
        "give the nodes rotary inertia, or keep fixed-interface modes with the method `craig-bampton`"
    )]
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
    #[entry(
        "E-DENSE-EIGEN",
        NumericalLimit,
        "check the magnitudes of the input for values near the ends of the range of a double"
    )]
    #[error(
        "a dense eigenproblem of order {n} has no answer – found values that are not finite, or energies below zero – expected finite \
        matrices, positive where modes need it – check the magnitudes of the input"
    )]
    DenseEigen {
        /// Its order.
        n: usize,
    },
    /// The interface has more dofs than dense matrices can have.
    #[entry("E-INTERFACE-SIZE", InputData, "take fewer interface nodes or couple their patches rigidly")]
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
    /// A selection names nodes and the model has none.
    #[entry(
        "E-NO-NODES",
        InputData,
        "give `model.dofs` and `model.nodes` (`reduce --dofs`, `reduce --nodes`), or select rows"
    )]
    #[error(
        "{selector} names nodes – the model has no dof map or no nodes – give model.dofs and model.nodes \
        (reduce --dofs, reduce --nodes); interfaces and held dofs may also be rows by number"
    )]
    SelectionNeedsNodes {
        /// Who selects.
        selector: Selector,
    },
    /// A patch has nodes without coordinates.
    #[entry("E-NO-COORDINATES", InputData, "give a table or mesh with every node of the patch")]
    #[error(
        "interface {interface:?} is a patch – its nodes have no coordinates – expected a node table or mesh with every \
        node of the patch"
    )]
    RigidNeedsCoordinates {
        /// The interface.
        interface: String,
    },
    /// The mesh has no such group.
    #[entry("E-GROUP", InputData, "use one of the names in the message")]
    #[error("{selector}: no group {group:?} – {}", groups(known))]
    UnknownGroup {
        /// Who selects.
        selector: Selector,
        /// The group asked for.
        group: String,
        /// The groups that there are.
        known: Vec<String>,
    },
    /// A selection finds no node.
    #[entry("E-INTERFACE-EMPTY", InputData, "check the list or the region against the coordinates")]
    #[error(
        "{selector} selects no node – expected at least one – check the list or the region against the \
        coordinates"
    )]
    EmptyInterface {
        /// Who selects.
        selector: Selector,
    },
    /// A node that the job selects has no row in the matrices.
    #[entry(
        "E-CONSTRAINED-INTERFACE",
        InputData,
        "it is constrained, unused or not in the dof map: take another or free it"
    )]
    #[error(
        "{selector}: node {node} has no row in the matrices – expected a free dof – the node is \
        constrained, unused or not in the dof map"
    )]
    InterfaceNodeWithoutRows {
        /// Who selects.
        selector: Selector,
        /// The node.
        node: i64,
    },
    /// A selection asks for a dof that its node does not have.
    #[entry(
        "E-DOF-MISSING",
        InputData,
        "list the dofs, use `coupling = \"rigid\"`, or leave out what a load has along it"
    )]
    #[error(
        "{selector}: {dof} does not exist – expected a direction the node has – solids have no rotations and models in a plane no motion \
        across it; {}",
        selector.remedy_of_missing_dof()
    )]
    DofMissing {
        /// Who selects.
        selector: Selector,
        /// The dof.
        dof: crate::dofs::Dof,
    },
    /// A selection names a row beyond the matrices.
    #[entry("E-INTERFACE-ROW", InputData, "count rows from zero")]
    #[error(
        "{selector}: row {row} {found} – expected one of 0 to {} with stiffness or mass – rows count \
        from zero, as in the files",
        n.saturating_sub(1)
    )]
    InterfaceRow {
        /// Who selects.
        selector: Selector,
        /// The row, from zero.
        row: usize,
        /// What is wrong with it.
        found: &'static str,
        /// Rows of the files.
        n: usize,
    },
    /// Two interfaces claim one dof.
    #[entry("E-DOF-TWICE", InputData, "take it out of one of them")]
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
    /// A dof that the job holds belongs to an interface, which moves it.
    #[entry(
        "E-FIXED-INTERFACE",
        InputData,
        "take it out of one of them; a direct interface may list its other directions in `dofs`"
    )]
    #[error(
        "{dof} is held by {fixed} and belongs to interface {interface:?} – expected a dof that is at rest or that an interface \
        moves – take it out of one of them; `dofs` lists the directions of either"
    )]
    FixedInterface {
        /// The dof.
        dof: String,
        /// Who holds it.
        fixed: Selector,
        /// Who moves it.
        interface: String,
    },
    /// Nothing is left to move: every dof is held, or every dof with mass.
    #[entry("E-FIXED-ALL", InputData, "hold fewer dofs; `dofs` lists the directions in which nodes are held")]
    #[error(
        "the job holds {} of {n_dofs} – {left} – expected a component that can move – hold fewer dofs; `dofs` lists \
        the directions in which nodes are held",
        counted(*n_held, "dof", "dofs")
    )]
    AllFixed {
        /// Dofs that are held.
        n_held: usize,
        /// Dofs there are.
        n_dofs: usize,
        /// What is left, in words.
        left: &'static str,
    },
    /// The origin of a rigid patch is more than a hundred times the size of the part away from it.
    #[entry(
        "E-ORIGIN-FAR",
        InputData,
        "give the origin in the unit of the coordinates, or leave it out for the mean of the nodes"
    )]
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
    /// The nodes of a patch do not determine the cylinder or the sphere that its origin is taken from.
    #[entry("E-ORIGIN-FIT", InputData, "check which nodes the patch has, or give the origin as [x, y, z]")]
    #[error(
        "interface {interface:?}: its origin or its axes are those of a {shape} fitted to its nodes – found {found} – expected nodes of \
        one {shape}, none farther off than 0.05 of the radius – check which nodes the patch has, or give them as numbers"
    )]
    OriginNotFitted {
        /// The interface.
        interface: String,
        /// What is fitted.
        shape: &'static str,
        /// What was found, in words.
        found: String,
    },
    /// The directions that give the axes of an interface node are parallel.
    #[entry("E-AXES", InputData, "give x in another direction than z")]
    #[error(
        "interface {interface:?}: `axes` has z along {z:?} and x along {x:?}, which are parallel – expected two directions – give x in \
        another direction"
    )]
    AxesParallel {
        /// The interface.
        interface: String,
        /// The direction of z.
        z: [f64; 3],
        /// The direction of x.
        x: [f64; 3],
    },
    /// The faces of a patch decide its origin or its weights, and they are not known.
    #[entry("E-PATCH-FACES", InputData, "give a mesh whose cells have faces in the patch, or do without \"area\"")]
    #[error(
        "interface {interface:?}: `{key} = \"area\"` asks for the faces of the patch – found: {found} – expected a mesh whose cells \
        have faces with all their nodes in the patch – give such a mesh, or another `{key}`"
    )]
    PatchWithoutFaces {
        /// The interface.
        interface: String,
        /// The key that asks for them.
        key: &'static str,
        /// Why they are not known, in words.
        found: String,
    },
    /// A pressure acts on faces that are not known.
    #[entry(
        "E-LOAD-FACES",
        InputData,
        "give a mesh whose cells have faces between the nodes, or write the nodal forces to a file"
    )]
    #[error(
        "load `{load}`: `pressure` acts on the faces between its nodes – found: {found} – expected a mesh whose cells have faces with all \
        their nodes among them – give such a mesh, or write the forces to a file and name that"
    )]
    LoadWithoutFaces {
        /// Name of the load.
        load: String,
        /// Why they are not known, in words.
        found: String,
    },
    /// There are more or fewer weights than nodes.
    #[entry("E-WEIGHTS", Usage, "give one weight for each node, in the order of the nodes")]
    #[error(
        "interface {interface:?}: `weights` has {} for {} – expected one for each, in the order of the nodes",
        counted(*n_weights, "number", "numbers"), counted(*n_nodes, "node", "nodes")
    )]
    WeightCount {
        /// The interface.
        interface: String,
        /// Weights there are.
        n_weights: usize,
        /// Nodes there are.
        n_nodes: usize,
    },
    /// Weights of a patch are too unlike.
    #[entry("E-WEIGHT-SPREAD", Usage, "leave the nodes of the smallest weights out of the patch")]
    #[error(
        "interface {interface:?}: `weights` go from {smallest:.1e} to {largest:.1e} – expected the largest to be at most a million times \
        the smallest, since the mean motion of the others is rounded by as much – leave the nodes of the smallest weights out of the patch"
    )]
    WeightSpread {
        /// The interface.
        interface: String,
        /// The smallest.
        smallest: f64,
        /// The largest.
        largest: f64,
    },
    /// Rigid patches tie all nodes, and nothing elastic is left.
    #[entry("E-WHOLLY-RIGID", ModelPhysics, "leave nodes out of the patch; a rigid part needs no superelement")]
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
    /// A patch cannot follow all motions of its node.
    #[entry(
        "E-PATCH-RANK",
        InputData,
        "add nodes off the line, or list the dofs that the patch can follow; the carrier of `scene.prescribed` has six, so that no model in a plane can have one"
    )]
    #[error(
        "interface {interface:?}: its {} can follow only {rank} of {} of its node – expected three \
        nodes that are not in line, with rows in all directions that it moves – add nodes to the patch, or list the `dofs` that it \
        can follow, in a plane ux, uy and rz; the carrier of scene.prescribed has six, so that no model in a plane can have one",
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
    /// A body that nothing holds has no interface node.
    #[entry("E-FLOATING-BODY", ModelPhysics, "add an interface node there, connect the body or leave it out")]
    #[error(
        "{n_floating} of the {} of the model float free of every interface – the first holds {dof} – \
        expected an interface node on each, or a support – add an interface node there, connect the body or leave it \
        out{}",
        counted(*n_bodies, "body", "bodies"),
        if *is_free_by_digits { SOFTER_THAN_DIGITS } else { "" }
    )]
    FloatingBody {
        /// How many.
        n_floating: usize,
        /// Bodies there are.
        n_bodies: usize,
        /// A dof of the first.
        dof: String,
        /// Whether what holds the first may be lost in the rounding of few digits of K.
        is_free_by_digits: bool,
    },
    /// The interface leaves a rigid-body motion free, as far as the digits of the stiffness tell.
    #[entry(
        "E-INTERFACE-RANK",
        ModelPhysics,
        "add interface nodes off the axis named, give them rotations, or reduce by the method `rubin`"
    )]
    #[error(
        "the interface can react only {rank} of the {}{motion} – expected all – {}{}{}",
        counted(*n_rigid, "rigid-body motion", "rigid-body motions"),
        unloaded_reacts_nothing(unloaded),
        if *has_coordinates { OFF_THE_AXIS } else { ROWS_THAT_MOVE }, Uncertain::besides(*uncertain)
    )]
    InterfaceRank {
        /// Motions it reacts.
        rank: usize,
        /// Motions there are.
        n_rigid: usize,
        /// The free motion in words.
        motion: String,
        /// Whether coordinates are known, so that the motion has an axis.
        has_coordinates: bool,
        /// Why the stiffness may be known too little, which may be all that is wrong.
        uncertain: Option<Uncertain>,
        /// Interface dofs that the scene leaves unloaded, which react nothing.
        unloaded: Vec<String>,
    },
    /// A held component is reduced to no coordinates at all.
    #[entry("E-NOTHING-LEFT", Usage, "ask for modes, or add an interface")]
    #[error(
        "the reduction leaves no coordinates – expected an interface or modes, because nothing of the component moves as a rigid \
        body – ask for modes or add an interface"
    )]
    NothingLeft,
    /// The mass of MacNeal's method has neither a mode nor a rigid-body motion to see.
    #[entry("E-MODAL-MASS", InputData, "ask for modes, or reduce with guyan")]
    #[error(
        "no modes are kept and nothing of the component moves as a rigid body, so that macneal leaves no mass – expected a mode or a \
        rigid-body motion – ask for modes, or reduce with guyan"
    )]
    NoModalMass,
    /// A superelement has no inertia-relief modes, which Rubin's matrices are made from.
    #[entry("E-NO-RELIEF", Usage, "reduce with rubin or herting")]
    #[error(
        "{} has no interface, lacks inertia relief for a rigid-body motion, has modes of the held interface, or a singular mass – \
        expected an interface, free modes with inertia relief and the mass of both, of which Rubin's matrices are made – reduce with \
        rubin or herting",
        path.display()
    )]
    NoInertiaRelief {
        /// The superelement.
        path: PathBuf,
    },
    /// A superelement holds no rows that would recover what is asked of it.
    #[entry("E-NO-RECOVERY", Usage, "reduce it with the key that the message names")]
    #[error("{}: holds no {missing} – expected what {wanted} is made of – reduce it with {key}", path.display())]
    NoRecovery {
        /// The superelement.
        path: PathBuf,
        /// What it lacks.
        missing: &'static str,
        /// The flag that asks for it.
        wanted: &'static str,
        /// The key of the job that puts it into the file.
        key: &'static str,
    },
    /// What follows from a state is beyond the range of double precision.
    #[entry("E-STATE-RANGE", InputData, "check the units of the table")]
    #[error("{}: state {number}: {what} overflows – expected a finite number – check the units of the table", path.display())]
    StateRange {
        /// The table of the states.
        path: PathBuf,
        /// Number of the state, from 1.
        number: u64,
        /// What was computed.
        what: String,
    },
    /// Unit accelerations do not deform the interior, or not each in a way of its own, so that rigid-body motion cannot be taken out of its
    /// static modes.
    #[entry("E-ATTACHMENT", ModelPhysics, "use herting, or craig-bampton with inertia relief")]
    #[error(
        "accelerations of the body do not deform its interior, or not each in a way of its own – expected a deformation for every \
        rigid-body motion, of which Rubin's attachment modes are made; a mass far larger than the rest leaves rotations about it none \
        – use herting or craig-bampton"
    )]
    NoAttachmentModes,
    /// The interface of Rubin's method leaves rigid-body motions free, and the answers to unit loads on it are nearly dependent.
    #[entry(
        "E-ATTACHMENT-ILL",
        NumericalLimit,
        "couple nodes that are tied to each other by one rigid patch, or leave some of them out"
    )]
    #[error(
        "the answers to unit loads on the interface have the condition {condition:.1e}, and their inverse an error of more than {error:.0e} – \
        expected interface dofs that move independently – couple nodes that are tied stiffly to each other by one rigid patch, or leave \
        some of them out; an interface that reacts all rigid-body motions needs no inverse"
    )]
    AttachmentCondition {
        /// κ(A_B) with unit diagonal.
        condition: f64,
        /// The error of its inverse that is accepted.
        error: f64,
    },
    /// The digits of the stiffness, or its triangles, leave open whether it is definite, or how many motions cost no energy.
    #[entry(
        "E-DATA-PRECISION",
        InputData,
        "write the stiffness with more digits, best in binary, or say `model.stiffness_digits = 17` in the job if its numbers are exact; where its triangles differ, \
        correct it, or say which of them holds with `model.symmetric`"
    )]
    #[error(
        "{} not tell {what} – {known} – expected {} – {}",
        cause.subject(), cause.expected(), cause.remedy()
    )]
    DigitsTooFew {
        /// Why it is open.
        cause: Uncertain,
        /// What is open.
        what: String,
        /// How well its entries are known.
        known: String,
    },
    /// Few digits leave open whether motions inside the component cost energy, and the job does not say that they are meant.
    #[entry(
        "E-MECHANISM-DIGITS",
        InputData,
        "say `model.mechanisms = \"accept\"` where hinges and sliding joints are meant, or write the stiffness with more digits, best \
        in binary"
    )]
    #[error(
        "the digits of the stiffness do not tell {} inside the component{} from elastic ones up to {up_to_hz:.1e} Hz – {known} – \
        expected motions that cost no energy to be told from soft ones – say model.mechanisms = \"accept\" if hinges or sliding \
        joints are meant, or write the stiffness with more digits, best in binary",
        counted(*n_inside, "motion", "motions"),
        if nodes.is_empty() { String::new() } else { format!(", largest at {nodes},") }
    )]
    MechanismDigits {
        /// How many.
        n_inside: usize,
        /// Frequency up to which they may be elastic.
        up_to_hz: f64,
        /// How well entries are known.
        known: String,
        /// What the first of them moves most.
        nodes: String,
    },
    /// The stiffness is not positive definite, with the interface held or, as it says then, with none held.
    #[entry(
        "E-NOT-DEFINITE",
        ModelPhysics,
        "close the mechanism at the dof named, or remove what makes the structure unstable"
    )]
    #[error(
        "the stiffness is not positive definite with {} – elimination stopped at {dof} – expected a positive pivot – \
        the structure has a mechanism there or is unstable, or a penalty or a mass far above all else takes its digits; {STATE_DIGITS}",
        held_words(boundary)
    )]
    NotDefinite {
        /// The dof eliminated when it happened.
        dof: String,
        /// `free` or `held`: the interface while it was factored.
        boundary: &'static str,
    },
    /// The stiffness has negative eigenvalues, counted.
    #[entry(
        "E-NEGATIVE-STIFFNESS",
        ModelPhysics,
        "reduce at a smaller preload, check negative springs and the digits of the matrix"
    )]
    #[error(
        "the stiffness has {} with {}, by a Sturm count – expected none – the component is \
        preloaded beyond buckling, has negative springs, or its matrix lacks digits, which a penalty far above all \
        else takes too; reduce it at a smaller preload; {STATE_DIGITS}",
        counted(*count, "negative eigenvalue", "negative eigenvalues"), held_words(boundary)
    )]
    IndefiniteStiffness {
        /// How many.
        count: usize,
        /// `free` or `held`.
        boundary: &'static str,
    },
    /// The forecast exceeds the memory.
    #[entry(
        "E-MEM",
        Resources,
        "free memory, raise `run.memory_gib`, make the part that is named first smaller, or set `run.precision = \
        \"mixed\"` where the message says that this fits"
    )]
    #[error("{}", forecast(*available, [*factors, *matrices, *vectors, *program], *in_single))]
    MemoryForecast {
        /// Bytes available.
        available: u64,
        /// Bytes of the factors.
        factors: u64,
        /// Bytes of the matrices.
        matrices: u64,
        /// Bytes of the constraint modes and of the eigensolver's basis.
        vectors: u64,
        /// Bytes of the program itself.
        program: u64,
        /// Bytes in all with the factor in single precision, where those are available.
        in_single: Option<u64>,
    },
    /// The forecast of `supel verify --job` exceeds the memory.
    #[entry("E-MEM-VERIFY", Resources, "free memory, raise `run.memory_gib` of the job, or verify the file by itself")]
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
    #[entry("E-OUT-OF-MEMORY", Resources, "free memory, use fewer threads or reduce a smaller model")]
    #[error("out of memory – {what} could not be allocated – free memory, use fewer threads or reduce a smaller model")]
    OutOfMemory {
        /// What was to be allocated.
        what: &'static str,
    },
    /// A solve by a factor in single precision stays less accurate than one in double.
    #[entry("E-NOT-REFINED", NumericalLimit, "use `precision = \"double\"`")]
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
    /// The shift of a Sturm count lies on an eigenvalue.
    #[entry(
        "E-STURM-PIVOT",
        NumericalLimit,
        "ask for one mode more or less; with a penalty far above all else lower it, or do without the count \
        (`run.certify = \"none\"`); for `supel certify` name another band"
    )]
    #[error(
        "the Sturm count met a pivot without a sign – the shift lies on an eigenvalue, or a penalty or a mass far \
        above all else takes the digits of the pivot – ask for one mode more or less; lower what is so large, or do without the count, \
        run.certify = \"none\" (reduce --certify none); of supel certify, name another band"
    )]
    SturmPivot,
    /// The eigensolver stalled.
    #[entry(
        "E-STALLED",
        NumericalLimit,
        "ask for another number of modes or another band, or set the other `eigensolver` in the job"
    )]
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
    /// Motions without energy in addition to the rigid-body modes.
    #[entry("E-MECHANISM", ModelPhysics, "close hinges and sliding joints or give them stiffness")]
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
    /// Modes are missing and a restart found no more.
    #[entry("E-MODES-MISSING", NumericalLimit, "compare with the eigensolver `arpack`")]
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
    /// The program was built without ARPACK.
    #[entry("E-NO-ARPACK", Usage, "use the eigensolver `lanczos` or rebuild with the feature `arpack`")]
    #[error(
        "the eigensolver arpack needs the feature \"arpack\", which this program was built without – leave \
        reduction.eigensolver (reduce --eigensolver) out"
    )]
    EigensolverMissing,
    /// ARPACK failed.
    #[entry("E-ARPACK", NumericalLimit, "set `eigensolver = \"lanczos\"` in the job")]
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
    /// Two components of an assembly have one name.
    #[entry("E-COMPONENT-NAME", Usage, "give one a name of its own: `NAME=FILE`")]
    #[error("two components are called `{name}` – expected each name once – write one of them as NAME=FILE")]
    ComponentTwice {
        /// The name.
        name: String,
    },
    /// A flag of `supel modes` names a component, an interface or a dof that is not there.
    #[entry("E-ASSEMBLY-NAME", Usage, "name one of those that the message lists, as COMPONENT.INTERFACE")]
    #[error("{typed} – {what} – expected one of {}{}", listed(known), Offered(suggestion))]
    AssemblyName {
        /// The flag and what was typed after it.
        typed: String,
        /// What is not there.
        what: String,
        /// What is.
        known: Vec<String>,
        /// The known name that looks most like it.
        suggestion: Option<String>,
    },
    /// Components that are joined have different labels of units.
    #[entry(
        "E-JOIN-UNITS",
        ModelPhysics,
        "reduce both in one system of units, or give both jobs the same `model.units`"
    )]
    #[error(
        "{a} and {b} cannot be joined – found units {} and {} – expected one system – reduce both in the same units, or \
        correct model.units of the jobs",
        units[0], units[1]
    )]
    JoinUnits {
        /// The first component.
        a: String,
        /// The second.
        b: String,
        /// Their labels.
        units: [String; 2],
    },
    /// Nodes that are joined are not at one place.
    #[entry(
        "E-JOIN-POSITION",
        ModelPhysics,
        "join the right nodes, or reduce both components in one frame and one unit of length"
    )]
    #[error(
        "{a} and {b} cannot be joined – found a distance of {} between the nodes – expected at most {} – join the right \
        nodes, or reduce both components in one frame and one unit of length",
        quantity(*distance, 4), quantity(*tolerance, 2)
    )]
    JoinPosition {
        /// The first node.
        a: String,
        /// The second.
        b: String,
        /// How far they are from each other.
        distance: f64,
        /// How far they may be: a millionth of the smaller component.
        tolerance: f64,
    },
    /// A node of an interface has no partner at its place in the interface that it is joined with.
    #[entry(
        "E-JOIN-NODES",
        ModelPhysics,
        "join interfaces whose nodes coincide; between different meshes give each a rigid interface"
    )]
    #[error(
        "{a} and {b} cannot be joined – found no partner for {node} – expected a node of each at every place – reduce with \
        nodes that coincide, or give each a rigid interface"
    )]
    JoinNodes {
        /// The first interface and how many nodes it has.
        a: String,
        /// The second.
        b: String,
        /// The node without a partner.
        node: String,
    },
    /// Nodes that are joined have no direction in common.
    #[entry("E-JOIN-DOFS", ModelPhysics, "join nodes of the same kind: nodes with nodes, rows with rows")]
    #[error(
        "{a} and {b} cannot be joined – found dofs `{}` and `{}` – expected a direction that both have – join nodes with \
        nodes and rows with rows",
        dofs[0], dofs[1]
    )]
    JoinDofs {
        /// The first node.
        a: String,
        /// The second.
        b: String,
        /// Their directions; none for rows.
        dofs: [String; 2],
    },
    /// Two nodes are joined that are one already.
    #[entry("E-JOIN-TWICE", Usage, "name each pair once")]
    #[error("{a} and {b} are joined already – found one node of the assembly – expected two – name each pair once")]
    JoinedTwice {
        /// The first.
        a: String,
        /// The second.
        b: String,
    },
    /// A mass is put on a node that has no dof to carry it.
    #[entry("E-POINT-MASS", ModelPhysics, "put it on a node with these dofs, as those of rigid interfaces have")]
    #[error(
        "{place} cannot carry the mass – found {} – expected {lacking} among them – {}",
        if dofs.is_empty() { "rows without directions".to_owned() } else { format!("dofs `{dofs}`") },
        if dofs.is_empty() { "give the model of the component a dof map" } else { SIX_DOFS }
    )]
    PointMassDofs {
        /// The node.
        place: String,
        /// The direction that is not there.
        lacking: String,
        /// The directions that are.
        dofs: String,
    },
    /// Every coordinate of an assembly is held.
    #[entry("E-ASSEMBLY-HELD", ModelPhysics, "hold less")]
    #[error("nothing of the assembly moves – found every coordinate held – expected one that is free – hold less")]
    AssemblyHeld,
    /// A motion of an assembly has neither stiffness nor mass.
    #[entry("E-ASSEMBLY-SINGULAR", ModelPhysics, "hold it, or give it stiffness or mass")]
    #[error(
        "a motion of the assembly has neither stiffness nor mass – largest at {at} – expected one of them – hold it, or \
        give it stiffness or mass"
    )]
    AssemblySingular {
        /// The coordinate.
        at: String,
    },
    /// A component has negative mass, or an assembly negative stiffness.
    #[entry("E-ASSEMBLY-INDEFINITE", InputData, "check the files with `supel verify`")]
    #[error(
        "{what} has a negative {matrix} – found {value:.1e} of its largest – expected zero or more – check the files with supel \
        verify"
    )]
    AssemblyIndefinite {
        /// The component, or the assembly.
        what: String,
        /// Stiffness or mass.
        matrix: &'static str,
        /// The eigenvalue, relative to the largest.
        value: f64,
    },
    /// A component was reduced for statics alone.
    #[entry("E-ASSEMBLY-STATIC", InputData, "reduce the component for another analysis than `static`")]
    #[error(
        "component {name} was reduced for statics alone and has no mass – expected one – reduce it for another analysis than `static`"
    )]
    AssemblyNoMass {
        /// The component.
        name: String,
    },
    /// A component was reduced by a method that leaves static answers without mass.
    #[entry("E-ASSEMBLY-MASSLESS", InputData, "reduce the component with herting, whose space is the same")]
    #[error(
        "component {name} has a singular mass by its method – found the mass of its free modes alone – expected that of all its \
        coordinates, without which motions of an assembly have no frequency – reduce it with herting, whose space is the same"
    )]
    AssemblySingularMass {
        /// The component.
        name: String,
    },
    /// The rigid-body modes of a component strain it.
    #[entry("E-ASSEMBLY-RIGID", InputData, "check the file with `supel verify`")]
    #[error(
        "the rigid-body modes of {name} strain it – found an energy of {value:.1e} of that of the first mode – expected none \
        beyond rounding – check the file with supel verify"
    )]
    AssemblyRigid {
        /// The component.
        name: String,
        /// The largest energy relative to that of the first mode, both at unit modal mass.
        value: f64,
    },
    /// The matrices of an assembly do not fit into the memory.
    #[entry("E-MEM-MODES", Resources, "free memory, or reduce the components with fewer interface dofs and modes")]
    #[error(
        "the modes of {} need {} – {} of memory is available – free memory, or reduce the components with fewer interface \
        dofs and modes",
        counted(*n, "coordinate", "coordinates"), bytes(*needed), bytes(*available)
    )]
    MemoryAssembly {
        /// Coordinates of all components.
        n: usize,
        /// Bytes needed.
        needed: u64,
        /// Bytes available.
        available: u64,
    },
    /// A file is not a superelement, or cannot be made one.
    #[entry("E-SUPERELEMENT", InputData, "the message says what is wrong with it; write it again with `supel reduce`")]
    #[error("{}: {source}", path.display())]
    SuperelementFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: FileError,
    },
}

impl Error {
    /// The class of this error, which is its exit code.
    pub fn class(&self) -> ErrorClass {
        match self {
            Self::SuperelementFile { source: FileError::OutOfMemory { .. }, .. } => ErrorClass::Resources,
            // The system has no memory for itself.
            Self::Read { source, .. } | Self::Write { source, .. }
                if source.kind() == std::io::ErrorKind::OutOfMemory =>
            {
                ErrorClass::Resources
            }
            _ => self.stated_class(),
        }
    }

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

/// A document as a JSON value; `what` is what an error calls it.
///
/// # Errors
/// [`Error::NotJson`] where a path in it is not UTF-8.
pub(crate) fn json_value(what: &'static str, document: &impl Serialize) -> Result<serde_json::Value> {
    serde_json::to_value(document).map_err(|source| Error::NotJson { what, source })
}
