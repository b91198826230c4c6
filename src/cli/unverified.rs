//! What becomes of a superelement that failed a check.

/// Whether results of a superelement that failed a check are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unverified {
    Refused,
    Written,
}
