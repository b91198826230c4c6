//! What a job says of mechanisms.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is said of mechanisms, which are kept as zero modes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Mechanisms {
    /// A warning.
    #[default]
    Warn,
    /// They are meant, and stand among the assumptions.
    Accept,
}

impl Mechanisms {
    pub(super) fn are_warned_of(&self) -> bool {
        *self == Self::Warn
    }
}
