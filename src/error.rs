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
    // ---- job and command line --------------------------------------------------------------------------------------
    // ---- model -----------------------------------------------------------------------------------------------------
    // ---- partition -------------------------------------------------------------------------------------------------
    // ---- factor ----------------------------------------------------------------------------------------------------
    // ---- modes -----------------------------------------------------------------------------------------------------
    // ---- superelement file -----------------------------------------------------------------------------------------
    /// A superelement file cannot be read or written; the message names it.
    #[error(transparent)]
    SuperelementAccess(supel_runtime::FileError),
    /// The content of a superelement file, or of one to be written, is not a superelement.
    #[error("{}: {source}", path.display())]
    SuperelementContent {
        /// The file.
        path: PathBuf,
        /// Why.
        source: supel_runtime::FileError,
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
    /// Why the superelement file at `path` could not be written or read.
    pub fn superelement(path: &std::path::Path, source: supel_runtime::FileError) -> Self {
        if source.is_io() {
            Self::SuperelementAccess(source)
        } else {
            Self::SuperelementContent {
                path: path.to_owned(),
                source,
            }
        }
    }

    /// The class of this error, which is its exit code.
    pub fn class(&self) -> ErrorClass {
        match self {
            Self::Read { .. } | Self::Write { .. } => ErrorClass::Io,
            Self::SuperelementAccess(_) => ErrorClass::Io,
            Self::SuperelementContent {
                source: supel_runtime::FileError::OutOfMemory { .. },
                ..
            } => ErrorClass::Resources,
            Self::SuperelementContent { .. } => ErrorClass::InputData,
        }
    }
}
