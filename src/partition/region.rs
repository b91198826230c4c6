//! Regions of space that select nodes.

use crate::job::Region;

/// True where the point lies in the region or on its border.
pub(super) fn contains(region: &Region, point: [f64; 3]) -> bool {
    match region {
        Region::Box { min, max } => (0..3).all(|axis| min[axis] <= point[axis] && point[axis] <= max[axis]),
        Region::Plane { point: origin, normal, tolerance } => {
            let length = norm(*normal);
            length > 0.0 && (dot(*normal, minus(point, *origin)) / length).abs() <= *tolerance
        }
        Region::Cylinder { from, to, radius, inner_radius } => {
            let axis = minus(*to, *from);
            let length = norm(axis);
            if length == 0.0 {
                return false;
            }
            let offset = minus(point, *from);
            let along = dot(axis, offset) / length;
            let across = (dot(offset, offset) - along * along).max(0.0).sqrt();
            (0.0..=length).contains(&along) && (*inner_radius..=*radius).contains(&across)
        }
        Region::Sphere { center, radius } => norm(minus(point, *center)) <= *radius,
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
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
