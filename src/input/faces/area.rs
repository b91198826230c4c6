//! Area and first moment of a face, and what each of its nodes has of the area.
//!
//! ```text
//! dA = |x_ξ × x_η| dξ dη,    A = ∫ dA,    S = ∫ x dA
//! a_i = ∫ N_i dA                     row sums of the consistent mass matrix, where all are above zero
//!     = A ∫ N_i² dA / Σ ∫ N_j² dA    its diagonal, scaled to the area, elsewhere
//! ```
//! The integrals of the shape functions have the centroid of the face, Σ a_i x_i = S, and are what a uniform traction on it makes of its
//! nodes. With nodes in the middles of the edges and none in the middle of the face they are zero or less at the corners, and no weights.
//! The diagonal is positive at every node (Hinton, Rock and Zienkiewicz 1976).
//!
//! The rule of [`super::super::face_areas`] is exact on plane faces, their edges curved or not: there x_ξ × x_η has a constant direction.

use super::super::face_areas::{Point, points};
use super::super::patch::Face;
use supel_runtime::motion::cross;

/// Area and first moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Moments {
    pub(super) area: f64,
    pub(super) first: [f64; 3],
}

impl Moments {
    pub(super) fn plus(self, other: Self) -> Self {
        let first = std::array::from_fn(|axis| self.first[axis] + other.first[axis]);
        Self { area: self.area + other.area, first }
    }
}

/// Of a face; `position` says where a node is.
pub(super) fn moments(face: &Face, position: impl Fn(usize) -> [f64; 3]) -> Moments {
    let of_point = |point: Point| {
        let area = length(point.area_vector);
        Moments { area, first: point.at.map(|x| area * x) }
    };
    points(face, position).into_iter().map(of_point).fold(Moments::default(), Moments::plus)
}

/// What each node of a face, in the order of [`Face::nodes`], has of its area; `position` says where a node is.
pub(super) fn shares(face: &Face, position: impl Fn(usize) -> [f64; 3]) -> Vec<f64> {
    let n = face.nodes().count();
    let (mut integrals, mut squares) = (vec![0.0; n], vec![0.0; n]);
    for point in points(face, position) {
        let area = length(point.area_vector);
        for (at, [shape, ..]) in point.shapes.into_iter().enumerate() {
            integrals[at] += area * shape;
            squares[at] += area * shape * shape;
        }
    }
    let has_corners = face.middles.is_empty() || face.centre.is_some();
    if has_corners && integrals.iter().all(|share| *share > 0.0) {
        return integrals;
    }
    let (area, sum): (f64, f64) = (integrals.iter().sum(), squares.iter().sum());
    squares.iter().map(|square| if sum > 0.0 { area * square / sum } else { 0.0 }).collect()
}

/// Twice the area vector of a polygon: along its normal, on whose side its corners are counterclockwise.
pub(super) fn normal(corners: &[[f64; 3]]) -> [f64; 3] {
    let from = corners[0];
    corners[1..].windows(2).fold([0.0; 3], |sum, ends| {
        let part = cross(&minus(ends[0], from), &minus(ends[1], from));
        std::array::from_fn(|axis| sum[axis] + part[axis])
    })
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sum of 27 products, each of a few roundings.
    const ROUNDING: f64 = 64.0 * f64::EPSILON;

    fn assert_is(found: Moments, area: f64, centroid: [f64; 2]) {
        assert!((found.area / area - 1.0).abs() < ROUNDING, "{found:?}");
        for (first, expected) in found.first.iter().zip(centroid) {
            assert!((first / area - expected).abs() < ROUNDING, "{found:?}");
        }
        assert_eq!(found.first[2], 0.0);
    }

    /// A face of these nodes, in the order of [`Face::nodes`].
    fn face_of(n_corners: usize, n_nodes: usize) -> Face {
        let n_border = if n_nodes > n_corners { 2 * n_corners } else { n_corners };
        Face {
            corners: (0..n_corners).collect(),
            middles: (n_corners..n_border).collect(),
            centre: (n_nodes > n_border).then_some(n_border),
        }
    }

    fn of(corners: &[[f64; 3]], others: &[[f64; 3]]) -> Moments {
        let nodes = [corners, others].concat();
        moments(&face_of(corners.len(), nodes.len()), |node| nodes[node])
    }

    /// The nodes in the middles of the edges of a polygon.
    fn middles(corners: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let next = |at: usize| corners[(at + 1) % corners.len()];
        let middle = |at: usize| std::array::from_fn(|axis| 0.5 * (corners[at][axis] + next(at)[axis]));
        (0..corners.len()).map(middle).collect()
    }

    const TRIANGLE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 1.5, 0.0]];
    /// Two wide below and one above: 1.5 with its centre at 4/9.
    const TRAPEZIUM: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// The middle of its edges' middles.
    const MIDDLE: [f64; 3] = [0.75, 0.5, 0.0];

    #[test]
    fn straight_plane_faces_have_their_polygon_s_centroid() {
        assert_is(of(&TRIANGLE, &[]), 2.25, [1.0, 0.5]);
        assert_is(of(&TRIANGLE, &middles(&TRIANGLE)), 2.25, [1.0, 0.5]);
        for others in [vec![], middles(&TRAPEZIUM), [middles(&TRAPEZIUM), vec![MIDDLE]].concat()] {
            assert_is(of(&TRAPEZIUM, &others), 1.5, [7.0 / 9.0, 4.0 / 9.0]);
        }
    }

    /// The parabola 4h x (1 − x) over an edge of length one adds 2h/3 at the height 2h/5.
    #[test]
    fn curved_edges_count() {
        let h = 0.2;
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let others = [[0.5, 0.0, 0.0], [1.0, 0.5, 0.0], [0.5, 1.0 + h, 0.0], [0.0, 0.5, 0.0]];
        let area = 1.0 + 2.0 * h / 3.0;
        let height = (0.5 + 2.0 * h / 3.0 * (1.0 + 0.4 * h)) / area;
        assert_is(of(&square, &others), area, [0.5, height]);
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let others = [[0.5, -h, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.0]];
        let area = 0.5 + 2.0 * h / 3.0;
        let centroid = [(1.0 / 6.0 + 2.0 * h / 3.0 * 0.5) / area, (1.0 / 6.0 - 2.0 * h / 3.0 * 0.4 * h) / area];
        assert_is(of(&triangle, &others), area, centroid);
    }

    fn assert_shares(corners: &[[f64; 3]], others: &[[f64; 3]], expected: &[f64]) {
        let nodes = [corners, others].concat();
        let found = shares(&face_of(corners.len(), nodes.len()), |node| nodes[node]);
        assert_eq!(found.len(), expected.len());
        for (share, expected) in found.iter().zip(expected) {
            assert!((share - expected).abs() < ROUNDING * 2.25, "{found:?} {expected}");
        }
        assert!(found.iter().all(|share| *share > 0.0), "{found:?}");
    }

    /// The integrals of shape functions, by hand: those of a bilinear face follow from the areas of its corner triangles T_i as
    /// (4 T_i + 2 T_{i±1} + T_{i+2}) / 18. They have the centroid of the face.
    #[test]
    fn shares_are_the_integrals_of_shape_functions() {
        assert_shares(&TRIANGLE, &[], &[0.75; 3]);
        let of_corners = [5.0 / 12.0, 5.0 / 12.0, 1.0 / 3.0, 1.0 / 3.0];
        assert_shares(&TRAPEZIUM, &[], &of_corners);
        let first: f64 = TRAPEZIUM.iter().zip(of_corners).map(|(corner, share)| share * corner[0]).sum();
        assert!((first / 1.5 - 7.0 / 9.0).abs() < ROUNDING);
        let others = [middles(&TRAPEZIUM), vec![MIDDLE]].concat();
        let expected = [2.0, 2.0, 1.0, 1.0, 8.0, 6.0, 4.0, 6.0, 24.0].map(|share| share / 36.0);
        assert_shares(&TRAPEZIUM, &others, &expected);
        let others = [middles(&TRIANGLE), vec![[1.0, 0.5, 0.0]]].concat();
        let expected = [[3.0; 3], [8.0; 3]].concat().into_iter().chain([27.0]).map(|share| 2.25 * share / 60.0);
        assert_shares(&TRIANGLE, &others, &expected.collect::<Vec<_>>());
    }

    /// Where these are zero or less at the corners: the scaled diagonal of the consistent mass matrix, by exact integration of polynomials.
    #[test]
    fn shares_of_faces_with_nodes_on_their_edges_are_positive() {
        let expected = [[3.0; 3], [16.0; 3]].concat().into_iter().map(|share| 2.25 * share / 57.0);
        assert_shares(&TRIANGLE, &middles(&TRIANGLE), &expected.collect::<Vec<_>>());
        let expected = [5.0, 5.0, 4.0, 4.0, 28.0, 24.0, 20.0, 24.0].map(|share| share / 76.0);
        assert_shares(&TRAPEZIUM, &middles(&TRAPEZIUM), &expected);
        // A face so bent that the integral at its third corner is -0.024.
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let others = [[0.25, -0.25, 0.0], [1.0, 0.7, 0.0], [0.75, 1.25, 0.0], [0.2, 0.25, 0.0], [0.75, 0.75, 0.0]];
        let nodes = [&square[..], &others].concat();
        let found = shares(&face_of(4, 9), |node| nodes[node]);
        assert!(found.iter().all(|share| *share > 0.0), "{found:?}");
    }
}
