//! What a further matrix of the file is.

use alloc::string::String;

use serde::{Deserialize, Serialize};

/// A further matrix A of the component in addition to stiffness and mass, of which the tensor `matrices` has ΨᵀAΨ.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedMatrix {
    /// Its name, by which it is told from the others.
    pub name: String,
    /// What it is.
    pub kind: MatrixKind,
}

/// What a further matrix is, and what it multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum MatrixKind {
    /// Damping, a force per velocity; part of the tensor `damping`. It need not be symmetric.
    Damping,
    /// Gyroscopic, a force per velocity and per unit of a rotation speed; skew to the bit.
    Gyroscopic,
    /// Geometric stiffness, a force per displacement and per unit of a load or of the square of a rotation speed; symmetric to the bit.
    GeometricStiffness,
    /// Circulatory, a force per displacement that does not come from an energy.
    Circulatory,
    /// Whatever the name says.
    Other,
}

/// What the entries of a matrix at (i, j) and (j, i) have to do with each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// They are equal.
    Symmetric,
    /// They are opposite, and the diagonal is zero.
    Skew,
}

impl MatrixKind {
    /// All kinds.
    pub const ALL: [Self; 5] =
        [Self::Damping, Self::Gyroscopic, Self::GeometricStiffness, Self::Circulatory, Self::Other];

    /// Its name in documents and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Damping => "damping",
            Self::Gyroscopic => "gyroscopic",
            Self::GeometricStiffness => "geometric-stiffness",
            Self::Circulatory => "circulatory",
            Self::Other => "other",
        }
    }

    /// What every matrix of this kind is; none where one may be neither symmetric nor skew.
    pub fn symmetry(self) -> Option<Symmetry> {
        match self {
            Self::Gyroscopic => Some(Symmetry::Skew),
            Self::GeometricStiffness => Some(Symmetry::Symmetric),
            Self::Damping | Self::Circulatory | Self::Other => None,
        }
    }
}

impl core::fmt::Display for MatrixKind {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}
