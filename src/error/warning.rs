//! What a user is told that does not end the run.

use serde::Serialize;

/// What the user should know although no check failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// Stable code, `W-FEWER-MODES`.
    pub code: &'static str,
    /// One sentence.
    pub message: String,
}
