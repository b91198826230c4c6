//! What a uniform pressure on a face is worth at its nodes.
//!
//! ```text
//! a_i = ∫ N_i x_ξ × x_η dξ dη        the share of node i in the area vector of a face
//! f_i = −p a_i                       forces of a pressure p, consistent with the displacements of the face
//! ```
//! The rule has four Gauss points each way. It is exact on quadrilaterals of any shape, whose integrands have degree 5 at most in each
//! of ξ and η, and on triangles whose edges may be curved, degree 4; a triangle is the square with one edge collapsed, which adds one.

use supel_runtime::motion::cross;

use super::face_shapes::{Degree, Shape, quadrilateral, quadrilateral_with_centre, triangle, triangle_with_centre};
use super::patch::Face;

/// Points and weights of the rule from −1 to 1, √(3/7 ∓ 2/7 √(6/5)) and (18 ± √30)/36.
const GAUSS: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];

/// The share of each node of a face, in the order of [`Face::nodes`], in its area vector, outwards; `position` says where a node is.
pub fn area_vectors(face: &Face, position: impl Fn(usize) -> [f64; 3]) -> Vec<[f64; 3]> {
    let mut shares = vec![[0.0; 3]; face.nodes().count()];
    for Point { shapes, area_vector, .. } in points(face, position) {
        for (share, shape) in shares.iter_mut().zip(&shapes) {
            share.iter_mut().zip(area_vector).for_each(|(sum, part)| *sum += shape[0] * part);
        }
    }
    shares
}

/// A point of the rule on a face.
pub(super) struct Point {
    /// Shape functions of the nodes of the face there.
    pub(super) shapes: Vec<Shape>,
    /// x.
    pub(super) at: [f64; 3],
    /// x_ξ × x_η dξ dη.
    pub(super) area_vector: [f64; 3],
}

/// The points of the rule on a face; `position` says where a node is.
pub(super) fn points(face: &Face, position: impl Fn(usize) -> [f64; 3]) -> Vec<Point> {
    let nodes: Vec<[f64; 3]> = face.nodes().map(position).collect();
    let of_point = |[xi, w_xi]: [f64; 2], [eta, w_eta]: [f64; 2]| {
        let (shapes, weight) = shapes_at(face, [xi, eta]);
        let along = |part: usize| -> [f64; 3] {
            let terms = nodes.iter().zip(&shapes);
            terms.fold([0.0; 3], |sum, (x, shape)| std::array::from_fn(|axis| sum[axis] + shape[part] * x[axis]))
        };
        let (at, normal) = (along(0), cross(&along(1), &along(2)));
        Point { at, area_vector: normal.map(|part| weight * w_xi * w_eta * part), shapes }
    };
    GAUSS.into_iter().flat_map(|xi| GAUSS.map(|eta| of_point(xi, eta))).collect()
}

/// Shape functions at a point of the square from −1 to 1, and the area of the face's own square or triangle there.
fn shapes_at(face: &Face, [xi, eta]: [f64; 2]) -> (Vec<Shape>, f64) {
    let degree = if face.middles.is_empty() { Degree::Linear } else { Degree::Quadratic };
    if face.corners.len() == 3 {
        let (a, b) = (0.5 * (1.0 + xi), 0.5 * (1.0 + eta));
        let (x, y) = (a, b * (1.0 - a));
        let shapes = if face.centre.is_some() { triangle_with_centre(x, y) } else { triangle(x, y, degree) };
        return (shapes, 0.25 * (1.0 - a));
    }
    let shapes =
        if face.centre.is_some() { quadrilateral_with_centre(xi, eta) } else { quadrilateral(xi, eta, degree) };
    (shapes, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of sixteen products, each of a few roundings.
    const ROUNDING: f64 = 64.0 * f64::EPSILON;

    fn face(n_corners: usize, n_middles: usize, n_centres: usize) -> Face {
        let n = n_corners + n_middles;
        Face {
            corners: (0..n_corners).collect(),
            middles: (n_corners..n).collect(),
            centre: (n_centres > 0).then_some(n),
        }
    }

    /// Consistent loads of textbooks, in shares of the area: none at the corners of a quadratic triangle, negative ones at the corners of
    /// a quadrilateral of eight nodes.
    #[test]
    fn shares_of_flat_faces_are_those_of_textbooks() {
        let triangle: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]];
        let square: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 3.0, 0.0], [0.0, 3.0, 0.0]];
        let cases: [(usize, usize, usize, [f64; 3]); 6] = [
            (3, 0, 0, [1.0 / 3.0, 0.0, 0.0]),
            (3, 3, 0, [0.0, 1.0 / 3.0, 0.0]),
            (3, 3, 1, [0.05, 8.0 / 60.0, 0.45]),
            (4, 0, 0, [0.25, 0.0, 0.0]),
            (4, 4, 0, [-1.0 / 12.0, 1.0 / 3.0, 0.0]),
            (4, 4, 1, [1.0 / 36.0, 1.0 / 9.0, 4.0 / 9.0]),
        ];
        for (n_corners, n_middles, n_centres, expected) in cases {
            let corners: &[[f64; 3]] = if n_corners == 3 { &triangle } else { &square };
            let area = if n_corners == 3 { 3.0 } else { 6.0 };
            let face = face(n_corners, n_middles, n_centres);
            let middle = |nodes: &[usize]| -> [f64; 3] {
                std::array::from_fn(|axis| {
                    nodes.iter().map(|node| corners[*node][axis]).sum::<f64>() / nodes.len() as f64
                })
            };
            let position = |node: usize| match node {
                _ if node < n_corners => corners[node],
                _ if node < n_corners + n_middles => middle(&[node - n_corners, (node - n_corners + 1) % n_corners]),
                _ => middle(&face.corners),
            };
            let found = area_vectors(&face, position);
            for (node, share) in found.iter().enumerate() {
                let kind = usize::from(node >= n_corners) + usize::from(node >= n_corners + n_middles);
                let wanted = [0.0, 0.0, expected[kind] * area];
                for (found, wanted) in share.iter().zip(wanted) {
                    assert!((found - wanted).abs() <= ROUNDING * area, "{n_corners} {n_middles} {node}: {share:?}");
                }
            }
        }
    }

    /// The shares of a face add up to its area vector, which its border alone decides: one that is curved out of its plane has that of the
    /// plane face in the same border, and its resultant moment ∫ x × n dA is that of the border, too.
    #[test]
    fn shares_of_a_curved_face_add_up_to_what_its_border_says() {
        let flat = [
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0],
            [0.5, 0.0],
            [1.0, 0.5],
            [0.5, 1.0],
            [0.0, 0.5],
            [0.5, 0.5],
        ];
        let face = face(4, 4, 1);
        let of = |height: f64| {
            let position = |node: usize| [flat[node][0], flat[node][1], if node == 8 { height } else { 0.0 }];
            let shares = area_vectors(&face, position);
            let sum: [f64; 3] = std::array::from_fn(|axis| shares.iter().map(|share| share[axis]).sum());
            sum
        };
        for (found, wanted) in of(0.3).iter().zip([0.0, 0.0, 1.0]) {
            assert!((found - wanted).abs() <= ROUNDING, "{found}");
        }
    }
}
