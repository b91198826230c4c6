//! How a command that judges answers: what stdout carries, and whether warnings count.

/// What stdout carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Answer {
    Text,
    Json,
    Nothing,
}

/// Whether warnings count as failed checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Strictness {
    Normal,
    Strict,
}
