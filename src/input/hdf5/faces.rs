//! The faces of patches, gathered from the cells of a mesh in whatever format it is.
//!
//! A face belongs to a patch when all its nodes do. Of volume cells those are faces that occur once; cells of surfaces are where no
//! outer face of a volume cell is, see [`covering`]. Two cells on the sides of a face have all its nodes, so that only faces of patches
//! have to be kept, and a mesh is read once.

mod area;
mod cell;
mod covering;

use std::collections::BTreeMap;
use std::path::Path;

use area::{Moments, minus, moments};
pub(super) use cell::{Cell, Shape};
use covering::{Found, Skin, Volumes, counted};

use super::super::allowance::{Allowance, Claim};
use super::super::patch::{Faces, Patch, PatchFaces, Patches};
use crate::error::Result;

/// Bytes of a face that is kept.
const FACE: u64 = 512;
/// Bytes of a face while faces of different kinds are compared.
const COMPARED: u64 = 256;
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
                Nodes::InPatch(moments, others) => self.keep((patch, cell), nodes, (face, moments, others))?,
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
        (face, moments, others): (&[usize], Moments, Vec<usize>),
    ) -> Result<()> {
        let mut corners: Vec<usize> = Vec::with_capacity(face.len());
        for corner in face.iter().map(|corner| nodes[*corner]) {
            if !corners.contains(&corner) {
                corners.push(corner);
            }
        }
        let key = sorted(corners.clone());
        if key.len() < 3 {
            // A corner of the cell was drawn onto another one, and with it the face onto an edge.
            return Ok(());
        }
        let owner = || sorted(nodes[..cell.n_corners()].to_vec());
        let outline: Vec<[f64; 3]> = corners.iter().filter_map(|corner| self.place(patch, *corner)).collect();
        if let Some(found) = self.faces.get_mut(&(patch, key.clone())) {
            match &found.volumes {
                _ if cell.is_surface() => found.skin = Skin::There,
                Volumes::None => {
                    let volumes = Volumes::One(owner());
                    *found = Found { corners, outline, others, moments, skin: Skin::There, volumes };
                }
                Volumes::One(first) if *first != owner() => found.volumes = Volumes::Two,
                _ => {}
            }
            return Ok(());
        }
        if self.faces.len().is_multiple_of(FACES_PER_CLAIM) {
            self.claim.add(FACE * FACES_PER_CLAIM as u64)?;
        }
        let (skin, volumes) = match cell.is_surface() {
            true => (Skin::There, Volumes::None),
            false => (Skin::None, Volumes::One(owner())),
        };
        self.faces.insert((patch, key), Found { corners, outline, others, moments, skin, volumes });
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
            return Nodes::InPatch(moments(&corners, &[]), Vec::new());
        }
        let ends = |at: usize| [face[at], face[(at + 1) % face.len()]];
        let middles_in = |edges: &cell::Edges| -> Option<(Vec<usize>, Vec<[f64; 3]>)> {
            let middle = |at: usize| {
                let [a, b] = ends(at);
                let edge = edges.iter().position(|edge| *edge == [a, b] || *edge == [b, a])?;
                let node = cell.n_corners() + edge;
                Some((nodes[node], place(node)?))
            };
            (0..face.len()).map(middle).collect()
        };
        let known: Vec<(Vec<usize>, Vec<[f64; 3]>)> = cell.orders().iter().filter_map(middles_in).collect();
        let fit = |(_, middles): &&(Vec<usize>, Vec<[f64; 3]>)| misfit(&corners, middles);
        let best = known.iter().min_by(|a, b| fit(a).total_cmp(&fit(b)));
        let Some((others, middles)) = best else { return Nodes::Elsewhere };
        if misfit(&corners, middles) > NEAR_MIDDLE {
            return Nodes::Unclear;
        }
        let mut others = others.clone();
        let has_centre = face.len() == 4 || cell.is_surface();
        if has_centre && cell.first_central() < cell.n_nodes() {
            let middle = mean(middles);
            let size = (0..face.len()).map(|at| distance(corners[at], middle)).fold(0.0, f64::max);
            let is_centre = |node: &usize| place(*node).is_some_and(|at| distance(at, middle) <= NEAR_MIDDLE * size);
            let Some(centre) = (cell.first_central()..cell.n_nodes()).find(is_centre) else { return Nodes::Elsewhere };
            others.push(nodes[centre]);
        }
        Nodes::InPatch(moments(&corners, middles), others)
    }

    /// Where a node of the file is relative to the first node of a patch, if it belongs to it.
    fn place(&self, patch: u32, node: usize) -> Option<[f64; 3]> {
        let [of, place] = self.members[node];
        let positions = &self.patches.list[patch as usize].positions;
        (of == patch).then(|| minus(positions[place as usize], positions[0]))
    }

    /// The centroids of the patches that have faces.
    ///
    /// # Errors
    /// [`crate::error::Error::MemoryRead`].
    pub(super) fn into_centroids(self) -> Result<Vec<PatchFaces>> {
        self.claim.add(COMPARED * self.faces.len() as u64)?;
        let mut of_patch: Vec<Vec<&Found>> = vec![Vec::new(); self.patches.list.len()];
        self.faces.iter().for_each(|((patch, _), found)| of_patch[*patch as usize].push(found));
        let known = |((patch, is_unclear), faces): ((&Patch, &bool), &Vec<&Found>)| {
            let unknown = |reason: &str| Some(Faces::Unknown { reason: reason.to_owned() });
            let faces = match counted(faces) {
                _ if *is_unclear => unknown("nodes of edges come in an order that no format has")?,
                None => unknown("cells of one kind cover faces of another in part")?,
                Some(counted) => self.known(patch, &counted)?,
            };
            Some(PatchFaces { interface: patch.interface.clone(), faces })
        };
        Ok(self.patches.list.iter().zip(&self.is_unclear).zip(&of_patch).filter_map(known).collect())
    }

    /// Centroid and areas of faces of a patch; none where they have no area.
    fn known(&self, patch: &Patch, faces: &[&Found]) -> Option<Faces> {
        let from = patch.positions.first()?;
        let mut sum = Moments::default();
        let mut areas = vec![0.0; patch.nodes.len()];
        for found in faces {
            sum = sum.plus(found.moments);
            let shares = area::shares(found.corners.len(), found.others.len());
            for (node, share) in found.corners.iter().chain(&found.others).zip(shares) {
                areas[self.members[*node][1] as usize] += share * found.moments.area;
            }
        }
        let centroid = std::array::from_fn(|axis| from[axis] + sum.first[axis] / sum.area);
        (sum.area > 0.0).then_some(Faces::Known { count: faces.len(), centroid, areas })
    }

    /// Every patch with the reason why no face is known.
    pub(super) fn unknown(&self, reason: &str) -> Vec<PatchFaces> {
        let unknown = |patch: &Patch| PatchFaces {
            interface: patch.interface.clone(),
            faces: Faces::Unknown { reason: reason.to_owned() },
        };
        self.patches.list.iter().map(unknown).collect()
    }
}

/// What is known of the nodes of a face whose corners are in a patch.
enum Nodes {
    /// All are in it: area and first moment, and the nodes that are no corners.
    InPatch(Moments, Vec<usize>),
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

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    minus(a, b).iter().map(|x| x * x).sum::<f64>().sqrt()
}
