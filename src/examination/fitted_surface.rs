//! The cylinder or the sphere that the nodes of a group lie on.
//!
//! ```text
//! r, ε        radius of a fit, and the largest distance of a node from it
//! d           the largest distance of a node from the one that is next to it
//! d²/2r       how far the middle of a straight edge of length 2d is inside of a circle through its ends
//! ```
//! What a mesh of a cylinder or a sphere leaves between the surface and its nodes is at most that. Flat faces have such fits, too: the ends
//! of a block lie near a sphere, and four of its edges on a cylinder. So nodes that two planes hold lie on none.

use serde::Serialize;
use supel_runtime::motion::cross;

use crate::dense;
use crate::partition::{Fit, hole, sphere};

/// Nodes that lie on a surface by chance: the corners of a box.
const BY_CHANCE: usize = 8;
/// Distance from a plane, relative to the extent of the nodes, of coordinates with five digits.
const FLAT: f64 = 1e-5;

/// A cylinder or a sphere through the nodes of a group.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Surface {
    /// Which of them, as a job names it.
    pub origin: &'static str,
    /// Where the interface node would be.
    pub at: [f64; 3],
    /// Radius, residual and axis.
    #[serde(flatten)]
    pub fit: Fit,
}

/// The cylinder or the sphere that some nodes lie on; four corners lie on both, and say nothing.
pub(super) fn of(points: &[[f64; 3]]) -> Option<Surface> {
    if points.len() <= BY_CHANCE {
        return None;
    }
    let flat = FLAT * dense::worst(points.iter().map(|point| length(minus(*point, points[0]))));
    // Nodes of a layered mesh are nearer to each other along the axis than around it.
    let is_near = |shown: &[[f64; 3]], fit: &Fit| {
        let next = spacing(points, flat).max(spacing(shown, flat));
        fit.residual <= next * next / (2.0 * fit.radius) + flat
    };
    let as_hole = || {
        let (at, fit) = hole(points).ok()?;
        let axis = fit.axis?;
        // Along the axis planes are lines.
        let shown: Vec<[f64; 3]> = points.iter().map(|point| across(minus(*point, at), axis)).collect();
        let is_round = is_near(&shown, &fit) && !are_in_two_planes_along(axis, &shown, flat);
        is_round.then_some(Surface { origin: "hole", at, fit })
    };
    let as_sphere = || {
        let (at, fit) = sphere(points).ok()?;
        let is_round = is_near(points, &fit) && !are_in_two_planes(points, flat);
        is_round.then_some(Surface { origin: "sphere", at, fit })
    };
    as_hole().or_else(as_sphere)
}

/// The largest distance of a point from the one that is next to it, of some hundred points; points at one place count once.
fn spacing(points: &[[f64; 3]], same: f64) -> f64 {
    /// Points that are looked at.
    const SAMPLE: usize = 500;
    let next = |point: &[f64; 3]| {
        let distances = points.iter().map(|other| length(minus(*other, *point)));
        distances.filter(|distance| *distance > same).fold(f64::INFINITY, f64::min)
    };
    let sample = points.iter().step_by(points.len().div_ceil(SAMPLE).max(1));
    sample.map(next).filter(|next| next.is_finite()).fold(0.0, f64::max)
}

/// Whether two planes along an axis hold all points, as lines hold them where they are seen along it. One of the two holds three of any
/// five points.
fn are_in_two_planes_along(axis: [f64; 3], points: &[[f64; 3]], flat: f64) -> bool {
    let few = spread(points, 5, flat);
    let pairs = (0..few.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
    let mut planes = pairs.filter_map(|[i, j]| normal(minus(few[j], few[i]), axis).map(|normal| (few[i], normal)));
    planes.any(|plane| {
        let rest = beyond(points, plane, flat);
        let ends = spread(&rest, 2, flat);
        let line = ends.get(1).and_then(|end| normal(minus(*end, ends[0]), axis));
        line.is_none_or(|normal| beyond(&rest, (ends[0], normal), flat).is_empty())
    })
}

/// Whether two planes hold all points. One of the two holds four of any seven points, which as far apart as can be are in no line.
fn are_in_two_planes(points: &[[f64; 3]], flat: f64) -> bool {
    let few = spread(points, 7, flat);
    let triples = (0..few.len()).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| [i, j, k])));
    let through = |points: &[[f64; 3]], [i, j, k]: [usize; 3]| {
        normal(minus(points[j], points[i]), minus(points[k], points[i])).map(|normal| (points[i], normal))
    };
    let mut planes = triples.filter_map(|triple| through(&few, triple));
    planes.any(|plane| {
        let rest = beyond(points, plane, flat);
        let corners = spread(&rest, 3, flat);
        let other = if corners.len() == 3 { through(&corners, [0, 1, 2]) } else { None };
        other.is_none_or(|plane| beyond(&rest, plane, flat).is_empty())
    })
}

/// Some points that are far from each other: each is the one that is furthest from those before it.
fn spread(points: &[[f64; 3]], most: usize, same: f64) -> Vec<[f64; 3]> {
    let mut found: Vec<[f64; 3]> = points.first().into_iter().copied().collect();
    while found.len() < most {
        let apart =
            |point: &[f64; 3]| found.iter().map(|other| length(minus(*point, *other))).fold(f64::INFINITY, f64::min);
        match points.iter().max_by(|a, b| apart(a).total_cmp(&apart(b))) {
            Some(next) if apart(next) > same => found.push(*next),
            _ => break,
        }
    }
    found
}

/// The points that are not in a plane.
fn beyond(points: &[[f64; 3]], (at, normal): ([f64; 3], [f64; 3]), flat: f64) -> Vec<[f64; 3]> {
    points.iter().filter(|point| dense::dot(&minus(**point, at), &normal).abs() > flat).copied().collect()
}

/// The unit normal of the plane of two directions; none where they are in line.
fn normal(a: [f64; 3], b: [f64; 3]) -> Option<[f64; 3]> {
    let normal = cross(&a, &b);
    let size = length(normal);
    (size > FLAT * length(a) * length(b)).then(|| normal.map(|x| x / size))
}

/// A vector without its part along an axis.
fn across(vector: [f64; 3], axis: [f64; 3]) -> [f64; 3] {
    let along = dense::dot(&vector, &axis);
    std::array::from_fn(|i| vector[i] - along * axis[i])
}

fn length(v: [f64; 3]) -> f64 {
    dense::norm(&v)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of points in a plane across z.
    fn grid([nx, ny]: [usize; 2], [lx, ly]: [f64; 2], z: f64) -> Vec<[f64; 3]> {
        let at = |i: usize, n: usize| i as f64 / (n - 1) as f64 - 0.5;
        (0..ny).flat_map(|j| (0..nx).map(move |i| [lx * at(i, nx), ly * at(j, ny), z])).collect()
    }

    /// Rings about z of nodes at the ends and, as far inside as those of straight edges are, in the middles of edges.
    fn rings(n_edges: usize, heights: &[f64]) -> Vec<[f64; 3]> {
        let half = std::f64::consts::PI / n_edges as f64;
        let node = |k: usize, z: f64| {
            let radius = if k.is_multiple_of(2) { 1.0 } else { half.cos() };
            let (sin, cos) = (half * k as f64).sin_cos();
            [3.0 + radius * cos, radius * sin, z]
        };
        heights.iter().flat_map(|z| (0..2 * n_edges).map(move |k| node(k, *z))).collect()
    }

    #[test]
    fn flat_faces_lie_on_nothing_round() {
        // Ends of a block, and strips along it whose edges lie on a cylinder.
        for (cells, sizes, z) in [
            ([4, 3], [0.08, 0.05], 0.2),
            ([3, 2], [0.08, 0.05], 0.2),
            ([2, 9], [0.08, 0.4], 0.02),
            ([3, 9], [0.08, 0.4], 0.1),
        ] {
            let both = [grid(cells, sizes, -z), grid(cells, sizes, z)].concat();
            assert_eq!(of(&both), None, "{cells:?}");
        }
    }

    #[test]
    fn a_dented_patch_lies_on_nothing() {
        let mut dented = rings(16, &[0.0, 0.5]);
        for point in dented.iter_mut().filter(|point| point[1] > 0.8) {
            point[1] += 0.04;
        }
        assert_eq!(of(&dented), None);
    }

    #[test]
    fn holes_and_balls_of_straight_edges_are_round() {
        for (n_edges, heights) in [(8, &[0.0, 0.2][..]), (8, &[0.0]), (24, &[0.0, 0.5, 1.0])] {
            let found = of(&rings(n_edges, heights));
            assert_eq!(found.map(|found| found.origin), Some("hole"), "{n_edges}");
        }
        let ball: Vec<[f64; 3]> = [0.1f64, 0.4, 0.7]
            .iter()
            .flat_map(|turn| {
                rings(8, &[0.0]).into_iter().map(move |[x, y, _]| [turn.cos() * (x - 3.0), turn.cos() * y, turn.sin()])
            })
            .collect();
        assert_eq!(of(&ball).map(|found| found.origin), Some("sphere"));
    }
}
