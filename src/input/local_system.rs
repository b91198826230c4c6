//! Coordinate systems: where a point is, and along which axes displacements at it are.

use crate::dofs::{Axes, cross, spanned};

/// What the coordinates of a system are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SystemKind {
    /// x, y, z.
    Rectangular,
    /// Radius, angle in degrees, z.
    Cylindrical,
    /// Radius, angle from z in degrees, angle about z in degrees.
    Spherical,
}

/// A coordinate system in that of the model.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalSystem {
    kind: SystemKind,
    origin: [f64; 3],
    /// x, y and z.
    axes: Axes,
}

impl LocalSystem {
    /// That of the model.
    pub(super) fn of_the_model() -> Self {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Self { kind: SystemKind::Rectangular, origin: [0.0; 3], axes }
    }

    /// With x along a direction and y along what another leaves across it; none where the two are parallel.
    pub(super) fn new(kind: SystemKind, origin: [f64; 3], x: [f64; 3], y: [f64; 3]) -> Option<Self> {
        Some(Self { kind, origin, axes: spanned(x, y)? })
    }

    /// A point of these coordinates, in those of the model.
    pub(super) fn point(&self, [a, b, c]: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = match self.kind {
            SystemKind::Rectangular => [a, b, c],
            SystemKind::Cylindrical => {
                let (sin, cos) = b.to_radians().sin_cos();
                [a * cos, a * sin, c]
            }
            SystemKind::Spherical => {
                let ((sin, cos), (sin_about, cos_about)) = (b.to_radians().sin_cos(), c.to_radians().sin_cos());
                [a * sin * cos_about, a * sin * sin_about, a * cos]
            }
        };
        std::array::from_fn(|i| self.origin[i] + self.axes[0][i] * x + self.axes[1][i] * y + self.axes[2][i] * z)
    }

    /// The axes of displacements at a point of the model: those of the system, or radial, tangential and along z, or radial, in the
    /// direction of the angle from z and in that about z. On the axis z the angle about it is that of x.
    pub(super) fn axes_at(&self, point: [f64; 3]) -> Axes {
        let from_origin: [f64; 3] = std::array::from_fn(|i| point[i] - self.origin[i]);
        let z = self.axes[2];
        // About z by the angle of the point: its radial direction and the one across.
        let [radial, tangential, _] = {
            let tangent = cross(z, from_origin);
            spanned(cross(tangent, z), tangent).filter(|_| is_off_axis(&tangent, &from_origin)).unwrap_or(self.axes)
        };
        match self.kind {
            SystemKind::Rectangular => self.axes,
            SystemKind::Cylindrical => [radial, tangential, z],
            SystemKind::Spherical => match spanned(from_origin, cross(tangential, from_origin)) {
                Some([outward, polar, _]) => [outward, polar, tangential],
                None => self.axes,
            },
        }
    }
}

/// Whether a point is off the axis z: z × p is not just what rounding leaves.
fn is_off_axis(tangent: &[f64; 3], from_origin: &[f64; 3]) -> bool {
    let length = |vector: &[f64; 3]| vector.iter().map(|value| value * value).sum::<f64>().sqrt();
    length(tangent) > 8.0 * f64::EPSILON * length(from_origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Axes are the derivatives of a point by its coordinates.
    #[test]
    fn axes_are_those_in_which_the_coordinates_grow() {
        let (x, y) = ([1.0, 2.0, -0.5], [0.3, 0.4, 1.0]);
        let at = [2.5, 40.0, 70.0];
        for kind in [SystemKind::Rectangular, SystemKind::Cylindrical, SystemKind::Spherical] {
            let system = LocalSystem::new(kind, [3.0, -1.0, 2.0], x, y).expect("a system");
            let axes = system.axes_at(system.point(at));
            for (axis, expected) in axes.iter().enumerate() {
                // A step of 1e-6 of coordinates of size 1 to 70 leaves 1e-6 of curvature and 1e-9 of rounding.
                let step = 1e-6;
                let mut further = at;
                further[axis] += step;
                let [from, to] = [system.point(at), system.point(further)];
                let direction = crate::dofs::unit(std::array::from_fn(|i| to[i] - from[i]));
                for i in 0..3 {
                    assert!((direction[i] - expected[i]).abs() < 1e-5, "{kind:?} {axis}: {direction:?} {expected:?}");
                }
            }
        }
    }
}
