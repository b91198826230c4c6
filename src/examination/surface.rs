//! Flat faces and cylindrical holes of a surface, grown facet by facet.
//!
//! ```text
//! n_f, a_f     normal of a facet, out of the material, and its area
//! N            Σ a_f n_f n_fᵀ over a region: of a ring about an axis its null vector is the axis
//! Σ a_f n_f    vanishes where a ring is closed
//! ```
//! A hole is a region whose facets bend towards their normals, as the wall of a bore does and no shaft. Sharp edges end it.

use std::collections::{BTreeSet, HashMap};

use faer::Mat;
use supel_runtime::motion::{cross, dot};

use crate::dense;
use crate::input::Face;
use crate::partition::{Fit, hole};

/// Cosine of 1°: facets that bend less lie in one plane, as far as their own normals tell.
const FLAT_BEND: f64 = 0.999_85;
/// Cosine of 50°: facets of one curved surface bend less, eight of them around a hole by 45°.
const SHARP_BEND: f64 = 0.642_8;
/// Sine of 12°: normals of triangles on a cylinder are off the plane across its axis by up to half the bend between eight facets, less where
/// they are as long as they are wide.
const ACROSS: f64 = 0.21;
/// Thickness of a flat face, relative to the longest extent: rounding of coordinates with five digits.
const FLAT: f64 = 1e-5;
/// Share of N that is along the axis at most, and along the second direction at least; those of a ring are 0 and ½.
const OF_RING: [f64; 2] = [0.05, 0.25];
/// ‖Σ a_f n_f‖ / Σ a_f of a closed ring at most: one facet in ten may be missing.
const OPEN: f64 = 0.1;
/// Share of the border of a flat face without a node inside that is sharp.
const SHARP: f64 = 0.9;
/// Share of the area of a hole that looks at its axis.
const INWARDS: f64 = 0.99;

/// A part of a surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) shape: Shape,
    /// Its nodes, ascending.
    pub(super) nodes: Vec<usize>,
    pub(super) area: f64,
}

/// What a part of a surface is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    /// A closed ring about an axis, with the middle of that and the cylinder that its corners are on.
    Hole { at: [f64; 3], fit: Fit },
    /// A plane with a point of it and its normal, out of the material.
    Flat { at: [f64; 3], normal: [f64; 3] },
}

/// The holes and the flat faces of a surface, each the largest first.
pub(super) fn pieces(faces: &[Face], positions: &[[f64; 3]]) -> Vec<Piece> {
    let surface = Surface::of(faces, positions);
    let mut is_of_hole = vec![false; faces.len()];
    let mut holes = Vec::new();
    for region in surface.curved() {
        if let Some(shape) = surface.hole(&region) {
            region.iter().for_each(|facet| is_of_hole[*facet] = true);
            holes.push(surface.piece(shape, &region));
        }
    }
    let mut flat = surface.flat(&is_of_hole);
    for pieces in [&mut holes, &mut flat] {
        pieces.sort_by(|a, b| b.area.total_cmp(&a.area));
    }
    holes.into_iter().chain(flat).collect()
}

/// The facets next to a facet, and how they bend.
#[derive(Clone, Copy)]
struct Neighbour {
    facet: usize,
    /// n_f · n_g.
    cosine: f64,
    bend: Bend,
}

#[derive(Clone, Copy, PartialEq)]
enum Bend {
    /// Towards the normals.
    Hollow,
    /// Away from them.
    Round,
}

struct Surface<'a> {
    faces: &'a [Face],
    positions: &'a [[f64; 3]],
    normals: Vec<[f64; 3]>,
    areas: Vec<f64>,
    middles: Vec<[f64; 3]>,
    neighbours: Vec<Vec<Neighbour>>,
    /// The longest extent along the axes.
    extent: f64,
}

impl<'a> Surface<'a> {
    fn of(faces: &'a [Face], positions: &'a [[f64; 3]]) -> Self {
        let corners = |face: &Face| face.corners.iter().map(|corner| positions[*corner]).collect::<Vec<_>>();
        let vectors: Vec<[f64; 3]> = faces.iter().map(|face| area_vector(&corners(face))).collect();
        let areas: Vec<f64> = vectors.iter().map(|vector| dense::norm(vector)).collect();
        let unit = |(vector, area): (&[f64; 3], &f64)| vector.map(|part| if *area > 0.0 { part / area } else { 0.0 });
        let normals: Vec<[f64; 3]> = vectors.iter().zip(&areas).map(unit).collect();
        let middles: Vec<[f64; 3]> = faces.iter().map(|face| mean(&corners(face))).collect();
        let used: Vec<[f64; 3]> = faces.iter().flat_map(Face::nodes).map(|node| positions[node]).collect();
        let end = |axis: usize, pick: fn(f64, f64) -> f64| used.iter().map(|x| x[axis]).reduce(pick).unwrap_or(0.0);
        let extent = (0..3).map(|axis| end(axis, f64::max) - end(axis, f64::min)).fold(0.0, f64::max);
        let mut surface = Self { faces, positions, normals, areas, middles, neighbours: Vec::new(), extent };
        surface.neighbours = surface.joined();
        surface
    }

    /// Facets that share an edge with no third one.
    fn joined(&self) -> Vec<Vec<Neighbour>> {
        let mut at_edge: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
        for (facet, face) in self.faces.iter().enumerate() {
            for (at, corner) in face.corners.iter().enumerate() {
                let next = face.corners[(at + 1) % face.corners.len()];
                if next != *corner {
                    at_edge.entry([next.min(*corner), next.max(*corner)]).or_default().push(facet);
                }
            }
        }
        let mut neighbours = vec![Vec::new(); self.faces.len()];
        for facets in at_edge.values() {
            if let [a, b] = facets[..] {
                neighbours[a].push(self.neighbour(a, b));
                neighbours[b].push(self.neighbour(b, a));
            }
        }
        neighbours.iter_mut().for_each(|of_facet: &mut Vec<Neighbour>| of_facet.sort_by_key(|next| next.facet));
        neighbours
    }

    fn neighbour(&self, facet: usize, other: usize) -> Neighbour {
        let towards = dot(&minus(self.middles[other], self.middles[facet]), &self.normals[facet]);
        let bend = if towards > 0.0 { Bend::Hollow } else { Bend::Round };
        Neighbour { facet: other, cosine: dot(&self.normals[facet], &self.normals[other]), bend }
    }

    /// Regions of facets that are `within`, each joined through facets that pass; `passes` is given a facet and the one next to it.
    fn regions(&self, within: &[bool], passes: impl Fn(&Neighbour) -> bool) -> Vec<Vec<usize>> {
        let mut is_left = within.to_vec();
        let mut regions = Vec::new();
        for seed in 0..self.faces.len() {
            if !std::mem::take(&mut is_left[seed]) {
                continue;
            }
            let mut region = vec![seed];
            let mut next = 0;
            while next < region.len() {
                for neighbour in self.neighbours[region[next]].iter().filter(|neighbour| passes(neighbour)) {
                    if std::mem::take(&mut is_left[neighbour.facet]) {
                        region.push(neighbour.facet);
                    }
                }
                next += 1;
            }
            regions.push(region);
        }
        regions
    }

    /// Regions whose facets bend little and towards their normals, and look across an axis.
    fn curved(&self) -> Vec<Vec<usize>> {
        let is_smooth =
            |next: &Neighbour| next.cosine >= FLAT_BEND || next.bend == Bend::Hollow && next.cosine >= SHARP_BEND;
        let mut curved = Vec::new();
        for region in self.regions(&vec![true; self.faces.len()], is_smooth) {
            // A fillet or the bottom of a hole may be joined to its wall, and does not look across the axis.
            let Some(axis) = self.axis(&region) else { continue };
            let mut within = vec![false; self.faces.len()];
            region
                .iter()
                .filter(|facet| dot(&self.normals[**facet], &axis).abs() <= ACROSS)
                .for_each(|facet| within[*facet] = true);
            curved.extend(self.regions(&within, is_smooth));
        }
        curved
    }

    /// The direction that normals of a region have least of.
    fn axis(&self, region: &[usize]) -> Option<[f64; 3]> {
        self.directions(region).map(|(_, axis)| axis)
    }

    /// Shares of N along its directions, the largest first, and the last of these.
    fn directions(&self, region: &[usize]) -> Option<([f64; 3], [f64; 3])> {
        let mut n = Mat::<f64>::zeros(3, 3);
        for facet in region {
            let (normal, area) = (self.normals[*facet], self.areas[*facet]);
            (0..9).for_each(|at| n[(at / 3, at % 3)] += area * normal[at / 3] * normal[at % 3]);
        }
        let (singular, v) = dense::right_singular(n.as_ref()).ok()?;
        let sum: f64 = singular.iter().sum();
        (sum > 0.0).then(|| ([0, 1, 2].map(|at| singular[at] / sum), [0, 1, 2].map(|row| v[(row, 2)])))
    }

    /// The hole that a region is.
    fn hole(&self, region: &[usize]) -> Option<Shape> {
        let (shares, _) = self.directions(region)?;
        let area: f64 = region.iter().map(|facet| self.areas[*facet]).sum();
        let sum = |axis: usize| region.iter().map(|facet| self.areas[*facet] * self.normals[*facet][axis]).sum();
        let is_ring = shares[2] <= OF_RING[0] && shares[1] >= OF_RING[1];
        if !is_ring || dense::norm(&[0, 1, 2].map(sum)) > OPEN * area {
            return None;
        }
        // Nodes in the middles of straight edges are off the surface that the corners are on.
        let corners: BTreeSet<usize> = region.iter().flat_map(|facet| &self.faces[*facet].corners).copied().collect();
        let points: Vec<[f64; 3]> = corners.into_iter().map(|node| self.positions[node]).collect();
        let (at, fit) = hole(&points).ok()?;
        let axis = fit.axis?;
        let looks_inwards = |facet: &&usize| {
            let from = minus(at, self.middles[**facet]);
            let along = dot(&from, &axis);
            let across: [f64; 3] = std::array::from_fn(|i| from[i] - along * axis[i]);
            dot(&across, &self.normals[**facet]) > 0.0
        };
        let inwards: f64 = region.iter().filter(looks_inwards).map(|facet| self.areas[*facet]).sum();
        (inwards >= INWARDS * area).then_some(Shape::Hole { at, fit })
    }

    /// Flat faces of what is left, from the largest facets on.
    fn flat(&self, is_taken: &[bool]) -> Vec<Piece> {
        let mut is_left: Vec<bool> = is_taken.iter().map(|is_taken| !is_taken).collect();
        let mut seeds: Vec<usize> = (0..self.faces.len()).collect();
        seeds.sort_by(|a, b| self.areas[*b].total_cmp(&self.areas[*a]));
        let at_node = self.facets_at_nodes();
        let mut flat = Vec::new();
        for seed in seeds {
            if self.areas[seed] == 0.0 || !is_left[seed] {
                continue;
            }
            let region = self.plane(seed, &mut is_left);
            if self.is_face(&region, &at_node) {
                let shape = Shape::Flat { at: self.middles[seed], normal: self.normals[seed] };
                flat.push(self.piece(shape, &region));
            }
        }
        flat
    }

    /// Facets in the plane of one, joined to it.
    fn plane(&self, seed: usize, is_left: &mut [bool]) -> Vec<usize> {
        let (normal, at) = (self.normals[seed], self.middles[seed]);
        let is_in_plane = |facet: usize| {
            let off = |node: usize| dot(&minus(self.positions[node], at), &normal).abs();
            dot(&self.normals[facet], &normal) >= FLAT_BEND
                && self.faces[facet].nodes().all(|node| off(node) <= FLAT * self.extent)
        };
        is_left[seed] = false;
        let mut region = vec![seed];
        let mut next = 0;
        while next < region.len() {
            for neighbour in &self.neighbours[region[next]] {
                if is_left[neighbour.facet] && is_in_plane(neighbour.facet) {
                    is_left[neighbour.facet] = false;
                    region.push(neighbour.facet);
                }
            }
            next += 1;
        }
        region
    }

    /// Whether a flat region is a face, and no strip of a curved surface: its border is sharp, or it has a node inside.
    fn is_face(&self, region: &[usize], at_node: &HashMap<usize, usize>) -> bool {
        let own: BTreeSet<usize> = region.iter().copied().collect();
        let mut here: HashMap<usize, usize> = HashMap::new();
        region.iter().flat_map(|facet| self.faces[*facet].nodes()).for_each(|node| *here.entry(node).or_default() += 1);
        if here.iter().any(|(node, count)| at_node[node] == *count && *count > 2) {
            return true;
        }
        let [mut sharp, mut all] = [0.0, 0.0];
        for facet in region {
            for next in self.neighbours[*facet].iter().filter(|next| !own.contains(&next.facet)) {
                let length = self.common_edge(*facet, next.facet);
                all += length;
                sharp += if next.cosine < SHARP_BEND { length } else { 0.0 };
            }
        }
        sharp >= SHARP * all
    }

    /// How many facets each node has.
    fn facets_at_nodes(&self) -> HashMap<usize, usize> {
        let mut at_node = HashMap::new();
        self.faces.iter().flat_map(Face::nodes).for_each(|node| *at_node.entry(node).or_default() += 1);
        at_node
    }

    /// The length of the edge that two facets have in common.
    fn common_edge(&self, facet: usize, other: usize) -> f64 {
        let others = &self.faces[other].corners;
        let common: Vec<usize> =
            self.faces[facet].corners.iter().copied().filter(|corner| others.contains(corner)).collect();
        match common[..] {
            [a, b, ..] => dense::norm(&minus(self.positions[a], self.positions[b])),
            _ => 0.0,
        }
    }

    fn nodes(&self, region: &[usize]) -> BTreeSet<usize> {
        region.iter().flat_map(|facet| self.faces[*facet].nodes()).collect()
    }

    fn piece(&self, shape: Shape, region: &[usize]) -> Piece {
        let area = region.iter().map(|facet| self.areas[*facet]).sum();
        Piece { shape, nodes: self.nodes(region).into_iter().collect(), area }
    }
}

/// The area vector of a polygon by its corners.
fn area_vector(corners: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for at in 2..corners.len() {
        let part = cross(&minus(corners[at - 1], corners[0]), &minus(corners[at], corners[0]));
        (0..3).for_each(|axis| sum[axis] += 0.5 * part[axis]);
    }
    sum
}

fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|axis| points.iter().map(|point| point[axis] / points.len() as f64).sum())
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Facets of a surface that is put together from parts.
    #[derive(Default)]
    struct Mesh {
        positions: Vec<[f64; 3]>,
        faces: Vec<Face>,
    }

    impl Mesh {
        fn node(&mut self, position: [f64; 3]) -> usize {
            let is_there = |other: &[f64; 3]| dense::norm(&minus(*other, position)) < 1e-9;
            self.positions.iter().position(is_there).unwrap_or_else(|| {
                self.positions.push(position);
                self.positions.len() - 1
            })
        }

        fn quad(&mut self, corners: [[f64; 3]; 4]) {
            let corners = corners.map(|corner| self.node(corner)).to_vec();
            self.faces.push(Face { corners, middles: Vec::new(), centre: None });
        }

        /// Two triangles.
        fn halves(&mut self, [a, b, c, d]: [[f64; 3]; 4]) {
            for corners in [[a, b, c], [a, c, d]] {
                let corners = corners.map(|corner| self.node(corner)).to_vec();
                self.faces.push(Face { corners, middles: Vec::new(), centre: None });
            }
        }

        fn pieces(&self) -> Vec<Piece> {
            pieces(&self.faces, &self.positions)
        }
    }

    const AROUND: usize = 16;
    const HEIGHT: f64 = 0.4;

    fn on_circle([x, y]: [f64; 2], radius: f64, k: usize, z: f64) -> [f64; 3] {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / AROUND as f64).sin_cos();
        [x + radius * cos, y + radius * sin, z]
    }

    /// The point of a square of side 2 about a centre, in the direction of a node of the circle.
    fn on_square([x, y]: [f64; 2], k: usize, z: f64) -> [f64; 3] {
        let [dx, dy, _] = on_circle([0.0; 2], 1.0, k, 0.0);
        let size = dx.abs().max(dy.abs());
        [x + dx / size, y + dy / size, z]
    }

    /// A square cell with a hole through it: both its faces, and the wall of the hole, looking at the axis.
    fn add_cell(mesh: &mut Mesh, centre: [f64; 2], radius: f64) {
        for k in 0..AROUND {
            let ring = [k, k + 1].map(|k| [0.0, HEIGHT].map(|z| on_circle(centre, radius, k, z)));
            let square = [k, k + 1].map(|k| [0.0, HEIGHT].map(|z| on_square(centre, k, z)));
            mesh.quad([ring[0][1], square[0][1], square[1][1], ring[1][1]]);
            mesh.quad([ring[0][0], ring[1][0], square[1][0], square[0][0]]);
            mesh.quad([ring[0][0], ring[0][1], ring[1][1], ring[1][0]]);
        }
    }

    /// Sides of the block of both cells, from their corners.
    fn add_sides(mesh: &mut Mesh) {
        let mut border: Vec<[f64; 2]> = Vec::new();
        for k in 0..=AROUND {
            for centre in [[0.0, 0.0], [2.0, 0.0]] {
                let [x, y, _] = on_square(centre, k, 0.0);
                let is_inner = (x - 1.0).abs() < 1e-9 && y.abs() < 1.0 - 1e-9;
                if !is_inner && !border.iter().any(|other| (other[0] - x).hypot(other[1] - y) < 1e-9) {
                    border.push([x, y]);
                }
            }
        }
        // Counterclockwise about the middle of the block.
        border.sort_by(|a, b| a[1].atan2(a[0] - 1.0).total_cmp(&b[1].atan2(b[0] - 1.0)));
        for k in 0..border.len() {
            let [[ax, ay], [bx, by]] = [border[k], border[(k + 1) % border.len()]];
            mesh.quad([[ax, ay, 0.0], [bx, by, 0.0], [bx, by, HEIGHT], [ax, ay, HEIGHT]]);
        }
    }

    fn is_hole(piece: &&Piece) -> bool {
        matches!(piece.shape, Shape::Hole { .. })
    }

    #[test]
    fn a_block_has_its_two_holes_and_six_faces() {
        let mut mesh = Mesh::default();
        add_cell(&mut mesh, [0.0, 0.0], 0.5);
        add_cell(&mut mesh, [2.0, 0.0], 0.3);
        add_sides(&mut mesh);
        let found = mesh.pieces();
        let holes: Vec<&Piece> = found.iter().filter(is_hole).collect();
        assert_eq!((holes.len(), found.len()), (2, 8), "{found:?}");
        for (hole, (x, radius)) in holes.iter().zip([(0.0, 0.5), (2.0, 0.3)]) {
            let Shape::Hole { at, fit } = hole.shape else { panic!("{hole:?}") };
            assert!(dense::norm(&minus(at, [x, 0.0, 0.5 * HEIGHT])) < 1e-9, "{at:?}");
            assert!((fit.radius - radius).abs() < 1e-9 && hole.nodes.len() == 2 * AROUND, "{hole:?}");
            assert!(fit.axis.is_some_and(|axis| (axis[2].abs() - 1.0).abs() < 1e-9), "{fit:?}");
        }
        // The largest faces are the two that the holes go through.
        let Shape::Flat { normal, .. } = found[2].shape else { panic!("{found:?}") };
        assert!((normal[2].abs() - 1.0).abs() < 1e-12 && (found[2].area - found[3].area).abs() < 1e-9, "{found:?}");
    }

    /// A shaft has no hole and two ends; a tube has one hole. Triangles and facets that are two high make no difference.
    #[test]
    fn a_cylinder_has_ends_and_no_hole() {
        for inner in [0.0, 0.5] {
            let mut mesh = Mesh::default();
            for k in 0..AROUND {
                let at = |radius: f64, k: usize, z: f64| on_circle([3.0, 1.0], radius, k, z);
                for [low, high] in [[0.0, 0.2], [0.2, HEIGHT]] {
                    mesh.halves([at(1.0, k, low), at(1.0, k + 1, low), at(1.0, k + 1, high), at(1.0, k, high)]);
                    if inner > 0.0 {
                        mesh.halves([
                            at(inner, k, low),
                            at(inner, k, high),
                            at(inner, k + 1, high),
                            at(inner, k + 1, low),
                        ]);
                    }
                }
                let caps = [inner, 1.0].map(|radius| [k, k + 1].map(|k| [0.0, HEIGHT].map(|z| at(radius, k, z))));
                let [[[a, b], [c, d]], [[e, f], [g, h]]] = caps;
                mesh.quad([b, f, h, d]);
                mesh.quad([a, c, g, e]);
            }
            let found = mesh.pieces();
            let n_holes = found.iter().filter(is_hole).count();
            assert_eq!(n_holes, usize::from(inner > 0.0), "{inner}: {found:?}");
            let ends: Vec<&Piece> = found.iter().filter(|piece| !is_hole(piece)).collect();
            assert_eq!(ends.len(), 2, "{inner}: {ends:?}");
        }
    }

    /// Of eight facets with straight edges the nodes in the middles are off the cylinder that the corners are on.
    #[test]
    fn nodes_between_corners_do_not_move_a_hole() {
        const FACETS: usize = 8;
        let mut mesh = Mesh::default();
        for k in 0..FACETS {
            let at = |k: usize, z: f64| on_circle([3.0, 1.0], 0.5, k * AROUND / FACETS, z);
            let corners = [at(k, 0.0), at(k, HEIGHT), at(k + 1, HEIGHT), at(k + 1, 0.0)];
            let middles = (0..4).map(|edge| mesh.node(mean(&[corners[edge], corners[(edge + 1) % 4]]))).collect();
            let corners = corners.map(|corner| mesh.node(corner)).to_vec();
            mesh.faces.push(Face { corners, middles, centre: None });
        }
        let found = mesh.pieces();
        let [Piece { shape: Shape::Hole { at, fit }, nodes, .. }] = &found[..] else { panic!("{found:?}") };
        assert!(
            dense::norm(&minus(*at, [3.0, 1.0, 0.5 * HEIGHT])) < 1e-9 && (fit.radius - 0.5).abs() < 1e-9,
            "{fit:?}"
        );
        assert_eq!(nodes.len(), 5 * FACETS);
    }

    /// A thin plate has two large faces, the largest first, and no hole, however its facets are turned about it.
    #[test]
    fn a_plate_has_flat_faces_alone() {
        let mut mesh = Mesh::default();
        let size = [3.0, 2.0, 0.01];
        for axis in 0..3 {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            for side in [0.0, 1.0] {
                let corner = |a: f64, b: f64| {
                    let mut x = [0.0; 3];
                    (x[axis], x[u], x[v]) = (side * size[axis], a * size[u], b * size[v]);
                    x
                };
                let corners = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
                let [a, b, c, d] = corners;
                mesh.halves(if side > 0.0 { corners } else { [a, d, c, b] });
            }
        }
        let found = mesh.pieces();
        assert!(found.len() == 6 && !found.iter().any(|piece| is_hole(&piece)), "{found:?}");
        let normals: Vec<f64> = found[..2]
            .iter()
            .map(|piece| match piece.shape {
                Shape::Flat { normal, .. } => normal[2],
                Shape::Hole { .. } => 0.0,
            })
            .collect();
        assert!(normals.contains(&1.0) && normals.contains(&-1.0) && (found[0].area - 6.0).abs() < 1e-12, "{found:?}");
    }
}
