//! The directions of degrees of freedom.

/// The direction of a degree of freedom, in the order of the classical six.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
)]
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
    /// All six, in order.
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

impl std::fmt::Display for Direction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(["ux", "uy", "uz", "rx", "ry", "rz"][*self as usize])
    }
}
