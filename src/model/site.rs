//! Where a degree of freedom is, and what rigid-body motion does to it.

use std::collections::{HashMap, HashSet};

use super::Model;
use crate::dofs::{Direction, Dof};

/// Where a dof is and which way it points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Position of the node.
    pub position: [f64; 3],
    /// Direction at the node.
    pub direction: Direction,
}

impl Site {
    /// Displacement of this dof under the six unit rigid motions: translations, then rotations about axes through the origin.
    pub fn rigid_motion(&self) -> [f64; 6] {
        rigid_motion(self.direction, self.position)
    }

    /// Displacement of this dof under the six unit rigid motions whose rotations are about axes through `centre`.
    pub fn rigid_motion_about(&self, centre: [f64; 3]) -> [f64; 6] {
        rigid_motion(self.direction, [0, 1, 2].map(|axis| self.position[axis] - centre[axis]))
    }
}

/// Displacement in a direction at offset r from the centre, under unit translations and rotations.
fn rigid_motion(direction: Direction, r: [f64; 3]) -> [f64; 6] {
    let [x, y, z] = r;
    match direction {
        Direction::Ux => [1.0, 0.0, 0.0, 0.0, z, -y],
        Direction::Uy => [0.0, 1.0, 0.0, -z, 0.0, x],
        Direction::Uz => [0.0, 0.0, 1.0, y, -x, 0.0],
        Direction::Rx => [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        Direction::Ry => [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        Direction::Rz => [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
    }
}

/// The six unit rigid motions of a dof about axes through another centre.
pub fn recentred(motion: [f64; 6], from: [f64; 3], to: [f64; 3]) -> [f64; 6] {
    let [x, y, z] = [0, 1, 2].map(|axis| from[axis] - to[axis]);
    let [tx, ty, tz, rx, ry, rz] = motion;
    // e × (r − to) = e × (r − from) + e × (from − to) for each unit axis e.
    [tx, ty, tz, rx - z * ty + y * tz, ry + z * tx - x * tz, rz - y * tx + x * ty]
}

/// The middle of some sites and the largest distance from it.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Mean position over the dofs.
    pub centre: [f64; 3],
    /// Distance of the farthest dof; one where all dofs are at one place, so that rotations can be compared all the same.
    pub size: f64,
}

/// Distances relative to the farthest coordinate that are rounding: of a mean, or of what was fitted to the same nodes in another order.
pub(crate) const ONE_PLACE: f64 = 1e-12;

impl Frame {
    /// Of the dofs that are listed; those without a place do not count.
    pub fn of(sites: &[Option<Site>], dofs: &[usize]) -> Self {
        let positions = || dofs.iter().filter_map(|dof| sites[*dof]).map(|site| site.position);
        let count = positions().count().max(1) as f64;
        let mut centre = [0.0; 3];
        for position in positions() {
            for (sum, value) in centre.iter_mut().zip(position) {
                *sum += value / count;
            }
        }
        let distance =
            |position: [f64; 3]| (0..3).map(|axis| (position[axis] - centre[axis]).powi(2)).sum::<f64>().sqrt();
        let size = positions().map(distance).fold(0.0, f64::max);
        // The mean of one place is that place but for rounding.
        let far = sites.iter().flatten().flat_map(|site| site.position).fold(0.0f64, |max, x| max.max(x.abs()));
        Self { centre, size: if size > ONE_PLACE * far { size } else { 1.0 } }
    }
}

impl Model {
    /// Position and direction of every row, none for a scalar dof; nothing where the dof map or the position of a node is not known, or
    /// no row belongs to a node.
    pub fn sites(&self) -> Option<Vec<Option<Site>>> {
        let (dofs, nodes) = self.dofs.as_ref().zip(self.nodes.as_ref())?;
        let wanted: HashSet<i64> = dofs.iter().flatten().map(|dof| dof.node).collect();
        let places = nodes.labels.iter().copied().zip(nodes.coordinates.iter().copied());
        let positions: HashMap<i64, [f64; 3]> = places.filter(|(label, _)| wanted.contains(label)).collect();
        let site = |dof: &Dof| Some(Site { position: *positions.get(&dof.node)?, direction: dof.direction });
        let of_row = |dof: &Option<Dof>| dof.as_ref().map_or(Some(None), |dof| site(dof).map(Some));
        let sites: Vec<Option<Site>> = dofs.iter().map(of_row).collect::<Option<_>>()?;
        sites.iter().any(Option::is_some).then_some(sites)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_about_another_centre_are_those_of_the_shifted_site() {
        let (from, to) = ([0.5, -2.0, 3.0], [-1.0, 4.0, 0.25]);
        for direction in Direction::ALL {
            let site = Site { position: [1.5, 0.75, -3.0], direction };
            // All numbers are binary fractions of few digits: nothing rounds.
            assert_eq!(recentred(site.rigid_motion_about(from), from, to), site.rigid_motion_about(to), "{direction}");
            assert_eq!(site.rigid_motion(), site.rigid_motion_about([0.0; 3]), "{direction}");
        }
    }
}
