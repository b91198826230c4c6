//! What one reduced coordinate is.

use alloc::string::String;

use serde::{Deserialize, Serialize};

use crate::direction::Direction;

/// What one reduced coordinate is.
///
/// `mode` counts the entries of `frequencies` from 0. Where the tensor `mixing` is present the modal coordinates name
/// the columns *before* mixing: stored dynamic modes = named modes · mixing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Coordinate {
    /// Displacement or rotation of an interface node.
    Interface {
        /// Number of the interface node, from 0.
        node: usize,
        /// Direction.
        direction: Direction,
    },
    /// Displacement of an interface row of a model that has no nodes.
    InterfaceRow {
        /// Row of the model's matrices, from 0.
        row: u64,
    },
    /// Amplitude of a rigid-body mode: of the motion itself in a component without interface; beside an interface that leaves some
    /// rigid-body motion free, of what Rubin's static modes leave of it.
    RigidBodyMode {
        /// Number of the rigid-body mode, from 0.
        index: usize,
    },
    /// Amplitude of an inertia-relief mode.
    InertiaRelief {
        /// Number of the rigid-body mode whose inertia loads it answers, from 0.
        index: usize,
    },
    /// Amplitude of a mode-accelerated expansion mode: the static answer to the inertia forces of a mode that a file gave.
    ExpansionMode {
        /// Column of the file, from 0.
        column: usize,
    },
    /// Amplitude of a residual vector, the static answer to a load.
    ResidualVector {
        /// Number of the load among `load_names`, from 0.
        load: usize,
    },
    /// Amplitude of a free-free normal mode.
    ElasticMode {
        /// Number of the mode.
        mode: usize,
        /// Natural frequency.
        frequency_hz: f64,
        /// Bound of the error of the natural frequency.
        error_bar_hz: Option<f64>,
    },
    /// Amplitude of a fixed-interface normal mode.
    FixedInterfaceMode {
        /// Number of the mode.
        mode: usize,
        /// Natural frequency.
        frequency_hz: f64,
        /// Bound of the error of the natural frequency.
        error_bar_hz: Option<f64>,
    },
    /// Amplitude of a mode-accelerated normal mode with some interface dofs held, those of `Metadata::modes_held`, and the others free.
    MixedInterfaceMode {
        /// Number of the mode.
        mode: usize,
        /// Natural frequency.
        frequency_hz: f64,
        /// Bound of the error of the natural frequency.
        error_bar_hz: Option<f64>,
    },
}

impl Coordinate {
    /// True for u_B, false for η.
    pub fn is_interface(&self) -> bool {
        matches!(self, Self::Interface { .. } | Self::InterfaceRow { .. })
    }

    /// What the amplitude of a mode is called in messages, counted from one: `mode 3`, `residual vector of thrust`; none for an interface
    /// coordinate. `load_names` are those of the file.
    pub fn mode_name(&self, load_names: &[String]) -> Option<String> {
        Some(match self {
            Self::Interface { .. } | Self::InterfaceRow { .. } => return None,
            Self::RigidBodyMode { index } => format!("rigid-body mode {}", index + 1),
            Self::InertiaRelief { index } => format!("inertia relief {}", index + 1),
            Self::ExpansionMode { column } => format!("expansion mode {}", column + 1),
            Self::ResidualVector { load } => {
                format!("residual vector of {}", load_names.get(*load).map_or("no load", String::as_str))
            }
            Self::ElasticMode { mode, .. }
            | Self::FixedInterfaceMode { mode, .. }
            | Self::MixedInterfaceMode { mode, .. } => format!("mode {}", mode + 1),
        })
    }

    /// Number of the mode and its frequency in Hz, for a coordinate that has them.
    pub fn mode(&self) -> Option<(usize, f64)> {
        match *self {
            Self::ElasticMode { mode, frequency_hz, .. }
            | Self::FixedInterfaceMode { mode, frequency_hz, .. }
            | Self::MixedInterfaceMode { mode, frequency_hz, .. } => Some((mode, frequency_hz)),
            _ => None,
        }
    }

    /// Bound of the error of the frequency in Hz, for a coordinate that states one.
    pub fn error_bar_hz(&self) -> Option<f64> {
        match *self {
            Self::ElasticMode { error_bar_hz, .. }
            | Self::FixedInterfaceMode { error_bar_hz, .. }
            | Self::MixedInterfaceMode { error_bar_hz, .. } => error_bar_hz,
            _ => None,
        }
    }
}
