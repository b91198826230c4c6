//! What becomes of a superelement that failed a check.

use std::path::Path;

use supel_runtime::Verdict;

/// Whether results of a superelement that failed a check are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unverified {
    Refused,
    Written,
}

/// By the flag `--allow-unverified`.
impl From<bool> for Unverified {
    fn from(is_given: bool) -> Self {
        if is_given { Self::Written } else { Self::Refused }
    }
}

impl Unverified {
    /// Whether a superelement that failed a check when it was made is refused.
    pub(super) fn refuses(self, verdict: Verdict) -> bool {
        verdict == Verdict::Fail && self == Self::Refused
    }
}

/// Why nothing is made of a superelement that is refused: `done` and `used` say what would have been.
pub(super) fn refusal(file: &Path, done: &str, used: &str) -> String {
    let advice = format!("see `supel inspect`, or {used} it anyway with --allow-unverified");
    format!("supel: {}: {done}: a check failed when it was made – {advice}", file.display())
}
