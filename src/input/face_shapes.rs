//! Shape functions of triangles and quadrilaterals.
//!
//! ```text
//! x(ξ, η) = Σ N_i x_i
//! ```
//! Corners come first, then the nodes in the middles of the edges from that between the first two corners on, then the one in the middle
//! of the face.

/// A node's shape function and its two derivatives.
pub(super) type Shape = [f64; 3];

/// Whether a face has nodes in the middles of its edges.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Degree {
    Linear,
    Quadratic,
}

/// Shape functions of a triangle with corners (0, 0), (1, 0), (0, 1).
pub(super) fn triangle(x: f64, y: f64, degree: Degree) -> Vec<Shape> {
    let linear: [Shape; 3] = [[1.0 - x - y, -1.0, -1.0], [x, 1.0, 0.0], [y, 0.0, 1.0]];
    if degree == Degree::Linear {
        return linear.into();
    }
    let corner = |[l, a, b]: Shape| [l * (2.0 * l - 1.0), (4.0 * l - 1.0) * a, (4.0 * l - 1.0) * b];
    let middle = |[l, a, b]: Shape, [m, c, d]: Shape| [4.0 * l * m, 4.0 * (l * c + m * a), 4.0 * (l * d + m * b)];
    let [p, q, r] = linear;
    vec![corner(p), corner(q), corner(r), middle(p, q), middle(q, r), middle(r, p)]
}

/// Shape functions of a square with corners (−1, −1), (1, −1), (1, 1), (−1, 1).
pub(super) fn quadrilateral(x: f64, y: f64, degree: Degree) -> Vec<Shape> {
    const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corner = |[a, b]: [f64; 2]| -> Shape {
        let (u, v) = (1.0 + a * x, 1.0 + b * y);
        if degree == Degree::Linear {
            return [0.25 * u * v, 0.25 * a * v, 0.25 * b * u];
        }
        let w = a * x + b * y - 1.0;
        [0.25 * u * v * w, 0.25 * a * v * (w + u), 0.25 * b * u * (w + v)]
    };
    let across =
        |b: f64| -> Shape { [0.5 * (1.0 - x * x) * (1.0 + b * y), -x * (1.0 + b * y), 0.5 * b * (1.0 - x * x)] };
    let along =
        |a: f64| -> Shape { [0.5 * (1.0 - y * y) * (1.0 + a * x), 0.5 * a * (1.0 - y * y), -y * (1.0 + a * x)] };
    let mut shapes: Vec<Shape> = CORNERS.map(corner).into();
    if degree == Degree::Quadratic {
        shapes.extend([across(-1.0), along(1.0), across(1.0), along(-1.0)]);
    }
    shapes
}

/// The shape functions of a face that has a node in its middle, too, from those without it: `bubble` is that of the middle, and `at_middle`
/// what those of a corner and of the middle of an edge are there.
fn with_centre(shapes: Vec<Shape>, n_corners: usize, (bubble, at_middle): (Shape, [f64; 2])) -> Vec<Shape> {
    let less = |(at, shape): (usize, Shape)| -> Shape {
        let share = at_middle[usize::from(at >= n_corners)];
        std::array::from_fn(|part| shape[part] - share * bubble[part])
    };
    shapes.into_iter().enumerate().map(less).chain([bubble]).collect()
}

/// Shape functions of a quadratic triangle with a node in its middle.
pub(super) fn triangle_with_centre(x: f64, y: f64) -> Vec<Shape> {
    let z = 1.0 - x - y;
    let bubble = [27.0 * x * y * z, 27.0 * y * (z - x), 27.0 * x * (z - y)];
    with_centre(triangle(x, y, Degree::Quadratic), 3, (bubble, [-1.0 / 9.0, 4.0 / 9.0]))
}

/// Shape functions of a quadratic quadrilateral with a node in its middle.
pub(super) fn quadrilateral_with_centre(x: f64, y: f64) -> Vec<Shape> {
    let (u, v) = (1.0 - x * x, 1.0 - y * y);
    let bubble = [u * v, -2.0 * x * v, -2.0 * y * u];
    with_centre(quadrilateral(x, y, Degree::Quadratic), 4, (bubble, [-0.25, 0.5]))
}
