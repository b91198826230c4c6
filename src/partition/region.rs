//! Regions of space that select nodes.

use crate::dofs::unit;
use crate::job::Region;

/// True where the point lies in the region or on its border.
pub(crate) fn contains(region: &Region, point: [f64; 3]) -> bool {
    match region {
        Region::Box { min, max } => (0..3).all(|axis| min[axis] <= point[axis] && point[axis] <= max[axis]),
        Region::Plane { point: origin, normal, tolerance } => {
            direction(*normal).is_some_and(|normal| dot(normal, minus(point, *origin)).abs() <= *tolerance)
        }
        Region::Cylinder { from, to, radius, inner_radius } => {
            let Some(axis) = direction(minus(*to, *from)) else { return false };
            let offset = minus(point, *from);
            let along = dot(axis, offset);
            let across = norm(std::array::from_fn(|i| offset[i] - along * axis[i]));
            (0.0..=norm(minus(*to, *from))).contains(&along) && (*inner_radius..=*radius).contains(&across)
        }
        Region::Sphere { center, radius } => norm(minus(point, *center)) <= *radius,
    }
}

/// The direction of a vector of any length; none of zero.
fn direction(a: [f64; 3]) -> Option<[f64; 3]> {
    (a != [0.0; 3]).then(|| unit(a))
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: [f64; 3]) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_has_its_border() {
        let region = Region::Box { min: [0.0; 3], max: [1.0, 2.0, 3.0] };
        assert!(contains(&region, [1.0, 0.0, 3.0]));
        assert!(!contains(&region, [1.0, 2.1, 3.0]));
    }

    #[test]
    fn plane_takes_a_normal_of_any_length() {
        let region = Region::Plane { point: [0.0, 0.0, 5.0], normal: [0.0, 0.0, 10.0], tolerance: 0.1 };
        assert!(contains(&region, [7.0, -3.0, 5.05]));
        assert!(!contains(&region, [7.0, -3.0, 5.2]));
    }

    /// Directions count, lengths of vectors do not: squares of these are zero or infinite.
    #[test]
    fn vectors_may_be_of_any_length() {
        for length in [1e-310, 1e-170, 1e160, 1e300] {
            let plane = Region::Plane { point: [0.0; 3], normal: [length, 0.0, 0.0], tolerance: 0.1 };
            assert!(contains(&plane, [0.05, 2.0, 3.0]) && !contains(&plane, [0.2, 2.0, 3.0]), "{length}");
        }
        let thin = Region::Cylinder { from: [0.0; 3], to: [0.0, 0.0, 1e-170], radius: 1.0, inner_radius: 0.0 };
        assert!(contains(&thin, [0.5, 0.0, 0.0]) && !contains(&thin, [0.5, 0.0, 1e-6]));
        let small = Region::Sphere { center: [0.0; 3], radius: 1e-200 };
        assert!(contains(&small, [1e-200, 0.0, 0.0]) && !contains(&small, [2e-200, 0.0, 0.0]));
    }

    /// On the border of a cylinder far from its start: the distance from the axis is not the difference of two large squares.
    #[test]
    fn a_long_cylinder_has_its_border() {
        let region = Region::Cylinder { from: [0.0; 3], to: [0.0, 0.0, 2e8], radius: 0.1, inner_radius: 0.1 };
        assert!(contains(&region, [0.1, 0.0, 123_456_789.0]));
    }

    #[test]
    fn cylinder_ends_and_may_be_a_shell() {
        let region = Region::Cylinder { from: [0.0; 3], to: [0.0, 0.0, 2.0], radius: 1.0, inner_radius: 0.9 };
        assert!(contains(&region, [0.95, 0.0, 1.0]));
        assert!(!contains(&region, [0.5, 0.0, 1.0]));
        assert!(!contains(&region, [0.95, 0.0, 2.5]));
    }

    #[test]
    fn sphere_is_solid() {
        let region = Region::Sphere { center: [1.0, 0.0, 0.0], radius: 1.0 };
        assert!(contains(&region, [2.0, 0.0, 0.0]));
        assert!(!contains(&region, [2.0, 0.1, 0.0]));
    }
}
