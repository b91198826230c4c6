//! The kinds of entries.

use serde::Serialize;

/// What an entry holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The factor of K_II.
    Factor,
    /// A count of eigenvalues.
    Count,
    /// Modes.
    Modes,
    /// The frequency response of a full model.
    Response,
    /// How far modes are certified, and which entry has them.
    Band,
    /// The space that the response of a full model was found in.
    Space,
    /// The order of elimination.
    Order,
    /// Constraint modes, and the condition of the interior.
    Statics,
}

impl Kind {
    pub(super) const ALL: [Self; 8] =
        [Self::Factor, Self::Count, Self::Modes, Self::Response, Self::Band, Self::Space, Self::Order, Self::Statics];

    /// What the names of its entries begin with.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Factor => "factor",
            Self::Count => "count",
            Self::Modes => "modes",
            Self::Response => "response",
            Self::Band => "band",
            Self::Space => "space",
            Self::Order => "order",
            Self::Statics => "statics",
        }
    }
}
