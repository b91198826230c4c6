//! What decisions need to know of a model once it has been read.

use supel_runtime::RigidBodyModes;

/// Sizes and properties of a partitioned model.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// n', dofs that move.
    pub n_dofs: usize,
    /// n_I.
    pub n_internal: usize,
    /// n_B.
    pub n_interface: usize,
    /// n_r.
    pub n_rigid: usize,
    /// What the rigid-body modes are: the six unit motions, or others.
    pub modes_in_file: RigidBodyModes,
    /// Whether they come from coordinates.
    pub has_geometric_modes: bool,
    /// Whether the interface holds the component.
    pub hold: Hold,
    /// Whether M has entries off its diagonal.
    pub mass: MassPattern,
    /// Connected parts of the interior, the interface taken out.
    pub n_parts: usize,
    /// For each load of the job whether it acts inside.
    pub loads_inside: Vec<bool>,
}

/// Whether an interface at rest holds a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Nothing is free to move.
    Whole,
    /// Rigid-body motions are free, so that there are no constraint modes.
    Part,
}

/// The entries of M.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassPattern {
    /// On the diagonal alone.
    Diagonal,
    /// Between dofs as well.
    Coupled,
}
