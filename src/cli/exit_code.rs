//! The exit codes, a contract with scripts and CI jobs.

use crate::error::ErrorClass;

/// How a command ended; the number is the exit code of the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExitCode {
    /// Done and verified.
    Done = 0,
    /// Done, but a check failed (with `--strict`: or there are warnings).
    CheckFailed = 1,
    /// The command line or the job document is wrong.
    Usage = 2,
    /// A file's content is wrong.
    InputData = 3,
    /// The matrices do not describe a component that can be reduced as asked.
    ModelPhysics = 4,
    /// The arithmetic cannot give what was asked.
    NumericalLimit = 5,
    /// Not enough memory or threads.
    Resources = 6,
    /// A file could not be read or written.
    Io = 7,
    /// A defect of the program.
    InternalError = 70,
}

impl ExitCode {
    /// How a process of this program ended by its exit code; one that is none of these is a defect.
    pub(super) fn of_process(code: i32) -> Self {
        let known = [
            Self::Done,
            Self::CheckFailed,
            Self::Usage,
            Self::InputData,
            Self::ModelPhysics,
            Self::NumericalLimit,
            Self::Resources,
            Self::Io,
        ];
        known.into_iter().find(|known| *known as i32 == code).unwrap_or(Self::InternalError)
    }
}

impl From<ErrorClass> for ExitCode {
    fn from(class: ErrorClass) -> Self {
        match class {
            ErrorClass::Usage => Self::Usage,
            ErrorClass::InputData => Self::InputData,
            ErrorClass::ModelPhysics => Self::ModelPhysics,
            ErrorClass::NumericalLimit => Self::NumericalLimit,
            ErrorClass::Resources => Self::Resources,
            ErrorClass::Io => Self::Io,
        }
    }
}
