//! Interfaces of a mesh without groups that can be: holes and flat faces of its outer surface, besides the ends of the component.

use std::collections::{HashMap, HashSet};

use super::ends::EndFace;
use super::interfaces::rank;
use super::surface::{Piece, Shape, pieces};
use crate::dense;
use crate::dofs::Nodes;
use crate::input::Face;
use crate::job::{NodeSelection, Region};
use crate::number::quantity;
use crate::partition::{Fit, Partition, contains};

/// Holes that are proposed at most.
const MOST_HOLES: usize = 6;
/// Interfaces that are proposed at most, ends counted.
const MOST: usize = 8;
/// Share of its radius by which a region goes beyond a hole, beyond what its nodes are off.
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
    /// How a job calls the place of its interface node; none where that is the mean of the nodes.
    pub origin: Option<&'static str>,
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
    let (holes, flat): (Vec<Piece>, Vec<Piece>) =
        pieces(faces, &nodes.coordinates).into_iter().partition(|piece| matches!(piece.shape, Shape::Hole { .. }));
    let mut chosen = chooser.chosen(holes, MOST_HOLES, &mut taken);
    let is_free = |end: &EndFace, taken: &HashSet<usize>| {
        taken.iter().all(|node| !contains(&end.region, nodes.coordinates[*node]))
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
        let point = |at: [f64; 3]| at.map(|x| quantity(x, 4)).join(", ");
        let (name, what, region, origin) = match piece.shape {
            Shape::Hole { at, fit } => (
                format!("hole-{number}"),
                format!("a hole of radius {} about ({})", quantity(fit.radius, 4), point(at)),
                self.about(piece, (at, fit)),
                Some("hole"),
            ),
            Shape::Flat { at, normal } => (
                format!("face-{number}"),
                format!("a flat face of area {}, normal ({})", quantity(piece.area, 4), point(normal)),
                Some(self.slab(at, normal)),
                None,
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

    /// The shell around the wall of a hole.
    fn about(&self, piece: &Piece, (at, fit): ([f64; 3], Fit)) -> Option<Region> {
        let axis = fit.axis?;
        let margin = fit.residual + MARGIN * fit.radius;
        let from_middle = |node: &usize| -> f64 {
            (0..3).map(|i| (self.nodes.coordinates[*node][i] - at[i]) * axis[i]).sum::<f64>().abs()
        };
        let reach = piece.nodes.iter().map(from_middle).fold(0.0, f64::max) + margin;
        let end = |side: f64| std::array::from_fn(|i| short(at[i] + side * reach * axis[i]));
        let [radius, inner_radius] = [fit.radius + margin, fit.radius - margin].map(short);
        Some(Region::Cylinder { from: end(-1.0), to: end(1.0), radius, inner_radius })
    }

    /// The slab about a flat face.
    fn slab(&self, at: [f64; 3], normal: [f64; 3]) -> Region {
        let size = dense::worst(self.nodes.coordinates.iter().flatten().map(|x| x.abs()));
        Region::Plane { point: at.map(short), normal: normal.map(short), tolerance: short(1e-5 * size) }
    }
}

/// A number of six digits, as a job of people has them; one below rounding of the others is zero.
fn short(value: f64) -> f64 {
    let value = if value.abs() < 1e-12 { 0.0 } else { value };
    format!("{value:.5e}").parse().unwrap_or(value)
}
