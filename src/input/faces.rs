//! The faces of patches, gathered from the cells of a mesh in whatever format it is.
//!
//! A face belongs to a patch when all its nodes do. Of volume cells those are faces that occur once; cells of surfaces are where no
//! outer face of a volume cell is, see [`covering`]. Two cells on the sides of a face have all its nodes, so that only faces of patches
//! have to be kept, and a mesh is read once.

mod area;
mod cell;
mod cell_list;
mod covering;

use std::collections::BTreeMap;
use std::path::Path;

use area::{Moments, minus, moments};
pub(super) use cell::{Cell, Shape};
pub(super) use cell_list::CellList;
use covering::{Found, Skin, Volumes, counted};
use supel_runtime::motion::dot;

use super::allowance::{Allowance, Claim};
use super::patch::{Face, Faces, Patch, PatchFaces, Patches};
use crate::error::Result;

/// Bytes of a face that is kept.
const FACE: u64 = 768;
/// Bytes of a face while faces of different kinds are compared.
const COMPARED: u64 = 256;
/// Bytes of the index of a node in a cell, while cells are listed and put in another order.
const INDEX: u64 = 8;
/// Bytes of a node's place in a patch.
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
    patches: &'a Patches<'a>,
    /// Patch of each node of the file, and its place there, in layers: the patches of a layer have no node in common.
    members: Vec<Vec<[u32; 2]>>,
    /// The layer of each patch.
    layers: Vec<usize>,
    /// By patch and corners, sorted.
    faces: BTreeMap<(u32, Vec<usize>), Found>,
    /// Faces of these patches have nodes that are on no edge as far as any order tells.
    is_unclear: Vec<bool>,
    /// All cells, where they are wanted.
    list: Option<CellList>,
    claim: Claim<'a>,
}

impl<'a> Gathered<'a> {
    /// Nothing of the file at `path`, which has the nodes of the patches.
    ///
    /// # Errors
    /// [`crate::error::Error::MemoryRead`].
    pub(super) fn new(path: &Path, patches: &'a Patches<'_>, allowance: &'a Allowance) -> Result<Self> {
        let claim = allowance.claim(path);
        let (mut members, mut layers): (Vec<Vec<[u32; 2]>>, Vec<usize>) = (Vec::new(), Vec::new());
        for (number, patch) in (0..).zip(&patches.list) {
            let is_free = |layer: &Vec<[u32; 2]>| patch.nodes.iter().all(|node| layer[*node][0] == NONE);
            let layer = members.iter().position(is_free).unwrap_or(members.len());
            if layer == members.len() {
                claim.add(MEMBER * patches.coordinates.len() as u64)?;
                members.push(vec![[NONE; 2]; patches.coordinates.len()]);
            }
            for (place, node) in (0..).zip(&patch.nodes) {
                members[layer][*node] = [number, place];
            }
            layers.push(layer);
        }
        let is_unclear = vec![false; patches.list.len()];
        Ok(Self { patches, members, layers, faces: BTreeMap::new(), is_unclear, list: None, claim })
    }

    /// Keeps all cells from now on.
    #[cfg(feature = "hdf5")]
    pub(super) fn listing(self) -> Self {
        Self { list: Some(CellList::default()), ..self }
    }

    /// The cells that were kept.
    #[cfg(feature = "hdf5")]
    pub(super) fn into_list(self) -> CellList {
        self.list.unwrap_or_default()
    }

    /// Nodes of the file.
    #[cfg(feature = "hdf5")]
    pub(super) fn n_nodes(&self) -> usize {
        self.patches.coordinates.len()
    }

    /// The place of a node in a patch, if it belongs to it.
    fn place_in(&self, patch: u32, node: usize) -> Option<usize> {
        let [of, place] = self.members[self.layers[patch as usize]][node];
        (of == patch).then_some(place as usize)
    }

    /// Takes up a cell; its nodes are indices below [`Self::n_nodes`].
    pub(super) fn add(&mut self, cell: Cell, nodes: &[usize]) -> Result<()> {
        if let Some(list) = &mut self.list {
            self.claim.add(INDEX * nodes.len() as u64)?;
            list.extend(cell, nodes.iter().map(|node| *node as u32));
        }
        for (layer, corners) in
            (0..self.members.len()).flat_map(|layer| cell.faces().iter().map(move |face| (layer, face)))
        {
            let patch = self.members[layer][nodes[corners[0]]][0];
            if patch == NONE || corners.iter().any(|corner| self.members[layer][nodes[*corner]][0] != patch) {
                continue;
            }
            match self.nodes_of((patch, cell), nodes, corners) {
                Nodes::InPatch(face) => self.keep((patch, cell), nodes, face)?,
                Nodes::Unclear => self.is_unclear[patch as usize] = true,
                Nodes::Elsewhere => {}
            }
        }
        Ok(())
    }

    /// Takes up cells of one kind that is not read, each with so many nodes; they have no faces.
    #[cfg(feature = "hdf5")]
    pub(super) fn add_table(&mut self, n_each: usize, nodes: &[usize]) -> Result<()> {
        if let Some(list) = &mut self.list {
            self.claim.add(INDEX * nodes.len() as u64)?;
            list.tables.push((n_each, nodes.iter().map(|node| *node as u32).collect()));
        }
        Ok(())
    }

    fn keep(&mut self, (patch, cell): (u32, Cell), nodes: &[usize], face: Face) -> Result<()> {
        let mut corners: Vec<usize> = Vec::with_capacity(face.corners.len());
        for corner in &face.corners {
            if !corners.contains(corner) {
                corners.push(*corner);
            }
        }
        let key = sorted(corners.clone());
        if key.len() < 3 {
            // A corner of the cell was drawn onto another one, and with it the face onto an edge.
            return Ok(());
        }
        let owner = || sorted(nodes[..cell.n_corners()].to_vec());
        let places = |nodes: &[usize]| nodes.iter().map(|node| self.place(patch, *node)).collect::<Vec<_>>();
        let (outline, others) = (places(&corners), face.middles.iter().copied().chain(face.centre).collect());
        let moments = moments(&face, |node| self.place(patch, node));
        let face = self.as_seen_from_outside((patch, cell), nodes, face);
        if let Some(found) = self.faces.get_mut(&(patch, key.clone())) {
            match &found.volumes {
                _ if cell.is_surface() => found.skin = Skin::There,
                Volumes::None => {
                    let volumes = Volumes::One(owner());
                    *found = Found { face, corners, outline, others, moments, skin: Skin::There, volumes };
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
        self.faces.insert((patch, key), Found { face, corners, outline, others, moments, skin, volumes });
        Ok(())
    }

    /// A face of a volume cell with its border counterclockwise as seen from outside; the order of its nodes alone does not tell, as
    /// formats turn it either way. A cell of a surface stays as it is.
    fn as_seen_from_outside(&self, (patch, cell): (u32, Cell), nodes: &[usize], face: Face) -> Face {
        if cell.is_surface() {
            return face;
        }
        let places = |nodes: &[usize]| nodes.iter().map(|node| self.place(patch, *node)).collect::<Vec<_>>();
        let corners = places(&face.corners);
        let inwards = minus(mean(&places(&nodes[..cell.n_corners()])), mean(&corners));
        let is_inside_out = dot(&area::normal(&corners), &inwards) > 0.0;
        if is_inside_out { face.turned_over() } else { face }
    }

    /// The nodes of a face whose corners are in a patch.
    fn nodes_of(&self, (patch, cell): (u32, Cell), nodes: &[usize], face: &[usize]) -> Nodes {
        let place = |node: usize| self.place_in(patch, nodes[node]).map(|_| self.place(patch, nodes[node]));
        let corners: Vec<[f64; 3]> = face.iter().map(|corner| self.place(patch, nodes[*corner])).collect();
        let with = |middles, centre| {
            let corners = face.iter().map(|corner| nodes[*corner]).collect();
            Nodes::InPatch(Face { corners, middles, centre })
        };
        if cell.n_nodes() == cell.n_corners() {
            return with(Vec::new(), None);
        }
        let (middles, fit) = self.middles((patch, cell), nodes, face);
        let Some(middles) = middles else { return Nodes::Elsewhere };
        if fit > NEAR_MIDDLE {
            return Nodes::Unclear;
        }
        let others: Vec<usize> = middles.iter().map(|node| nodes[*node]).collect();
        let middles: Vec<[f64; 3]> = others.iter().map(|node| self.place(patch, *node)).collect();
        let has_centre = face.len() == 4 || cell.is_surface();
        if has_centre && cell.first_central() < cell.n_nodes() {
            let middle = mean(&middles);
            let size = (0..face.len()).map(|at| distance(corners[at], middle)).fold(0.0, f64::max);
            let is_centre = |node: &usize| place(*node).is_some_and(|at| distance(at, middle) <= NEAR_MIDDLE * size);
            let Some(centre) = (cell.first_central()..cell.n_nodes()).find(is_centre) else { return Nodes::Elsewhere };
            return with(others, Some(nodes[centre]));
        }
        with(others, None)
    }

    /// The nodes of the edges of a face in the order that fits best, and how well; none where one of them is not in the patch. The order is
    /// that of the cell, whichever of its nodes a patch has: where none fits, any that has all nodes in the patch may be it.
    fn middles(&self, (patch, cell): (u32, Cell), nodes: &[usize], face: &[usize]) -> (Option<Vec<usize>>, f64) {
        let corners: Vec<[f64; 3]> = face.iter().map(|corner| self.place(patch, nodes[*corner])).collect();
        let middles_in = |edges: &cell::Edges| -> Option<Vec<usize>> {
            let middle = |at: usize| {
                let [a, b] = [face[at], face[(at + 1) % face.len()]];
                let edge = edges.iter().position(|edge| *edge == [a, b] || *edge == [b, a])?;
                Some(cell.n_corners() + edge)
            };
            (0..face.len()).map(middle).collect()
        };
        let with_fit = |middles: Vec<usize>| {
            let places: Vec<[f64; 3]> = middles.iter().map(|node| self.place(patch, nodes[*node])).collect();
            let fit = misfit(&corners, &places);
            (middles, fit)
        };
        let known: Vec<(Vec<usize>, f64)> = cell.orders().iter().filter_map(middles_in).map(with_fit).collect();
        let is_in_patch = |middles: &[usize]| middles.iter().all(|node| self.place_in(patch, nodes[*node]).is_some());
        let Some((best, fit)) = known.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else { return (None, f64::INFINITY) };
        let is_known = *fit <= NEAR_MIDDLE;
        let chosen =
            if is_known { Some(best) } else { known.iter().map(|(middles, _)| middles).find(|own| is_in_patch(own)) };
        (chosen.filter(|own| is_in_patch(own)).cloned(), *fit)
    }

    /// Where a node of the file is relative to the first node of a patch.
    fn place(&self, patch: u32, node: usize) -> [f64; 3] {
        let (first, coordinates) = (self.patches.list[patch as usize].nodes[0], self.patches.coordinates);
        minus(coordinates[node], coordinates[first])
    }

    /// The centroids of the patches that have faces.
    ///
    /// # Errors
    /// [`crate::error::Error::MemoryRead`].
    pub(super) fn into_centroids(self) -> Result<Vec<PatchFaces>> {
        self.claim.add(COMPARED * self.faces.len() as u64)?;
        let mut of_patch: Vec<Vec<&Found>> = vec![Vec::new(); self.patches.list.len()];
        self.faces.iter().for_each(|((patch, _), found)| of_patch[*patch as usize].push(found));
        let known = |((number, (patch, is_unclear)), faces): ((u32, (&Patch, &bool)), &Vec<&Found>)| {
            let unknown = |reason: &str| Some(Faces::Unknown { reason: reason.to_owned() });
            let faces = match counted(faces) {
                _ if *is_unclear => unknown("nodes of edges come in an order that no format has")?,
                None => unknown("cells of one kind cover faces of another in part")?,
                Some(counted) => self.known((number, patch), &counted)?,
            };
            Some(PatchFaces { of: patch.of.clone(), faces })
        };
        Ok((0..).zip(self.patches.list.iter().zip(&self.is_unclear)).zip(&of_patch).filter_map(known).collect())
    }

    /// Centroid and areas of faces of a patch; none where they have no area.
    fn known(&self, (number, patch): (u32, &Patch), found: &[&Found]) -> Option<Faces> {
        let from = self.patches.coordinates[*patch.nodes.first()?];
        // All nodes of a face that is kept belong to its patch.
        let place = |node: usize| self.place_in(number, node).unwrap_or_default();
        let mut sum = Moments::default();
        let mut areas = vec![0.0; patch.nodes.len()];
        for found in found {
            sum = sum.plus(found.moments);
            let shares = area::shares(&found.face, |node| self.place(number, node));
            for (node, share) in found.face.nodes().zip(shares) {
                areas[place(node)] += share;
            }
        }
        let faces = found.iter().map(|found| found.face.renumbered(place)).collect();
        let centroid = std::array::from_fn(|axis| from[axis] + sum.first[axis] / sum.area);
        (sum.area > 0.0).then_some(Faces::Known { faces, centroid, areas })
    }

    /// Every patch with the reason why no face is known.
    pub(super) fn unknown(&self, reason: &str) -> Vec<PatchFaces> {
        let unknown =
            |patch: &Patch| PatchFaces { of: patch.of.clone(), faces: Faces::Unknown { reason: reason.to_owned() } };
        self.patches.list.iter().map(unknown).collect()
    }
}

/// What is known of the nodes of a face whose corners are in a patch.
enum Nodes {
    /// All are in it: the face by their indices in the file.
    InPatch(Face),
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
