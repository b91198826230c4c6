//! Patches of nodes whose faces are looked for in the cells of a mesh, and what is found there.
//!
//! The mean of the nodes counts every node once, however large the faces around it are: on a graded mesh the mean of the nodes of a patch
//! and the centroid of its faces are at different places.

use crate::error::Selector;

/// The nodes of a patch whose faces are looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Which part of the job selects them.
    pub of: Selector,
    /// Indices of its nodes in the file of the nodes.
    pub nodes: Vec<usize>,
}

/// The patches of a job whose faces are looked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patches<'a> {
    /// Each with two or more nodes; a node may belong to several.
    pub list: Vec<Patch>,
    /// Where each node of the file is.
    pub coordinates: &'a [[f64; 3]],
}

/// What a mesh tells of the faces of a patch: outer faces of volume cells, and cells of surfaces elsewhere, all of whose nodes belong to it.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchFaces {
    /// Which part of the job selects its nodes.
    pub of: Selector,
    /// The faces.
    pub faces: Faces,
}

impl PatchFaces {
    /// Whether an interface selects its nodes.
    pub fn is_of_interface(&self) -> bool {
        matches!(self.of, Selector::Interface(_))
    }
}

/// The faces of a patch.
#[derive(Clone, Debug, PartialEq)]
pub enum Faces {
    /// All are known.
    Known {
        /// Each of them, in the order of their corners.
        faces: Vec<Face>,
        /// Their area-weighted centroid.
        centroid: [f64; 3],
        /// The share of each node of the patch in their area: the integral of its shape function, or as near to it as is positive.
        areas: Vec<f64>,
    },
    /// The mesh has cells, but its faces are not known.
    Unknown {
        /// Why, in words that go on after a colon.
        reason: String,
    },
}

/// A triangle or a quadrilateral, by the places of its nodes in its patch. A cell that is drawn onto less than its shape has a node at
/// several corners or edges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Face {
    /// Three or four corners along the border: counterclockwise as seen from outside the volume cell, or as the cell of a surface has them.
    pub corners: Vec<usize>,
    /// The nodes in the middles of the edges, from that between the first two corners on; none where the cell has none.
    pub middles: Vec<usize>,
    /// The node in its middle.
    pub centre: Option<usize>,
}

impl Face {
    /// All its nodes: corners, middles and centre.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        self.corners.iter().chain(&self.middles).copied().chain(self.centre)
    }

    /// Its nodes as a picture needs them, each once; of a cell that is drawn onto less than its shape the corners alone, and nothing
    /// where these are fewer than three.
    pub fn drawn(&self) -> Option<Vec<usize>> {
        let is_whole = |nodes: &[usize]| (1..nodes.len()).all(|at| !nodes[..at].contains(&nodes[at]));
        let all: Vec<usize> = self.nodes().collect();
        if is_whole(&all) {
            return Some(all);
        }
        let mut corners = self.corners.clone();
        corners.dedup();
        if corners.first() == corners.last() {
            corners.pop();
        }
        (corners.len() >= 3 && is_whole(&corners)).then_some(corners)
    }

    /// The face as seen from its other side.
    pub(super) fn turned_over(mut self) -> Self {
        // The border from the first corner the other way round: its first edge was the last one.
        self.corners[1..].reverse();
        self.middles.reverse();
        self
    }

    /// The face with other numbers for its nodes.
    pub(super) fn renumbered(&self, number: impl Fn(usize) -> usize) -> Self {
        let all = |nodes: &[usize]| nodes.iter().map(|node| number(*node)).collect();
        Self { corners: all(&self.corners), middles: all(&self.middles), centre: self.centre.map(&number) }
    }
}
