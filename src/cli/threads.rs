//! How many threads a command works with.

use super::process;

/// How many threads work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Threads {
    /// As many as were asked for, or as the machine runs at once.
    pub(super) asked: usize,
    /// As many as are of use.
    pub(super) used: usize,
}

impl Threads {
    pub(super) fn of(asked: Option<u16>) -> Self {
        let asked = asked.map_or_else(process::available_threads, usize::from);
        Self { asked, used: process::useful_threads(asked) }
    }
}
