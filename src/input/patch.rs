//! Patches whose origin is the mean of their nodes or of their faces, and the centroid of these faces.
//!
//! The mean of the nodes counts every node once, however large the faces around it are: on a graded mesh the two are at different places.

/// The nodes of a patch whose faces are looked for.
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
    /// Each with two or more nodes; a node that belongs to two is refused later, and counts for the last of them.
    pub list: Vec<Patch>,
    /// Nodes of the file.
    pub n_nodes: usize,
}

/// What a mesh tells of the faces of a patch: outer faces of volume cells, and cells of surfaces elsewhere, all of whose nodes belong to it.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchFaces {
    /// Name of its interface.
    pub interface: String,
    /// The faces.
    pub faces: Faces,
}

/// The faces of a patch.
#[derive(Clone, Debug, PartialEq)]
pub enum Faces {
    /// All are known.
    Known {
        /// How many there are.
        count: usize,
        /// Their area-weighted centroid.
        centroid: [f64; 3],
        /// The share of each node of the patch in their area: that of a diagonal mass matrix with the diagonal of the consistent one.
        areas: Vec<f64>,
    },
    /// The mesh has cells, but its faces are not known.
    Unknown {
        /// Why, in words that go on after a colon.
        reason: String,
    },
}
