//! Rigid patches whose origin is the mean of their nodes, and the centroid of the faces between these nodes.
//!
//! The mean counts every node once, however large the faces around it are: on a graded mesh the two are at different places.

/// The nodes of a rigid patch without an origin of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Name of its interface.
    pub interface: String,
    /// Indices of its nodes in the file of the nodes.
    pub nodes: Vec<usize>,
    /// Where each of them is.
    pub positions: Vec<[f64; 3]>,
}

/// The patches of a job whose faces are looked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patches {
    /// Each with two or more nodes; no node belongs to two.
    pub list: Vec<Patch>,
    /// Nodes of the file.
    pub n_nodes: usize,
}

/// The faces of a patch: cells of surfaces, and outer faces of volume cells, all of whose nodes belong to it.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchFaces {
    /// Name of its interface.
    pub interface: String,
    /// How many there are.
    pub n_faces: usize,
    /// Their area-weighted centroid.
    pub centroid: [f64; 3],
}
