//! Area and first moment of a face.
//!
//! ```text
//! x(ξ, η) = Σ N_i x_i,    A = ∫ |x_ξ × x_η| dξ dη,    S = ∫ x |x_ξ × x_η| dξ dη
//! ```
//! by three Gauss points each way, which is exact for a plane face, its edges curved or not: there x_ξ × x_η has a constant direction,
//! and x |x_ξ × x_η| degree 5 at most in each of ξ, η (degree 4 on a triangle, which is the square with one edge collapsed, and 5
//! with the shrinking of its lines).

use supel_runtime::motion::cross;

use super::super::face_shapes::{Degree, quadrilateral, triangle};

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

/// Of a face with its corners along the border, and behind them the nodes in the middles of its edges where it has any.
pub(super) fn moments(corners: &[[f64; 3]], middles: &[[f64; 3]]) -> Moments {
    /// √(3/5) and the weights 5/9, 8/9, 5/9.
    const AT: [f64; 3] = [-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4];
    const WEIGHT: [f64; 3] = [5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0];
    let degree = if middles.is_empty() { Degree::Linear } else { Degree::Quadratic };
    let mut total = Moments::default();
    for (xi, w_xi) in AT.into_iter().zip(WEIGHT) {
        for (eta, w_eta) in AT.into_iter().zip(WEIGHT) {
            let (shapes, weight) = if corners.len() == 3 {
                let (a, b) = (0.5 * (1.0 + xi), 0.5 * (1.0 + eta));
                (triangle(a, b * (1.0 - a), degree), 0.25 * (1.0 - a) * w_xi * w_eta)
            } else {
                (quadrilateral(xi, eta, degree), w_xi * w_eta)
            };
            let at = |part: usize| -> [f64; 3] {
                let nodes = corners.iter().chain(middles).zip(&shapes);
                nodes.fold([0.0; 3], |sum, (x, shape)| std::array::from_fn(|axis| sum[axis] + shape[part] * x[axis]))
            };
            let area = weight * length(cross(&at(1), &at(2)));
            total = total.plus(Moments { area, first: at(0).map(|x| area * x) });
        }
    }
    total
}

/// The shares of corners and other nodes, in this order, in the area of a face: in proportion to the diagonal ∫ N² dA of the consistent
/// mass matrix (Hinton, Rock and Zienkiewicz 1976), as it is on a face whose corners span a parallelogram or a triangle.
pub(super) fn shares(n_corners: usize, n_others: usize) -> Vec<f64> {
    let (corner, middle, centre) = match (n_corners, n_others) {
        (3, 3) => (3.0 / 57.0, 16.0 / 57.0, 0.0),
        (4, 4) => (3.0 / 76.0, 16.0 / 76.0, 0.0),
        (4, 5) => (1.0 / 36.0, 4.0 / 36.0, 16.0 / 36.0),
        // Faces without other nodes, and such as collapsed cells have.
        (_, others) => (1.0 / (n_corners + others) as f64, 1.0 / (n_corners + others) as f64, 0.0),
    };
    let others = (0..n_others).map(|other| if other < n_corners || centre == 0.0 { middle } else { centre });
    std::iter::repeat_n(corner, n_corners).chain(others).collect()
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

    #[test]
    fn straight_plane_faces_have_their_polygon_s_centroid() {
        let triangle = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 1.5, 0.0]];
        assert_is(moments(&triangle, &[]), 2.25, [1.0, 0.5]);
        // Two wide below and one above: 1.5 with its centre at 4/9.
        let trapezium = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_is(moments(&trapezium, &[]), 1.5, [7.0 / 9.0, 4.0 / 9.0]);
        let middle = |corners: &[[f64; 3]], at: usize| -> [f64; 3] {
            let next = corners[(at + 1) % corners.len()];
            std::array::from_fn(|axis| 0.5 * (corners[at][axis] + next[axis]))
        };
        let of = |corners: &[[f64; 3]]| (0..corners.len()).map(|at| middle(corners, at)).collect::<Vec<_>>();
        assert_is(moments(&triangle, &of(&triangle)), 2.25, [1.0, 0.5]);
        assert_is(moments(&trapezium, &of(&trapezium)), 1.5, [7.0 / 9.0, 4.0 / 9.0]);
    }

    /// The parabola 4h x (1 − x) over an edge of length one adds 2h/3 at the height 2h/5.
    #[test]
    fn curved_edges_count() {
        let h = 0.2;
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let middles = [[0.5, 0.0, 0.0], [1.0, 0.5, 0.0], [0.5, 1.0 + h, 0.0], [0.0, 0.5, 0.0]];
        let area = 1.0 + 2.0 * h / 3.0;
        let height = (0.5 + 2.0 * h / 3.0 * (1.0 + 0.4 * h)) / area;
        assert_is(moments(&square, &middles), area, [0.5, height]);
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let middles = [[0.5, -h, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.0]];
        let area = 0.5 + 2.0 * h / 3.0;
        let centroid = [(1.0 / 6.0 + 2.0 * h / 3.0 * 0.5) / area, (1.0 / 6.0 - 2.0 * h / 3.0 * 0.4 * h) / area];
        assert_is(moments(&triangle, &middles), area, centroid);
    }

    /// The shares are in proportion to ∫ N² over the triangle and the square, which three Gauss points each way integrate exactly.
    #[test]
    fn shares_are_those_of_a_lumped_mass_matrix() {
        const AT: [f64; 3] = [-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4];
        const WEIGHT: [f64; 3] = [5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0];
        for (n_corners, degree) in [(3, Degree::Linear), (3, Degree::Quadratic), (4, Degree::Quadratic)] {
            let mut squares = vec![0.0; if degree == Degree::Linear { n_corners } else { 2 * n_corners }];
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                let (shapes, weight) = if n_corners == 3 {
                    let (a, b) = (0.5 * (1.0 + AT[i]), 0.5 * (1.0 + AT[j]));
                    (triangle(a, b * (1.0 - a), degree), (1.0 - a) * WEIGHT[i] * WEIGHT[j])
                } else {
                    (quadrilateral(AT[i], AT[j], degree), WEIGHT[i] * WEIGHT[j])
                };
                squares.iter_mut().zip(&shapes).for_each(|(sum, shape)| *sum += weight * shape[0] * shape[0]);
            }
            let total: f64 = squares.iter().sum();
            let found = shares(n_corners, squares.len() - n_corners);
            assert_eq!(found.len(), squares.len());
            for (share, square) in found.iter().zip(&squares) {
                assert!((share - square / total).abs() < ROUNDING, "{found:?} {squares:?}");
            }
        }
        for (n_corners, n_others) in [(3, 0), (3, 3), (3, 4), (4, 0), (4, 4), (4, 5)] {
            let sum: f64 = shares(n_corners, n_others).iter().sum();
            assert!((sum - 1.0).abs() < ROUNDING, "{n_corners} and {n_others}: {sum}");
        }
    }
}
