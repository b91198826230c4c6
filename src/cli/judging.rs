//! How a command that judges answers: what stdout carries, and whether warnings count.

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
