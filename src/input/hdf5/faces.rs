//! The faces of patches, gathered from the cells of a mesh in whatever format it is.
//!
//! A face belongs to a patch when all its nodes do. Cells of surfaces are faces; of volume cells those are that occur once. Two cells
//! on the sides of a face have all its nodes, so that only faces of patches have to be kept, and a mesh is read once.

mod area;
mod cell;

use std::collections::BTreeMap;
use std::path::Path;

use area::{Moments, moments};
pub(super) use cell::{Cell, Shape};

use super::super::allowance::{Allowance, Claim};
use super::super::patch::{Patch, PatchFaces, Patches};
use crate::error::Result;

/// Bytes of a face that is kept.
const FACE: u64 = 256;
/// Bytes of a node's place in its patch.
const MEMBER: u64 = 8;
/// Faces after which their memory is claimed.
const FACES_PER_CLAIM: usize = 1 << 8;
/// No patch.
const NONE: u32 = u32::MAX;
/// The node of an edge is this near to the middle of its ends, as a share of their distance: a quarter at the tip of a crack, and a
/// little for curved edges. A node farther away is that of another edge, in a file with another order.
const NEAR_MIDDLE: f64 = 0.3;

/// The faces of patches found so far.
pub(super) struct Gathered<'a> {
    patches: &'a Patches,
    /// Patch of each node of the file, and its place there.
    members: Vec<[u32; 2]>,
    /// By patch and corners, sorted.
    faces: BTreeMap<(u32, Vec<usize>), Found>,
    /// Faces of these patches have nodes that are on no edge as far as any order tells.
    is_unclear: Vec<bool>,
    claim: Claim<'a>,
}

/// A face of a patch.
struct Found {
    moments: Moments,
    kind: Kind,
}

/// Where a face was found.
enum Kind {
    /// It is a cell of a surface.
    Surface,
    /// It occurs once, at the volume cell with these corners.
    Outer(Vec<usize>),
    /// It lies between two volume cells.
    Inner,
}

impl<'a> Gathered<'a> {
    /// Nothing of the file at `path`, which has the nodes of the patches.
    ///
    /// # Errors
    /// [`crate::error::Error::MemoryRead`].
    pub(super) fn new(path: &Path, patches: &'a Patches, allowance: &'a Allowance) -> Result<Self> {
        let claim = allowance.claim(path);
        claim.add(MEMBER * patches.n_nodes as u64)?;
        let mut members = vec![[NONE; 2]; patches.n_nodes];
        for (number, patch) in (0..).zip(&patches.list) {
            for (place, node) in (0..).zip(&patch.nodes) {
                members[*node] = [number, place];
            }
        }
        Ok(Self { patches, members, faces: BTreeMap::new(), is_unclear: vec![false; patches.list.len()], claim })
    }

    /// Nodes of the file.
    pub(super) fn n_nodes(&self) -> usize {
        self.members.len()
    }

    /// Takes up a cell; its nodes are indices below [`Self::n_nodes`].
    pub(super) fn add(&mut self, cell: Cell, nodes: &[usize]) -> Result<()> {
        for face in cell.faces() {
            let patch = self.members[nodes[face[0]]][0];
            if patch == NONE || face.iter().any(|corner| self.members[nodes[*corner]][0] != patch) {
                continue;
            }
            match self.moments_of(cell, nodes, face) {
                Nodes::InPatch(moments) => self.keep((patch, cell), nodes, (face, moments))?,
                Nodes::Unclear => self.is_unclear[patch as usize] = true,
                Nodes::Elsewhere => {}
            }
        }
        Ok(())
    }

    fn keep(
        &mut self,
        (patch, cell): (u32, Cell),
        nodes: &[usize],
        (face, moments): (&[usize], Moments),
    ) -> Result<()> {
        let key = sorted(face.iter().map(|corner| nodes[*corner]).collect());
        if key.len() < 3 {
            // A corner of the cell was drawn onto another one, and with it the face onto an edge.
            return Ok(());
        }
        let owner = || sorted(nodes[..cell.n_corners()].to_vec());
        if let Some(found) = self.faces.get_mut(&(patch, key.clone())) {
            match &found.kind {
                _ if cell.is_surface() => found.kind = Kind::Surface,
                Kind::Outer(first) if *first != owner() => found.kind = Kind::Inner,
                _ => {}
            }
            return Ok(());
        }
        if self.faces.len().is_multiple_of(FACES_PER_CLAIM) {
            self.claim.add(FACE * FACES_PER_CLAIM as u64)?;
        }
        let kind = if cell.is_surface() { Kind::Surface } else { Kind::Outer(owner()) };
        self.faces.insert((patch, key), Found { moments, kind });
        Ok(())
    }

    /// Area and first moment of a face whose corners are in one patch, about the patch's first node.
    fn moments_of(&self, cell: Cell, nodes: &[usize], face: &[usize]) -> Nodes {
        let patch = self.members[nodes[face[0]]][0];
        let place = |node: usize| self.place(patch, nodes[node]);
        let Some(corners) = face.iter().map(|corner| place(*corner)).collect::<Option<Vec<_>>>() else {
            return Nodes::Elsewhere;
        };
        if cell.n_nodes() == cell.n_corners() {
            return Nodes::InPatch(moments(&corners, &[]));
        }
        let ends = |at: usize| [face[at], face[(at + 1) % face.len()]];
        let middles_in = |edges: &cell::Edges| -> Option<Vec<[f64; 3]>> {
            let middle = |at: usize| {
                let [a, b] = ends(at);
                let edge = edges.iter().position(|edge| *edge == [a, b] || *edge == [b, a])?;
                place(cell.n_corners() + edge)
            };
            (0..face.len()).map(middle).collect()
        };
        let known: Vec<Vec<[f64; 3]>> = cell.orders().iter().filter_map(middles_in).collect();
        let fit = |middles: &&Vec<[f64; 3]>| misfit(&corners, middles);
        let Some(middles) = known.iter().min_by(|a, b| fit(a).total_cmp(&fit(b))) else { return Nodes::Elsewhere };
        if misfit(&corners, middles) > NEAR_MIDDLE {
            return Nodes::Unclear;
        }
        let has_centre = face.len() == 4 || cell.is_surface();
        let mut central = (cell.first_central()..cell.n_nodes()).map(place).peekable();
        if has_centre && central.peek().is_some() {
            let middle = mean(middles);
            let size = (0..face.len()).map(|at| distance(corners[at], middle)).fold(0.0, f64::max);
            if !central.flatten().any(|node| distance(node, middle) <= NEAR_MIDDLE * size) {
                return Nodes::Elsewhere;
            }
        }
        Nodes::InPatch(moments(&corners, middles))
    }

    /// Where a node of the file is relative to the first node of a patch, if it belongs to it.
    fn place(&self, patch: u32, node: usize) -> Option<[f64; 3]> {
        let [of, place] = self.members[node];
        let positions = &self.patches.list[patch as usize].positions;
        (of == patch).then(|| minus(positions[place as usize], positions[0]))
    }

    /// The centroids of the patches that have faces.
    pub(super) fn into_centroids(self) -> Vec<PatchFaces> {
        let mut sums = vec![(0, Moments::default()); self.patches.list.len()];
        for ((patch, _), found) in &self.faces {
            let (n_faces, sum) = &mut sums[*patch as usize];
            if !matches!(found.kind, Kind::Inner) {
                *n_faces += 1;
                *sum = sum.plus(found.moments);
            }
        }
        let centroid = |((patch, is_unclear), (n_faces, sum)): ((&Patch, bool), (usize, Moments))| {
            let from = patch.positions.first()?;
            let centroid = std::array::from_fn(|axis| from[axis] + sum.first[axis] / sum.area);
            let is_known = !is_unclear && sum.area > 0.0;
            is_known.then(|| PatchFaces { interface: patch.interface.clone(), n_faces, centroid })
        };
        self.patches.list.iter().zip(self.is_unclear.iter().copied()).zip(sums).filter_map(centroid).collect()
    }
}

/// What is known of the nodes of a face whose corners are in a patch.
enum Nodes {
    InPatch(Moments),
    /// One of its nodes is not in the patch.
    Elsewhere,
    /// All may be in it, in an order that is not known.
    Unclear,
}

/// The largest distance of a node from the middle of its edge, relative to the edge.
fn misfit(corners: &[[f64; 3]], middles: &[[f64; 3]]) -> f64 {
    let of_edge = |at: usize| {
        let (a, b) = (corners[at], corners[(at + 1) % corners.len()]);
        let length = distance(a, b);
        // An edge drawn onto a corner has its node there too.
        if length > 0.0 { distance(mean(&[a, b]), middles[at]) / length } else { 0.0 }
    };
    (0..corners.len()).map(of_edge).fold(0.0, f64::max)
}

fn sorted(mut nodes: Vec<usize>) -> Vec<usize> {
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    let n = points.len() as f64;
    std::array::from_fn(|axis| points.iter().map(|point| point[axis] / n).sum())
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    minus(a, b).iter().map(|x| x * x).sum::<f64>().sqrt()
}
