//! The reduction methods: the one place that says what a method means.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The reduction method: which modes fill the dynamic mode matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Constraint modes and fixed-interface normal modes.
    CraigBampton,
    /// Constraint modes, inertia-relief modes and mode-accelerated free-free modes.
    Herting,
}

/// The boundary condition modes are computed under.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// Interface free.
    FreeInterface,
    /// Interface held.
    FixedInterface,
}

/// What becomes of modes as columns of the dynamic mode matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// They stay as they are (38).
    Modes,
    /// They are accelerated, and inertia-relief modes come before them (23), (37).
    ModeAcceleration,
}

impl Method {
    /// What a superelement file calls it.
    pub fn in_file(self) -> supel_runtime::Method {
        match self {
            Self::CraigBampton => supel_runtime::Method::CraigBampton,
            Self::Herting => supel_runtime::Method::Herting,
        }
    }

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        self.in_file().name()
    }

    /// The method of a file; none where this program does not make it.
    pub fn of_file(method: supel_runtime::Method) -> Option<Self> {
        Self::value_variants().iter().copied().find(|known| known.in_file() == method)
    }

    /// The boundary whose modes it keeps.
    pub fn boundary(self) -> Boundary {
        match self {
            Self::CraigBampton => Boundary::FixedInterface,
            Self::Herting => Boundary::FreeInterface,
        }
    }

    /// What it makes of them.
    pub fn columns(self) -> Columns {
        match self {
            Self::CraigBampton => Columns::Modes,
            Self::Herting => Columns::ModeAcceleration,
        }
    }
}
