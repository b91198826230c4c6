//! Faces of one patch that lie on each other although their corners differ: two triangles on a quadrilateral.
//!
//! Where a brick and two tetrahedra share a quadrilateral, neither of them has an outer face there. Where cells of a surface lie on outer
//! faces of volume cells, these count and the cells of the surface do not.

use std::collections::{BTreeMap, BTreeSet};

use supel_runtime::motion::{cross, dot};

use super::super::patch::Face;
use super::area::{Moments, minus};

/// A face of a patch.
pub(super) struct Found {
    /// All its nodes, by their indices in the file, as seen from outside.
    pub(super) face: Face,
    /// Its corners, each once, along its border, three or four.
    pub(super) corners: Vec<usize>,
    /// Where these are.
    pub(super) outline: Vec<[f64; 3]>,
    /// Its other nodes.
    pub(super) others: Vec<usize>,
    pub(super) moments: Moments,
    /// Whether a cell of a surface has these corners.
    pub(super) skin: Skin,
    /// Which volume cells have a face with these corners.
    pub(super) volumes: Volumes,
}

/// Whether a cell of a surface is at a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Skin {
    None,
    There,
}

/// The volume cells at a face.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Volumes {
    None,
    /// The cell with these corners, sorted.
    One(Vec<usize>),
    Two,
}

impl Found {
    /// Whether the middle of another face lies on this one.
    fn has_middle_of(&self, other: &Self) -> bool {
        /// Distance from the plane of a face, as a share of its size, within which another face lies on it rather than at an angle.
        const THICKNESS: f64 = 0.1;
        let middle = other.moments.first.map(|first| first / other.moments.area);
        let thickness = THICKNESS * self.moments.area.sqrt();
        (2..self.outline.len())
            .any(|at| is_inside([self.outline[0], self.outline[at - 1], self.outline[at]], middle, thickness))
    }

    fn n_nodes(&self) -> usize {
        self.corners.len() + self.others.len()
    }

    fn has_all(&self, nodes: &[usize]) -> bool {
        nodes.iter().all(|node| self.corners.contains(node) || self.others.contains(node))
    }

    fn is_outer(&self) -> bool {
        matches!(self.volumes, Volumes::One(_))
    }

    fn has_skin(&self) -> bool {
        self.skin == Skin::There
    }
}

/// The faces that count, none of which lies on another one; none where faces lie on parts of others, so that what is left of these is not
/// known.
pub(super) fn counted<'a>(faces: &[&'a Found]) -> Option<Vec<&'a Found>> {
    let kind = |face: &&Found| (face.corners.len(), face.others.len(), face.is_outer());
    let Some(first) = faces.first().map(kind) else { return Some(Vec::new()) };
    if faces.iter().all(|face| kind(face) == first) {
        // Faces of one kind with different corners lie next to each other.
        return Some(faces.iter().copied().filter(|face| face.is_outer() || face.has_skin()).collect());
    }
    let near = Near::of(faces);
    let mut is_outer: Vec<bool> = faces.iter().map(|face| face.is_outer()).collect();
    for (at, face) in faces.iter().enumerate().filter(|(_, face)| face.is_outer() && face.corners.len() == 4) {
        let on_it = near.outer_on(at, &face.corners);
        if on_it.is_empty() {
            continue;
        }
        if !are_halves(&face.corners, &on_it.iter().map(|half| faces[*half]).collect::<Vec<_>>()) {
            return None;
        }
        on_it.iter().chain([&at]).for_each(|inner| is_outer[*inner] = false);
    }
    let counts: Vec<bool> = is_outer.iter().zip(faces).map(|(is_outer, face)| *is_outer || face.has_skin()).collect();
    let mut left = Vec::new();
    for (at, face) in faces.iter().enumerate().filter(|(at, _)| counts[*at]) {
        let is_under = |other: &usize| {
            counts[*other]
                && faces[*other].has_all(&face.corners)
                && (is_outer[*other] || faces[*other].n_nodes() > face.n_nodes())
        };
        if is_outer[at] || !near.to(at).iter().any(is_under) && !is_on_outer(at, &near, &is_outer)? {
            left.push(at);
        }
    }
    let is_left: BTreeSet<usize> = left.iter().copied().collect();
    let overlaps = |at: &usize| {
        let others = near.at_corners(*at).into_iter().filter(|other| is_left.contains(other));
        others.filter(|other| !(is_outer[*at] && is_outer[*other])).any(|other| faces[other].has_middle_of(faces[*at]))
    };
    // A cell of a surface over several faces, or several over one, where their corners tell nothing.
    (!left.iter().any(overlaps)).then(|| left.into_iter().map(|at| faces[at]).collect())
}

/// Whether a point lies in a triangle, or so near to its plane.
fn is_inside([a, b, c]: [[f64; 3]; 3], point: [f64; 3], thickness: f64) -> bool {
    let normal = cross(&minus(b, a), &minus(c, a));
    let square = dot(&normal, &normal);
    let side = |from: [f64; 3], to: [f64; 3]| dot(&normal, &cross(&minus(to, from), &minus(point, from)));
    let is_near = dot(&normal, &minus(point, a)).abs() <= thickness * square.sqrt();
    // A middle on the diagonal of a quadrilateral is on the side of one of its triangles, within rounding.
    square > 0.0 && is_near && [side(a, b), side(b, c), side(c, a)].iter().all(|side| *side >= -1e-9 * square)
}

/// Whether a cell of a surface lies on two outer faces that are its halves; none where it lies on something else in part.
fn is_on_outer(at: usize, near: &Near<'_>, is_outer: &[bool]) -> Option<bool> {
    let face = near.faces[at];
    let nodes = [&face.corners[..], &face.others].concat();
    let below: Vec<&Found> =
        near.outer_on(at, &nodes).into_iter().filter(|other| is_outer[*other]).map(|other| near.faces[other]).collect();
    match below.is_empty() {
        true => Some(false),
        false => are_halves(&face.corners, &below).then_some(true),
    }
}

/// Whether faces are the two triangles on the sides of a diagonal of a quadrilateral.
fn are_halves(quadrilateral: &[usize], faces: &[&Found]) -> bool {
    let missing = |face: &&Found| quadrilateral.iter().position(|corner| !face.corners.contains(corner));
    let [one, other] = faces else { return false };
    let opposite = missing(one).zip(missing(other)).is_some_and(|(one, other)| one.abs_diff(other) == 2);
    opposite && faces.iter().all(|face| face.corners.len() == 3)
}

/// Faces by their nodes.
struct Near<'a> {
    faces: &'a [&'a Found],
    at_node: BTreeMap<usize, Vec<usize>>,
}

impl<'a> Near<'a> {
    fn of(faces: &'a [&'a Found]) -> Self {
        let mut at_node: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (at, face) in faces.iter().enumerate() {
            face.corners.iter().chain(&face.others).for_each(|node| at_node.entry(*node).or_default().push(at));
        }
        Self { faces, at_node }
    }

    /// Other faces with the first corner of a face.
    fn to(&self, at: usize) -> Vec<usize> {
        self.at_node[&self.faces[at].corners[0]].iter().copied().filter(|other| *other != at).collect()
    }

    /// Other faces with one of the corners of a face.
    fn at_corners(&self, at: usize) -> BTreeSet<usize> {
        let of_corner = |corner| self.at_node[corner].iter().copied();
        self.faces[at].corners.iter().flat_map(of_corner).filter(|other| *other != at).collect()
    }

    /// Outer faces of volume cells, other than the face `at`, all of whose corners are among `nodes`.
    fn outer_on(&self, at: usize, nodes: &[usize]) -> Vec<usize> {
        let is_on = |other: &usize| {
            *other != at
                && self.faces[*other].is_outer()
                && self.faces[*other].corners.iter().all(|c| nodes.contains(c))
        };
        let mut found: Vec<usize> = nodes.iter().flat_map(|node| &self.at_node[node]).copied().filter(is_on).collect();
        found.sort_unstable();
        found.dedup();
        found
    }
}
