//! Flat faces at the ends of a component: interfaces of a mesh without groups.

use super::interfaces::rank;
use crate::job::Region;
use crate::partition::Partition;

/// Nodes in a face, relative to the longest extent away from its plane: rounding of coordinates with five digits.
const FLAT: f64 = 1e-5;
/// Nodes that a patch has at least.
const LEAST_NODES: usize = 3;

/// A flat face that ends a component along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct EndFace {
    /// Its name: the axis and which end of it.
    pub name: String,
    /// Where its nodes are.
    pub region: Region,
    /// How many nodes it has.
    pub n_nodes: usize,
}

/// The faces at both ends of the longest extent, where both are flat; of the next one where they are not. A face with a held node is none
/// that an interface could be.
pub(super) fn end_faces(partition: &Partition, held: &[[f64; 3]]) -> Vec<EndFace> {
    let Some(sites) = partition.sites() else { return Vec::new() };
    let mut positions: Vec<(u32, [f64; 3])> = Vec::new();
    for (dof, site) in partition.dofs.iter().zip(sites) {
        positions.extend(site.map(|site| (dof.node, site.position)));
    }
    positions.sort_by_key(|(node, _)| *node);
    positions.dedup_by_key(|(node, _)| *node);
    let positions: Vec<[f64; 3]> = positions.into_iter().map(|(_, position)| position).collect();
    let all = || positions.iter().chain(held);
    let end = |axis: usize, pick: fn(f64, f64) -> f64| all().map(|position| position[axis]).reduce(pick);
    let ends = |axis: usize| Some([end(axis, f64::min)?, end(axis, f64::max)?]);
    let mut axes: Vec<(usize, [f64; 2])> = (0..3).filter_map(|axis| Some((axis, ends(axis)?))).collect();
    axes.sort_by(|a, b| (b.1[1] - b.1[0]).total_cmp(&(a.1[1] - a.1[0])));
    let longest = axes.first().map_or(0.0, |(_, [low, high])| high - low);
    let faces = |(axis, ends): &(usize, [f64; 2])| {
        let is_at = |position: &[f64; 3], at: f64| (position[*axis] - at).abs() <= FLAT * longest;
        let is_held = |at: f64| held.iter().any(|position| is_at(position, at));
        let n_nodes = |at: f64| positions.iter().filter(|position| is_at(position, at)).count();
        let is_dof_at = |dof: usize, at: f64| partition.dofs[dof].site.is_some_and(|site| is_at(&site.position, at));
        // Nodes in line, or with too few directions, carry no patch.
        let carries = |at: f64| {
            let dofs: Vec<usize> = (0..partition.n_dofs()).filter(|dof| is_dof_at(*dof, at)).collect();
            rank(partition, &dofs) == 6
        };
        let is_patch = |at: f64| n_nodes(at) >= LEAST_NODES && 2 * n_nodes(at) < positions.len() && carries(at);
        let faces = [("minus", ends[0]), ("plus", ends[1])];
        let are_flat = faces.iter().all(|(_, at)| is_held(*at) || is_patch(*at));
        let free = faces.into_iter().filter(|(_, at)| !is_held(*at));
        let free: Vec<EndFace> =
            free.map(|(which, at)| face((*axis, which), (at, FLAT * longest), n_nodes(at))).collect();
        (are_flat && !free.is_empty()).then_some(free)
    };
    axes.iter().filter(|(_, [low, high])| high > low).find_map(faces).unwrap_or_default()
}

fn face((axis, which): (usize, &str), (at, tolerance): (f64, f64), n_nodes: usize) -> EndFace {
    let along = |value: f64| std::array::from_fn(|other| if other == axis { value } else { 0.0 });
    let region = Region::Plane { point: along(at), normal: along(1.0), tolerance };
    EndFace { name: format!("{which}-{}", ["x", "y", "z"][axis]), region, n_nodes }
}
