//! Interfaces of a mesh without groups that can be: holes and flat faces of its outer surface, besides the ends of the component.

use std::collections::{HashMap, HashSet};

use supel_runtime::motion::dot;

use super::ends::EndFace;
use super::interfaces::rank;
use super::surface::{Piece, Shape, pieces};
use crate::dense;
use crate::dofs::Nodes;
use crate::input::Face;
use crate::job::{NodeSelection, Origin, Region};
use crate::number::quantity;
use crate::partition::{Fit, Partition, contains, hole};

/// Holes that are proposed at most.
const MOST_HOLES: usize = 6;
/// Interfaces that are proposed at most, ends counted.
const MOST: usize = 8;
/// Share of its radius by which a region goes beyond the nodes of a hole.
const MARGIN: f64 = 1e-3;

/// A hole or a flat face that may be an interface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacePatch {
    /// What it is, and a number.
    pub name: String,
    /// A region that has its nodes and no others, or their labels.
    pub nodes: NodeSelection,
    /// How many these are.
    pub n_nodes: usize,
    /// What it is, in words.
    pub what: String,
    /// The place of its interface node; that of a hole is on its axis.
    pub origin: Origin,
}

/// The largest holes and, where they share no node with these or with an end, the largest flat faces; and the ends that share none with a
/// hole. Nodes with rows that nothing holds make them.
pub(super) fn patches(
    (partition, nodes): (&Partition, &Nodes),
    faces: &[Face],
    held: &[[f64; 3]],
    ends: Vec<EndFace>,
) -> (Vec<SurfacePatch>, Vec<EndFace>) {
    let chooser = Chooser::new((partition, nodes), held);
    let mut taken: HashSet<usize> = HashSet::new();
    let (holes, mut flat): (Vec<Piece>, Vec<Piece>) =
        pieces(faces, &nodes.coordinates).into_iter().partition(|piece| matches!(piece.shape, Shape::Hole { .. }));
    let mut chosen = chooser.chosen(holes, MOST_HOLES, &mut taken);
    // Faces across the longest extent are where a component ends; others are its sides.
    let (axis, ends_at) = longest(&nodes.coordinates);
    flat.sort_by_key(|piece| !ends_at.iter().any(|at| is_across(&piece.shape, (axis, *at), ends_at[1] - ends_at[0])));
    let is_free = |end: &EndFace, taken: &HashSet<usize>| {
        let is_end = matches!(&end.region, Region::Plane { normal, .. } if normal[axis] != 0.0);
        (is_end || flat.is_empty()) && taken.iter().all(|node| !contains(&end.region, nodes.coordinates[*node]))
    };
    let ends: Vec<EndFace> = ends.into_iter().filter(|end| is_free(end, &taken)).collect();
    for end in &ends {
        taken.extend((0..nodes.labels.len()).filter(|node| contains(&end.region, nodes.coordinates[*node])));
    }
    let n_left = MOST.saturating_sub(chosen.len() + ends.len());
    chosen.extend(chooser.chosen(flat, n_left, &mut taken));
    let mut counts = [0, 0];
    let patch = |piece: &Piece| {
        let is_flat = matches!(piece.shape, Shape::Flat { .. });
        counts[usize::from(is_flat)] += 1;
        chooser.patch(piece, counts[usize::from(is_flat)])
    };
    (chosen.iter().map(patch).collect(), ends)
}

struct Chooser<'a> {
    partition: &'a Partition,
    nodes: &'a Nodes,
    /// The dofs of each label.
    of_label: HashMap<i64, Vec<usize>>,
    held: HashSet<[u64; 3]>,
}

impl<'a> Chooser<'a> {
    fn new((partition, nodes): (&'a Partition, &'a Nodes), held: &[[f64; 3]]) -> Self {
        let mut of_label: HashMap<i64, Vec<usize>> = HashMap::new();
        for (at, dof) in partition.dofs.iter().enumerate() {
            dof.dof.iter().for_each(|dof| of_label.entry(dof.node).or_default().push(at));
        }
        Self { partition, nodes, of_label, held: held.iter().map(|position| position.map(f64::to_bits)).collect() }
    }

    /// The first pieces that can be interfaces and share no node with each other or with what is taken.
    fn chosen(&self, pieces: Vec<Piece>, most: usize, taken: &mut HashSet<usize>) -> Vec<Piece> {
        let mut chosen = Vec::new();
        for piece in pieces {
            if chosen.len() < most && !piece.nodes.iter().any(|node| taken.contains(node)) && self.carries(&piece) {
                taken.extend(&piece.nodes);
                chosen.push(piece);
            }
        }
        chosen
    }

    /// Whether a piece reacts all six motions, is not most of the model, and no node of it is held or without rows.
    fn carries(&self, piece: &Piece) -> bool {
        let is_held = |node: &usize| self.held.contains(&self.nodes.coordinates[*node].map(f64::to_bits));
        let rows = |node: &usize| self.of_label.get(&self.nodes.labels[*node]);
        if piece.nodes.iter().any(|node| is_held(node) || rows(node).is_none()) {
            return false;
        }
        let dofs: Vec<usize> = piece.nodes.iter().filter_map(rows).flatten().copied().collect();
        2 * piece.nodes.len() <= self.of_label.len() && rank(self.partition, &dofs) == 6
    }

    fn patch(&self, piece: &Piece, number: usize) -> SurfacePatch {
        let point = |at: [f64; 3]| at.map(|x| quantity(short(x), 4)).join(", ");
        let (name, what, region, origin) = match piece.shape {
            Shape::Hole { at, fit } => (
                format!("hole-{number}"),
                format!("a hole of radius {} about ({})", quantity(fit.radius, 4), point(at)),
                self.about(piece, (at, fit)),
                self.on_axis(piece, at),
            ),
            Shape::Flat { at, normal } => (
                format!("face-{number}"),
                format!("a flat face of area {}, normal ({})", quantity(piece.area, 4), point(normal)),
                Some(self.slab(at, normal)),
                Origin::Centroid,
            ),
        };
        let region = region.filter(|region| self.has_just(region, piece));
        let labels = || piece.nodes.iter().map(|node| self.nodes.labels[*node]).collect();
        let nodes = region.map_or_else(|| NodeSelection::Labels(labels()), |within| NodeSelection::Region { within });
        SurfacePatch { name, nodes, n_nodes: piece.nodes.len(), what, origin }
    }

    /// Whether a region has the nodes of a piece and no others.
    fn has_just(&self, region: &Region, piece: &Piece) -> bool {
        let inside = (0..self.nodes.labels.len()).filter(|node| contains(region, self.nodes.coordinates[*node]));
        inside.eq(piece.nodes.iter().copied())
    }

    /// The middle of the axis of a hole: by the fit of a job, or as a point where nodes between its corners are too far off.
    fn on_axis(&self, piece: &Piece, at: [f64; 3]) -> Origin {
        let points: Vec<[f64; 3]> = piece.nodes.iter().map(|node| self.nodes.coordinates[*node]).collect();
        if hole(&points).is_ok() { Origin::Hole } else { Origin::Point(at.map(short)) }
    }

    /// The shell around the wall of a hole.
    fn about(&self, piece: &Piece, (at, fit): ([f64; 3], Fit)) -> Option<Region> {
        let axis = fit.axis?;
        let margin = MARGIN * fit.radius;
        let (mut reach, mut low, mut high) = (0.0f64, fit.radius, fit.radius);
        for node in &piece.nodes {
            let from: [f64; 3] = std::array::from_fn(|i| self.nodes.coordinates[*node][i] - at[i]);
            let along = dot(&from, &axis);
            let across: [f64; 3] = std::array::from_fn(|i| from[i] - along * axis[i]);
            let distance = dense::norm(&across);
            (reach, low, high) = (reach.max(along.abs()), low.min(distance), high.max(distance));
        }
        let reach = reach + margin;
        let end = |side: f64| std::array::from_fn(|i| short(at[i] + side * reach * axis[i]));
        let [radius, inner_radius] = [high + margin, (low - margin).max(0.0)].map(short);
        Some(Region::Cylinder { from: end(-1.0), to: end(1.0), radius, inner_radius })
    }

    /// The slab about a flat face.
    fn slab(&self, at: [f64; 3], normal: [f64; 3]) -> Region {
        let size = dense::worst(self.nodes.coordinates.iter().flatten().map(|x| x.abs()));
        Region::Plane { point: at.map(short), normal: normal.map(short), tolerance: short(1e-5 * size) }
    }
}

/// The axis of the longest extent, and where that ends.
fn longest(positions: &[[f64; 3]]) -> (usize, [f64; 2]) {
    let end = |axis: usize, pick: fn(f64, f64) -> f64| positions.iter().map(|x| x[axis]).reduce(pick).unwrap_or(0.0);
    let ends = [0, 1, 2].map(|axis| (axis, [end(axis, f64::min), end(axis, f64::max)]));
    let extent = |(_, [low, high]): &(usize, [f64; 2])| high - low;
    ends.into_iter().reduce(|a, b| if extent(&b) > extent(&a) { b } else { a }).unwrap_or((0, [0.0; 2]))
}

/// Whether a piece is flat and lies across an axis at some place, to five digits of the extent.
fn is_across(shape: &Shape, (axis, place): (usize, f64), extent: f64) -> bool {
    let Shape::Flat { at, normal } = shape else { return false };
    (at[axis] - place).abs() <= 1e-5 * extent && normal[axis].abs() >= 1.0 - 1e-5
}

/// A number of six digits, as a job of people has them; one below rounding of the others is zero.
fn short(value: f64) -> f64 {
    let value = if value.abs() < 1e-12 { 0.0 } else { value };
    format!("{value:.5e}").parse().unwrap_or(value)
}
