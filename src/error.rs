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
    // ---- hdf5 input ------------------------------------------------------------------------------------------------
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
    #[error("{}:{object}: a soft or external link, and links are not followed – give the path of the object itself", path.display())]
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
        "{}:{object}: promises {promised} – its stored bytes can hold at most {available} bytes – \
         the file is damaged or the dataset was never written",
        path.display()
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
    #[error("{}:{object}: more than {limit} {counted} – the file is damaged or its groups contain themselves", path.display())]
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
        "{}:{group}: no sparse matrix – found {} – expected a MATLAB v7.3 or PETSc (`MATLAB_sparse`), anndata, h5sparse or \
         Exudyn group, or one with data, indices and indptr",
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
    #[error("{}:{group}: found a matrix of {n_rows} × {n_cols} – expected a square one of at most {} rows", path.display(), u32::MAX)]
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
    #[error("{}:{dataset}: the entry of row {row}, column {col} (both from 0) is {value} – expected a finite number", path.display())]
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
        "{}: no mesh that can be read – found {} – expected .hmf (/domain/grid/Geometry), XDMF, .med (/ENS_MAA) or .h5m (/tstt)",
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
    #[error("{}:{object}: coordinate {} of node {label} is {value} – expected a finite number", path.display(), ["x", "y", "z"][*axis % 3])]
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
    /// An XDMF file names a data file outside its own folder.
    #[error(
        "{}: refers to data in {reference} – expected a `file.h5:/path` in the folder of the XDMF file – move the data there",
        path.display()
    )]
    XdmfReference {
        /// The file.
        path: PathBuf,
        /// The reference as it is written.
        reference: String,
    },
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
            Self::Hdf5Signature { .. }
            | Self::Hdf5Open { .. }
            | Self::Hdf5Read { .. }
            | Self::Hdf5Missing { .. }
            | Self::Hdf5Link { .. }
            | Self::Hdf5ExternalStorage { .. }
            | Self::Hdf5Filter { .. }
            | Self::Hdf5Size { .. }
            | Self::Hdf5Depth { .. }
            | Self::Hdf5Type { .. }
            | Self::Hdf5Shape { .. }
            | Self::Hdf5NoMatrix { .. }
            | Self::Hdf5AmbiguousMatrix { .. }
            | Self::Hdf5EmptyMatrix { .. }
            | Self::Hdf5NotSquare { .. }
            | Self::Hdf5Pointer { .. }
            | Self::Hdf5Index { .. }
            | Self::Hdf5NotFinite { .. }
            | Self::MeshUnknown { .. }
            | Self::MeshNotOne { .. }
            | Self::MeshUnsupported { .. }
            | Self::MeshNotFinite { .. }
            | Self::MeshLabelTwice { .. }
            | Self::XdmfSyntax { .. }
            | Self::XdmfReference { .. } => ErrorClass::InputData,
        }
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
