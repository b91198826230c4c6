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

impl Warning {
    /// Whether it says how the answer suits what is asked of it, and nothing of the reduction itself.
    pub fn is_of_scene(&self) -> bool {
        ["W-ACCURACY", "W-LARGE", "W-NO-MODES"].contains(&self.code)
    }
}
