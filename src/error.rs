//! Every way a run can fail, one variant each, with the values that explain it.
//!
//! A message reads *what – where – found – expected – what to do*, in lower case and without a full stop. The variant
//! decides the exit code, so that a CI job can tell bad input from a bad model from a full disk.

use std::fmt;
use std::path::{Path, PathBuf};

use supel_runtime::FileError;

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
    // ---- job and command line --------------------------------------------------------------------------------------
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
    #[error("`{key}` is {value} – expected {expected}")]
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
        key: &'static str,
        /// What it does not go with.
        situation: &'static str,
        /// Another way out, with its leading word, or nothing.
        remedy: &'static str,
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
    /// Neither a job document nor the flags that replace it were given.
    #[error("{} missing – give a job document, or all of --stiffness, --mass, --method, a number of modes and --output",
        flags.join(", "))]
    MissingFlags {
        /// The flags that are missing.
        flags: Vec<&'static str>,
    },
    /// The text of a flag cannot be understood.
    #[error("{flag} {text}: expected {expected}")]
    FlagText {
        /// The flag.
        flag: &'static str,
        /// What was typed.
        text: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// The working threads could not be started.
    #[error("{n_threads} threads cannot be started: {source} – ask for fewer with --threads")]
    Threads {
        /// How many were asked for.
        n_threads: usize,
        /// What the system said.
        source: rayon::ThreadPoolBuildError,
    },
    // ---- model -----------------------------------------------------------------------------------------------------
    // ---- partition -------------------------------------------------------------------------------------------------
    // ---- factor ----------------------------------------------------------------------------------------------------
    // ---- modes -----------------------------------------------------------------------------------------------------
    // ---- superelement file -----------------------------------------------------------------------------------------
    /// A file is not a superelement, or cannot be made one.
    #[error("{}: {source}", path.display())]
    SuperelementFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: FileError,
    },
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
    /// The error of this crate for what the superelement file's crate says of `path`.
    pub fn from_file(path: &Path, error: FileError) -> Self {
        match error {
            FileError::Read { path, source } => Self::Read { path, source },
            FileError::Write { path, source } => Self::Write { path, source },
            source => Self::SuperelementFile {
                path: path.to_owned(),
                source,
            },
        }
    }

    /// The class of this error, which is its exit code.
    pub fn class(&self) -> ErrorClass {
        match self {
            Self::Read { .. } | Self::Write { .. } => ErrorClass::Io,
            Self::JobSyntax { .. }
            | Self::JobKey { .. }
            | Self::JobNumber { .. }
            | Self::JobEmpty { .. }
            | Self::InterfaceTwice { .. }
            | Self::InterfaceRepeats { .. }
            | Self::InterfaceOverlap { .. }
            | Self::InterfaceNodes { .. }
            | Self::InterfaceConflict { .. }
            | Self::OutputName { .. }
            | Self::MissingFlags { .. }
            | Self::FlagText { .. } => ErrorClass::Usage,
            Self::Threads { .. } => ErrorClass::Resources,
            Self::SuperelementFile {
                source: FileError::OutOfMemory { .. },
                ..
            } => ErrorClass::Resources,
            Self::SuperelementFile {
                source: FileError::NotAFile { .. },
                ..
            } => ErrorClass::Io,
            Self::SuperelementFile { .. } => ErrorClass::InputData,
        }
    }
}

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
