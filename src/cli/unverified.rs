//! What becomes of a superelement that failed a check.

/// Whether results of a superelement that failed a check are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unverified {
    Refused,
    Written,
}

impl Unverified {
    /// By the flag `--allow-unverified`.
    pub(super) fn of(allow_unverified: bool) -> Self {
        if allow_unverified { Self::Written } else { Self::Refused }
    }
}
