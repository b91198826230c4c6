//! The direction of a degree of freedom.

use serde::{Deserialize, Serialize};

/// The direction of a degree of freedom, in the order of the classical six.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Translation along x.
    Ux,
    /// Translation along y.
    Uy,
    /// Translation along z.
    Uz,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}

impl Direction {
    /// All six, in order; their places are the numbers in `recovery_dofs`.
    pub const ALL: [Self; 6] = [Self::Ux, Self::Uy, Self::Uz, Self::Rx, Self::Ry, Self::Rz];

    /// The axis 0, 1 or 2.
    pub fn axis(self) -> usize {
        self as usize % 3
    }

    /// True for a rotation.
    pub fn is_rotation(self) -> bool {
        self as usize >= 3
    }
}

impl core::fmt::Display for Direction {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(["ux", "uy", "uz", "rx", "ry", "rz"][*self as usize])
    }
}
