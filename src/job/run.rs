//! How a run is done: what it proves, holds and leaves out.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How completeness of the modes is certified.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Certify {
    /// Not at all; the report says so.
    None,
    /// By a Sturm count above the highest mode.
    #[default]
    Count,
    /// By a count that is proved against rounding, with an interval around every eigenvalue that is proved to hold it.
    Full,
}

/// How the entries of the factor are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// In double precision.
    #[default]
    Double,
    /// In single precision, half the memory; conjugate gradients bring every solve to double precision.
    Mixed,
    /// In double precision where it fits into the memory, in single where it does not, with a warning.
    Auto,
}

impl Precision {
    fn is_double(&self) -> bool {
        *self == Self::Double
    }
}

/// How the constraint modes are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ConstraintStorage {
    /// Stored up to a GiB, or where rows of them are asked for.
    #[default]
    Auto,
    /// Stored.
    Stored,
    /// Made by the factor whenever they are needed, some at a time: more solves in the place of memory.
    ByFactor,
}

impl ConstraintStorage {
    fn is_auto(&self) -> bool {
        *self == Self::Auto
    }
}

/// Which work a run leaves out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Skip {
    /// What the scene never asks.
    #[default]
    ByScene,
    /// Nothing: whatever could be asked is computed, to compare it with.
    Nothing,
}

impl Skip {
    fn is_by_scene(&self) -> bool {
        *self == Self::ByScene
    }
}

/// How the run is done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RunJob {
    /// Certificate of completeness.
    #[serde(default)]
    #[schemars(extend("x-role" = "way"))]
    pub certify: Certify,
    /// Memory the run may use, in GiB; what the machine has free where absent.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-role" = "place"))]
    pub memory_gib: Option<f64>,
    /// How the factor is kept.
    #[serde(default, skip_serializing_if = "Precision::is_double")]
    #[schemars(extend("default" = "double", "x-role" = "way"))]
    pub precision: Precision,
    /// How the constraint modes are kept.
    #[serde(default, skip_serializing_if = "ConstraintStorage::is_auto")]
    #[schemars(extend("default" = "auto", "x-role" = "way"))]
    pub constraint_modes: ConstraintStorage,
    /// What the run leaves out.
    #[serde(default, skip_serializing_if = "Skip::is_by_scene")]
    #[schemars(extend("default" = "by-scene"))]
    pub skip: Skip,
}
