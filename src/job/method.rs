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
    /// Residual attachment modes and free-free modes: the space of Herting's method, written in Herting's variables.
    Rubin,
    /// The space of Rubin's method with the mass of its free-free modes alone: the residual flexibility has none.
    Macneal,
    /// Constraint modes and mode-accelerated modes computed with some interface dofs held and the others free.
    MixedInterface,
    /// Constraint modes alone: exact in statics, without modes.
    Guyan,
    /// Constraint modes and the mode-accelerated modes of a file, measured or any others.
    ModeAcceleration,
}

/// Where the modes of a method come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeOrigin {
    /// They are computed here.
    Computed,
    /// A file of the job has them.
    File,
    /// The method has none.
    None,
}

/// The boundary condition modes are computed under.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// Interface free.
    FreeInterface,
    /// Interface held.
    FixedInterface,
    /// Some interface dofs held, the others free.
    MixedInterface,
}

/// The motions that a reduced mass sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassOf {
    /// All that the columns of Ψ make: M̂ = ΨᵀMΨ (31).
    AllMotions,
    /// The retained modes and those of rigid bodies; what statics adds to them has no mass.
    RetainedModes,
}

impl Boundary {
    /// The boundary that holds `n_held` of the interface: mixed boundaries that hold all of it, or nothing, are those of others.
    pub fn holding(self, n_held: usize, n_interface: usize) -> Self {
        match self {
            Self::MixedInterface if n_held == n_interface => Self::FixedInterface,
            Self::MixedInterface if n_held == 0 => Self::FreeInterface,
            other => other,
        }
    }
}

impl Method {
    /// What a superelement file calls it.
    pub fn in_file(self) -> supel_runtime::Method {
        match self {
            Self::CraigBampton => supel_runtime::Method::CraigBampton,
            Self::Herting => supel_runtime::Method::Herting,
            Self::Rubin => supel_runtime::Method::Rubin,
            Self::Macneal => supel_runtime::Method::Macneal,
            Self::MixedInterface => supel_runtime::Method::MixedInterface,
            Self::Guyan => supel_runtime::Method::Guyan,
            Self::ModeAcceleration => supel_runtime::Method::ModeAcceleration,
        }
    }

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        self.in_file().name()
    }

    /// Its name in jobs.
    pub fn key(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }

    /// The method of a file; none where this program does not make it.
    pub fn of_file(method: supel_runtime::Method) -> Option<Self> {
        Self::value_variants().iter().copied().find(|known| known.in_file() == method)
    }

    /// The boundary whose modes it keeps. Modes of a file may have any; none is computed next to them, with the interface held.
    pub fn boundary(self) -> Boundary {
        match self {
            Self::CraigBampton | Self::Guyan | Self::ModeAcceleration => Boundary::FixedInterface,
            Self::Herting | Self::Rubin | Self::Macneal => Boundary::FreeInterface,
            Self::MixedInterface => Boundary::MixedInterface,
        }
    }

    /// Where its modes come from.
    pub fn modes(self) -> ModeOrigin {
        match self {
            Self::CraigBampton | Self::Herting | Self::Rubin | Self::Macneal | Self::MixedInterface => {
                ModeOrigin::Computed
            }
            Self::ModeAcceleration => ModeOrigin::File,
            Self::Guyan => ModeOrigin::None,
        }
    }

    /// Whether inertia-relief modes are part of it; of other methods the job may ask for them.
    pub fn has_inertia_relief(self) -> bool {
        self.boundary() == Boundary::FreeInterface
    }

    /// The motions that its reduced mass sees.
    pub fn mass(self) -> MassOf {
        match self {
            Self::Macneal => MassOf::RetainedModes,
            Self::CraigBampton
            | Self::Herting
            | Self::Rubin
            | Self::MixedInterface
            | Self::Guyan
            | Self::ModeAcceleration => MassOf::AllMotions,
        }
    }

    /// Whether it is proved that the space is that of the residual attachment modes (50).
    pub fn has_attachment_modes(self) -> bool {
        self == Self::Rubin
    }
}
