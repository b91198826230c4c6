//! What is known of how coordinates and dof map fit K.

use faer::Mat;

use super::recentred;

/// Whether the coordinates and the dof map of a model belong to its stiffness.
#[derive(Clone, Debug, Default)]
pub enum CoordinateFit {
    /// Not compared: the model has no coordinates or no dof map.
    #[default]
    Unknown,
    /// Every row that no support touches lets the six motions by the coordinates pass.
    Exact,
    /// They do but for rounding of the coordinates.
    Rounded(RoundedCoordinates),
    /// Translations pass, and rotations turn the internal forces of the preloaded state that K is the tangent of.
    Preloaded,
}

/// The rigid-body motions of a model whose coordinates, or axes of nodes, are rounded, as K knows them.
#[derive(Clone, Debug)]
pub struct RoundedCoordinates {
    /// The rotation that K lets pass worst by the coordinates as they are; none where axes of nodes are rounded instead.
    pub misfit: Option<Misfit>,
    /// The point that the rotations turn about.
    pub centre: [f64; 3],
    /// The six unit motions of every row about that point, n × 6, without what rounding of the coordinates put into them:
    /// combinations of motions that K lets pass. Rows that nothing moves freely keep the motion of their coordinates.
    pub motions: Mat<f64>,
}

/// A rotation by the coordinates that K does not let pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// The axis of the rotation.
    pub rotation: &'static str,
    /// The energy of the worst rigid motion of the coordinates, relative to another.
    pub energy: f64,
    /// What it is relative to.
    pub of: &'static str,
    /// The dofs where the force is largest, one for each of three nodes.
    pub at: String,
}

impl CoordinateFit {
    /// The rounding of the coordinates, where they are rounded.
    pub fn rounded(&self) -> Option<&RoundedCoordinates> {
        match self {
            Self::Rounded(rounded) => Some(rounded),
            Self::Unknown | Self::Exact | Self::Preloaded => None,
        }
    }

    /// Whether K is the tangent of a preloaded state: its rotations make forces, and only motions that make none are rigid.
    pub fn is_preloaded(&self) -> bool {
        matches!(self, Self::Preloaded)
    }
}

impl RoundedCoordinates {
    /// The six unit motions of a row about a point.
    pub fn motion(&self, row: usize, centre: [f64; 3]) -> [f64; 6] {
        recentred(std::array::from_fn(|j| self.motions[(row, j)]), self.centre, centre)
    }
}
