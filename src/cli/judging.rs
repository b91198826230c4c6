//! How a command that judges answers: what stdout carries, and whether warnings count.

use crate::job::{Duplicates, Job};
use crate::report::Reservations;

/// What stdout carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Answer {
    Text,
    Json,
    Nothing,
}

/// By the flags `--json` and `--quiet`, of which the first wins.
impl From<(bool, bool)> for Answer {
    fn from(flags: (bool, bool)) -> Self {
        match flags {
            (true, _) => Self::Json,
            (false, true) => Self::Nothing,
            (false, false) => Self::Text,
        }
    }
}

/// Whether warnings count as failed checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Strictness {
    Normal,
    Strict,
}

/// By the flag `--strict`.
impl From<bool> for Strictness {
    fn from(is_strict: bool) -> Self {
        if is_strict { Self::Strict } else { Self::Normal }
    }
}

impl Strictness {
    /// What a report says of warnings.
    pub(super) fn reservations(self) -> Reservations {
        match self {
            Self::Normal => Reservations::Accepted,
            Self::Strict => Reservations::Refused,
        }
    }

    /// A job as its files are read: strictly, matrices whose entries repeat a position are refused.
    pub(super) fn reading(self, mut job: Job) -> Job {
        if self == Self::Strict {
            job.model.duplicates = Duplicates::Refuse;
        }
        job
    }
}
