//! A cylinder or a sphere fitted to the nodes of a patch.
//!
//! ```text
//! x_i          nodes, relative to their mean and in units of their distance from it
//! d_i          distance of a node from the axis of the cylinder, or from the centre of the sphere
//! min Σ (d_i − r)²     over the axis or centre and r, by Gauss-Newton steps from the fits that are linear
//! ```
//! The sphere starts from |x|² = 2 c·x + (r² − c²), which is linear in c and r² − c². So does the circle that a cylinder along a given
//! direction shows; that direction is tried all over a half sphere. Nodes in one plane take its normal.

use faer::Mat;
use serde::Serialize;
use supel_runtime::motion::cross;

use crate::dense;

/// Largest distance of a node from the surface, as a share of the radius. The nodes between the corners of straight edges, eight around a
/// hole, are 0.038 off the radius between theirs and that of the corners.
pub(super) const LARGEST_RESIDUAL: f64 = 0.05;
/// Least singular value of the distances' derivatives, relative to the largest, at which nodes determine a fit. A tenth of a degree of
/// tilt is as much as this of the radius at a hole as long as a hundredth of it, or at an arc of ten degrees.
const DETERMINED: f64 = 1e-3;
/// Thickness of nodes in one plane, relative to their distance from their mean: rounding of coordinates with five digits.
const FLAT: f64 = 1e-5;
/// Directions tried all over a half sphere: neighbours are some 10° apart.
const N_DIRECTIONS: usize = 200;
/// Starting points that are followed, no two of them nearer than [`APART`].
const N_STARTS: usize = 6;
/// Cosine of 25°, between starting points.
const APART: f64 = 0.9;
/// Cosine of 2°: fits whose axes differ by more are different.
const ONE_AXIS: f64 = 0.9994;
/// Steps of the iteration, which doubles its digits each.
const MOST_STEPS: usize = 60;

/// What a patch's origin was fitted from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// Radius of the cylinder or the sphere, in the units of the model.
    pub radius: f64,
    /// Largest distance of a node from its surface, in the units of the model.
    pub residual: f64,
    /// Direction of the axis of the cylinder, of unit length; none for a sphere.
    pub axis: Option<[f64; 3]>,
}

/// The point that a fit gives, and the fit.
pub(crate) type Place = ([f64; 3], Fit);

/// The middle of a hole's axis along the extent of the nodes, or why there is none in words.
pub(crate) fn hole(points: &[[f64; 3]]) -> Result<Place, String> {
    let scaled = Scaled::of(points);
    let (singular, normals) = scaled.directions()?;
    let is_flat = singular[2] <= FLAT * singular[0];
    refuse_few(points, if is_flat { 4 } else { 6 })?;
    let cylinder = if is_flat { scaled.circle(normals[2]).ok_or_else(no_fit)? } else { scaled.cylinder(&normals)? };
    let along = || scaled.points.iter().map(|x| dot(*x, cylinder.axis));
    let middle = 0.5 * (along().fold(f64::INFINITY, f64::min) + along().fold(f64::NEG_INFINITY, f64::max));
    let foot = dot(cylinder.foot, cylinder.axis);
    let centre = std::array::from_fn(|i| cylinder.foot[i] + (middle - foot) * cylinder.axis[i]);
    let fit = scaled.fit((cylinder.radius, cylinder.residual(&scaled.points)), Some(upward(cylinder.axis)))?;
    Ok((scaled.place(centre), fit))
}

/// The centre of a sphere, or why there is none in words.
pub(crate) fn sphere(points: &[[f64; 3]]) -> Result<Place, String> {
    refuse_few(points, 5)?;
    let scaled = Scaled::of(points);
    let x = &scaled.points;
    let a = Mat::from_fn(x.len(), 4, |i, j| if j < 3 { 2.0 * x[i][j] } else { 1.0 });
    refuse_undetermined(&a)?;
    let start = dense::least_squares(a.as_ref(), column(x.iter().map(|x| dot(*x, *x))).as_ref());
    let mut centre = [0, 1, 2].map(|j| start[(j, 0)]);
    let mut radius = (start[(3, 0)] + dot(centre, centre)).max(0.0).sqrt();
    for _ in 0..MOST_STEPS {
        let away: Vec<[f64; 3]> = x.iter().map(|x| minus(*x, centre)).collect();
        let j = Mat::from_fn(x.len(), 4, |i, j| if j < 3 { -away[i][j] / length(away[i]) } else { -1.0 });
        refuse_undetermined(&j)?;
        let step = dense::least_squares(j.as_ref(), column(away.iter().map(|away| radius - length(*away))).as_ref());
        (0..3).for_each(|i| centre[i] += step[(i, 0)]);
        radius += step[(3, 0)];
        if is_converged(&step) {
            break;
        }
    }
    let residual = dense::worst(x.iter().map(|x| (length(minus(*x, centre)) - radius).abs()));
    Ok((scaled.place(centre), scaled.fit((radius, residual), None)?))
}

/// Points about their mean, in units of their root mean square distance from it.
struct Scaled {
    points: Vec<[f64; 3]>,
    mean: [f64; 3],
    unit: f64,
}

impl Scaled {
    fn of(points: &[[f64; 3]]) -> Self {
        let n = points.len() as f64;
        let mean = std::array::from_fn(|i| points.iter().map(|point| point[i] / n).sum());
        let centred: Vec<[f64; 3]> = points.iter().map(|point| minus(*point, mean)).collect();
        let square: f64 = centred.iter().map(|point| dot(*point, *point) / n).sum();
        let unit = if square > 0.0 { square.sqrt() } else { 1.0 };
        Self { points: centred.into_iter().map(|point| point.map(|x| x / unit)).collect(), mean, unit }
    }

    fn place(&self, point: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.mean[i] + self.unit * point[i])
    }

    /// Extents of the points and their directions, the largest first; points in line are refused.
    fn directions(&self) -> Result<(Vec<f64>, [[f64; 3]; 3]), String> {
        let rows = self.points.len().max(3);
        let all = Mat::from_fn(rows, 3, |i, j| self.points.get(i).map_or(0.0, |point| point[j]));
        let (singular, v) = dense::right_singular(all.as_ref()).map_err(|_| no_fit())?;
        if singular[1] <= FLAT * singular[0] {
            return Err("nodes in line".to_owned());
        }
        Ok((singular, [0, 1, 2].map(|j| [0, 1, 2].map(|i| v[(i, j)]))))
    }

    /// The circle that the points show along a direction, as a cylinder.
    fn circle(&self, axis: [f64; 3]) -> Option<Cylinder> {
        let [e, f] = across(axis);
        let plane: Vec<[f64; 2]> = self.points.iter().map(|x| [dot(*x, e), dot(*x, f)]).collect();
        let a = Mat::from_fn(plane.len(), 3, |i, j| if j < 2 { 2.0 * plane[i][j] } else { 1.0 });
        let start = dense::least_squares(a.as_ref(), column(plane.iter().map(|[y, z]| y * y + z * z)).as_ref());
        let (y, z) = (start[(0, 0)], start[(1, 0)]);
        let foot = std::array::from_fn(|i| y * e[i] + z * f[i]);
        let cylinder = Cylinder { axis, foot, radius: (start[(2, 0)] + y * y + z * z).sqrt() };
        cylinder.followed(&self.points, Tilt::Held)
    }

    /// The cylinder of the least residual, from directions all over a half sphere.
    fn cylinder(&self, principal: &[[f64; 3]; 3]) -> Result<Cylinder, String> {
        let spread = (0..N_DIRECTIONS).map(|k| {
            // A spiral of equal areas, the golden angle from one direction to the next.
            let height = (k as f64 + 0.5) / N_DIRECTIONS as f64;
            let (sin, cos) = (k as f64 * std::f64::consts::PI * (3.0 - 5f64.sqrt())).sin_cos();
            let radius = (1.0 - height * height).sqrt();
            [radius * cos, radius * sin, height]
        });
        let circles = principal.iter().copied().chain(spread).filter_map(|axis| self.circle(axis));
        let mut tried: Vec<(f64, Cylinder)> = circles.map(|found| (found.residual(&self.points), found)).collect();
        tried.sort_by(|a, b| (a.0 / a.1.radius).total_cmp(&(b.0 / b.1.radius)));
        let mut starts: Vec<Cylinder> = Vec::new();
        for (_, cylinder) in tried {
            if starts.len() < N_STARTS && starts.iter().all(|other| dot(other.axis, cylinder.axis).abs() < APART) {
                starts.push(cylinder);
            }
        }
        let mut found: Vec<Cylinder> =
            starts.into_iter().filter_map(|start| start.followed(&self.points, Tilt::Free)).collect();
        let share = |cylinder: &Cylinder| cylinder.residual(&self.points) / cylinder.radius;
        found.sort_by(|a, b| share(a).total_cmp(&share(b)));
        let best = *found.first().ok_or_else(no_fit)?;
        let mut others = found.iter().take_while(|other| share(other) <= LARGEST_RESIDUAL);
        if others.any(|other| dot(other.axis, best.axis).abs() < ONE_AXIS) {
            return Err("nodes that lie on cylinders of different axes".to_owned());
        }
        Ok(best)
    }

    fn fit(&self, (radius, residual): (f64, f64), axis: Option<[f64; 3]>) -> Result<Fit, String> {
        let share = residual / radius;
        if share.is_nan() || share > LARGEST_RESIDUAL {
            return Err(format!("a node {} of the radius off", crate::number::quantity(share, 2)));
        }
        Ok(Fit { radius: self.unit * radius, residual: self.unit * residual, axis })
    }
}

/// Whether the direction of a cylinder is sought.
#[derive(Clone, Copy, PartialEq)]
enum Tilt {
    Free,
    Held,
}

#[derive(Clone, Copy, Debug)]
struct Cylinder {
    axis: [f64; 3],
    /// A point of the axis.
    foot: [f64; 3],
    radius: f64,
}

impl Cylinder {
    /// From the axis to a point, across it.
    fn away(&self, point: [f64; 3]) -> [f64; 3] {
        let from = minus(point, self.foot);
        let along = dot(from, self.axis);
        std::array::from_fn(|i| from[i] - along * self.axis[i])
    }

    /// The largest distance of a point from the surface.
    fn residual(&self, points: &[[f64; 3]]) -> f64 {
        dense::worst(points.iter().map(|point| (length(self.away(*point)) - self.radius).abs()))
    }

    /// The end of Gauss-Newton steps from here; none where the points do not determine it.
    fn followed(mut self, points: &[[f64; 3]], tilt: Tilt) -> Option<Self> {
        for _ in 0..MOST_STEPS {
            let [e, f] = across(self.axis);
            let rows: Vec<([f64; 5], f64)> = points.iter().map(|point| self.derivatives(*point, [e, f])).collect();
            let n_unknowns = if tilt == Tilt::Free { 5 } else { 3 };
            let j = Mat::from_fn(rows.len(), n_unknowns, |i, j| rows[i].0[j]);
            refuse_undetermined(&j).ok()?;
            let step = dense::least_squares(j.as_ref(), column(rows.iter().map(|row| row.1)).as_ref());
            let of = |k: usize| if k < n_unknowns { step[(k, 0)] } else { 0.0 };
            self.radius += of(2);
            for i in 0..3 {
                self.foot[i] += of(0) * e[i] + of(1) * f[i];
                self.axis[i] += (of(3) * e[i] + of(4) * f[i]) / self.radius;
            }
            let norm = length(self.axis);
            self.axis = self.axis.map(|x| x / norm);
            if is_converged(&step) {
                break;
            }
        }
        (self.radius.is_finite() && self.radius > 0.0).then_some(self)
    }

    /// Derivatives of r − d by the foot along e and f, the radius, and the tilt towards e and f times the radius; and d − r.
    fn derivatives(&self, point: [f64; 3], [e, f]: [[f64; 3]; 2]) -> ([f64; 5], f64) {
        let away = self.away(point);
        let distance = length(away);
        let along = dot(minus(point, self.foot), self.axis) / self.radius;
        let [y, z] = [dot(away, e) / distance, dot(away, f) / distance];
        ([y, z, 1.0, along * y, along * z], distance - self.radius)
    }
}

fn refuse_few(points: &[[f64; 3]], least: usize) -> Result<(), String> {
    let found = || crate::number::counted(points.len(), "node", "nodes");
    if points.len() < least { Err(format!("{} where a fit that can be judged takes {least}", found())) } else { Ok(()) }
}

fn refuse_undetermined(derivatives: &Mat<f64>) -> Result<(), String> {
    let determines = |singular: &[f64]| singular.last() >= singular.first().map(|first| DETERMINED * first).as_ref();
    match dense::right_singular(derivatives.as_ref()) {
        Ok((singular, _)) if determines(&singular) => Ok(()),
        _ => Err(no_fit()),
    }
}

fn no_fit() -> String {
    "nodes that determine none".to_owned()
}

/// A step below rounding of coordinates of order one.
fn is_converged(step: &Mat<f64>) -> bool {
    step.norm_max() < 8.0 * f64::EPSILON
}

/// Two unit vectors across a unit vector.
fn across(axis: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).min_by(|a, b| axis[*a].abs().total_cmp(&axis[*b].abs())).unwrap_or(0);
    let unit = std::array::from_fn(|i| if i == least { 1.0 } else { 0.0 });
    let e = cross(&axis, &unit);
    let norm = length(e);
    let e = e.map(|x| x / norm);
    [e, cross(&axis, &e)]
}

/// The one of the two unit vectors along an axis whose largest component is positive.
fn upward(axis: [f64; 3]) -> [f64; 3] {
    let largest = axis.into_iter().fold(0.0f64, |max, x| if x.abs() > max.abs() { x } else { max });
    axis.map(|x| if largest < 0.0 { -x } else { x })
}

fn column(values: impl ExactSizeIterator<Item = f64>) -> Mat<f64> {
    let values: Vec<f64> = values.collect();
    Mat::from_fn(values.len(), 1, |i, _| values[i])
}

fn length(v: [f64; 3]) -> f64 {
    dense::norm(&v)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    dense::dot(&a, &b)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Roundings of some tens of coordinates of order one, through a fit whose least singular value is a tenth.
    const ROUNDING: f64 = 1e3 * f64::EPSILON;
    const CENTRE: [f64; 3] = [3.0, -2.0, 7.0];

    /// Nodes on a cylinder about an oblique axis through [`CENTRE`], crowded on one side as a graded mesh has them.
    fn ring(heights: &[f64], share: f64) -> (Vec<[f64; 3]>, [f64; 3]) {
        let axis = [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0];
        let [e, f] = across(axis);
        let at = |height: f64, k: usize| -> [f64; 3] {
            let turn = k as f64 / 16.0;
            let (sin, cos) = (share * std::f64::consts::TAU * turn * turn).sin_cos();
            std::array::from_fn(|i| CENTRE[i] + height * axis[i] + 0.5 * (cos * e[i] + sin * f[i]))
        };
        (heights.iter().flat_map(|height| (0..16).map(move |k| at(*height, k))).collect(), axis)
    }

    fn assert_at(found: [f64; 3], expected: [f64; 3]) {
        assert!(length(minus(found, expected)) < ROUNDING * 8.0, "{found:?}, {expected:?}");
    }

    #[test]
    fn a_hole_has_its_axis_however_its_nodes_crowd() {
        for (heights, share) in [(&[-0.3, 0.1, 0.3][..], 1.0), (&[-0.3, 0.3], 0.4), (&[0.0], 1.0), (&[0.0], 0.4)] {
            let (points, axis) = ring(heights, share);
            let (place, fit) = hole(&points).expect("a hole");
            assert_at(place, CENTRE);
            assert!((fit.radius - 0.5).abs() < ROUNDING && fit.residual < ROUNDING, "{fit:?}");
            assert_at(fit.axis.expect("an axis"), axis);
        }
    }

    #[test]
    fn a_sphere_has_its_centre_from_a_part_of_it() {
        let (ring, _) = ring(&[0.1, 0.3, 0.4], 0.6);
        let on_sphere = |point: &[f64; 3]| -> [f64; 3] {
            let from = minus(*point, CENTRE);
            std::array::from_fn(|i| CENTRE[i] + 2.0 * from[i] / length(from))
        };
        let (place, fit) = sphere(&ring.iter().map(on_sphere).collect::<Vec<_>>()).expect("a sphere");
        assert_at(place, CENTRE);
        assert!((fit.radius - 2.0).abs() < ROUNDING && fit.residual < ROUNDING && fit.axis.is_none(), "{fit:?}");
    }

    #[test]
    fn nodes_that_determine_no_fit_are_said_to() {
        let (circle, _) = ring(&[0.0], 1.0);
        let cube: Vec<[f64; 3]> = (0..8).map(|k| [0, 1, 2].map(|axis| f64::from(k >> axis & 1))).collect();
        let line: Vec<[f64; 3]> = (0..8).map(|k| [f64::from(k); 3]).collect();
        let (mut dented, _) = ring(&[-0.3, 0.1, 0.3], 1.0);
        dented[5] = CENTRE;
        for (found, why) in [
            (hole(&circle[..3]), "3 nodes"),
            (hole(&line), "in line"),
            (hole(&cube), "different axes"),
            (hole(&dented), "off"),
            (sphere(&cube[..4]), "4 nodes"),
            (sphere(&circle), "determine none"),
            (sphere(&ring(&[-1.0, 0.0, 1.0], 1.0).0), "off"),
        ] {
            assert!(found.as_ref().is_err_and(|found| found.contains(why)), "{found:?}, expected {why}");
        }
    }
}
