//! Coordinate systems: where a point is, and along which axes displacements at it are.

use super::in_line::{Off, half_unit};
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

    pub(super) fn new(kind: SystemKind, origin: [f64; 3], axes: Axes) -> Self {
        Self { kind, origin, axes }
    }

    /// With z from the first point to the second and the third in the half plane of x and z; none where the points, which are off by as
    /// much, may be in line.
    pub(super) fn by_points(kind: SystemKind, [a, b, c]: [[f64; 3]; 3], off: Off) -> Option<Self> {
        let between = |to: [f64; 3]| std::array::from_fn(|i| to[i] - a[i]);
        let [z, x, y] = off.spanned(between(b), between(c))?;
        Some(Self { kind, origin: a, axes: [x, y, z] })
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

    /// By how much the point of these coordinates may be off in the model.
    pub(super) fn off(&self, coordinates: [f64; 3]) -> Off {
        let point = self.point(coordinates);
        let of_digits = |axis: usize| {
            let mut other = coordinates;
            other[axis] += half_unit(coordinates[axis]);
            self.point(other).iter().zip(point).fold(0.0_f64, |off, (there, here)| off.max((there - here).abs()))
        };
        Off::of_point(point, self.origin, (0..3).map(of_digits).fold(0.0, f64::max))
    }

    /// The axes of displacements at a point of the model: those of the system, or radial, tangential and along z, or radial, in the
    /// direction of the angle from z and in that about z. On the axis z the angle about it is that of x.
    pub(super) fn axes_at(&self, point: [f64; 3]) -> Axes {
        let from_origin: [f64; 3] = std::array::from_fn(|i| point[i] - self.origin[i]);
        let z = self.axes[2];
        let off = Off::of_point(point, self.origin, 0.0);
        // About z by the angle of the point: its radial direction and the one across.
        let [radial, tangential, _] = {
            let tangent = cross(z, from_origin);
            spanned(cross(tangent, z), tangent).filter(|_| off.tells(tangent)).unwrap_or(self.axes)
        };
        match self.kind {
            SystemKind::Rectangular => self.axes,
            SystemKind::Cylindrical => [radial, tangential, z],
            SystemKind::Spherical => match spanned(from_origin, cross(tangential, from_origin)) {
                Some([outward, polar, _]) if off.tells(from_origin) => [outward, polar, tangential],
                _ => self.axes,
            },
        }
    }
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
            let system = LocalSystem::new(kind, [3.0, -1.0, 2.0], spanned(x, y).expect("axes"));
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

    /// On the axis but for rounding the angle about it is none: the point has the axes of one that is there exactly.
    #[test]
    fn a_point_on_the_axis_but_for_rounding_has_the_axes_of_the_system() {
        let axes = spanned([0.3, 0.4, 1.0], [1.0, 2.0, -0.5]).expect("axes");
        for kind in [SystemKind::Cylindrical, SystemKind::Spherical] {
            let system = LocalSystem::new(kind, [300.1, -100.7, 200.3], axes);
            for along in [0.0, 1e-13, 0.01, 7.0] {
                let found = system.axes_at(system.point(if kind == SystemKind::Spherical {
                    [along, 0.0, 0.0]
                } else {
                    [0.0, 0.0, along]
                }));
                let expected = match kind {
                    SystemKind::Spherical if along > 1e-3 => [axes[2], axes[0], axes[1]],
                    _ => axes,
                };
                for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
                    // Rounding of 300 in a length of 0.01.
                    assert!((found - expected).abs() < 1e-10, "{kind:?} {along}: {found} {expected}");
                }
            }
        }
    }
}
