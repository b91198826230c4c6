//! Whether the interface can react every rigid-body motion.
//!
//! K_II is singular exactly when some motion without energy leaves the interface at rest, that is when
//! rank(U_B) < n_r. This is seen on an n_B × n_r matrix before anything is factored, and the motion can be named.

use faer::Mat;

use super::rigid_body_modes::RigidBodyModes;
use crate::dense;
use crate::dofs::gyration;
use crate::error::{Error, Result};
use crate::model::{Finding, ONE_PLACE, Site};
use crate::partition::{DofOrigin, Partition};
use crate::sparse::diagonal;

/// Below this ratio of singular values the interface does not react a motion.
const RANK_TOLERANCE: f64 = 1e-10;
/// Below this ratio the interface reacts it badly: digits are lost in K_II, and the report warns.
pub const ILL_CONDITIONED: f64 = 1e-2;

/// How well the interface reacts the rigid-body motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterfaceRank {
    /// Smallest over largest singular value of U_B, rotations scaled to the size of the component; one without rigid modes
    /// or without interface.
    pub singular_ratio: f64,
}

/// Checks rank(U_B) = n_r.
///
/// # Errors
/// A rigid-body motion leaves the interface at rest; the message names it.
pub fn interface_rank(partition: &Partition, rigid: &RigidBodyModes) -> Result<InterfaceRank> {
    rank_within(partition, rigid, RANK_TOLERANCE)
}

/// The rank of all motions without energy as the matrices tell them, mechanisms among them, which rounding turns as the digits of K turn
/// rigid-body motions.
///
/// # Errors
/// A motion leaves the interface at rest; the message names it.
pub fn rank_of_every(
    partition: &Partition,
    (rigid, every): (&RigidBodyModes, &RigidBodyModes),
) -> Result<InterfaceRank> {
    rank_within(partition, every, rigid.energy.angle.max(RANK_TOLERANCE))
}

/// Why K_II could not be factored: the interface, where it reacts a motion so badly that few digits leave nothing of that in
/// K_II, or else the error itself.
pub fn or_lack_of_rank(error: Error, partition: &Partition, rigid: &RigidBodyModes) -> Error {
    match error {
        Error::DigitsTooFew { .. } => rank_within(partition, rigid, ILL_CONDITIONED).err().unwrap_or(error),
        error => error,
    }
}

/// The rank of U_B by singular values above a share of the largest.
pub(super) fn rank_within(partition: &Partition, rigid: &RigidBodyModes, tolerance: f64) -> Result<InterfaceRank> {
    let (n_i, n_b, n_r) = (partition.n_internal, partition.n_interface(), rigid.count());
    // Without an interface nothing has to be reacted: the modes are those of the free component.
    if n_r == 0 || n_b == 0 {
        return Ok(InterfaceRank { singular_ratio: 1.0 });
    }
    // Motions of unit length, not of unit mass: a seismic mass would make its own motions small.
    let unit = unit_motions(partition, rigid)?;
    let scale = scales(partition);
    let u_b = Mat::from_fn(n_b.max(n_r), n_r, |i, j| if i < n_b { unit[(n_i + i, j)] * scale[n_i + i] } else { 0.0 });
    let (singular, v) = dense::right_singular(u_b.as_ref())?;
    let largest = singular.first().copied().unwrap_or(0.0);
    // Supports may leave no other motion to compare with: then one that moves the interface is as large there as anywhere.
    let anywhere = 1.0 / (partition.n_dofs() as f64).sqrt();
    let rank = singular.iter().filter(|value| **value > tolerance * largest.max(anywhere)).count();
    if rank < n_r {
        let free = unit.as_ref() * v.as_ref().subcols(n_r - 1, 1);
        let mut motion = match partition.sites() {
            Some(sites) => describe(&sites, dense::column(free.as_ref(), 0)),
            None => free_particles(partition),
        };
        if tolerance > RANK_TOLERANCE {
            let ratio = singular[n_r - 1] / largest;
            motion += &format!(
                "; the weakest {ratio:.1e} times as well as the strongest, which the digits of the stiffness do not tell from not at all"
            );
        }
        let (has_coordinates, uncertain) = (partition.sites().is_some(), partition.uncertain());
        return Err(Error::InterfaceRank {
            rank,
            n_rigid: n_r,
            motion,
            has_coordinates,
            uncertain,
            unloaded: Vec::new(),
        });
    }
    Ok(InterfaceRank { singular_ratio: singular[n_r - 1] / largest })
}

/// What each dof is multiplied by to be compared with others: a rotation by the size of the component.
pub(crate) fn scales(partition: &Partition) -> Vec<f64> {
    let of_one_place = |sites: &[Option<Site>]| {
        let directions = sites.iter().map(|site| site.map(|site| site.direction));
        gyration(directions.zip(diagonal(&partition.mass)))
    };
    let size = partition.sites().and_then(|sites| extent(&sites).or_else(|| of_one_place(&sites))).unwrap_or(1.0);
    let stiffness = diagonal(&partition.stiffness);
    let scale = |dof: usize| match (partition.dofs[dof].origin, partition.dofs[dof].site) {
        (_, Some(site)) if site.direction.is_rotation() => size,
        // Distortions of patches are displacements.
        (DofOrigin::Distortion(..), _) | (_, Some(_)) => 1.0,
        // Without coordinates nothing tells a rotation from a translation; their stiffness makes them alike.
        _ => 1.0 / dense::power_of_two_root(stiffness[dof]),
    };
    (0..partition.n_dofs()).map(scale).collect()
}

/// The rigid-body modes as motions that are orthogonal and of unit length over all dofs in their [`scales`].
pub(crate) fn unit_motions(partition: &Partition, rigid: &RigidBodyModes) -> Result<Mat<f64>> {
    let scale = scales(partition);
    let mut unit = rigid.orthonormal.clone();
    // The second pass removes what rounding of the first left of lengths that differ by many orders.
    for _ in 0..2 {
        let scaled = Mat::from_fn(unit.nrows(), unit.ncols(), |i, j| unit[(i, j)] * scale[i]);
        let lengths: Vec<f64> = (0..scaled.ncols()).map(|j| dense::norm(dense::column(scaled.as_ref(), j))).collect();
        let even = Mat::from_fn(scaled.nrows(), scaled.ncols(), |i, j| scaled[(i, j)] / lengths[j]);
        let (squares, directions) = dense::symmetric_eigen(dense::gram(even.as_ref(), even.as_ref()).as_ref())?;
        let turn = Mat::from_fn(lengths.len(), lengths.len(), |i, j| {
            directions[(i, j)] / (lengths[i] * squares[j].max(f64::EPSILON).sqrt())
        });
        unit = dense::product(unit.as_ref(), turn.as_ref());
    }
    Ok(unit)
}

/// Rows that nothing ties to others, in words: of motions without coordinates nothing else can be said.
fn free_particles(partition: &Partition) -> String {
    let mut findings = partition.model.findings.iter();
    let particles = findings.find(|finding| matches!(finding, Finding::FreeParticles { .. }));
    particles.map_or_else(String::new, |particles| format!("; {particles}"))
}

/// The diagonal of the box around all sites; none where they are one place but for rounding, which is no size to turn rotations into
/// displacements by.
fn extent(sites: &[Option<Site>]) -> Option<f64> {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for site in sites.iter().flatten() {
        for axis in 0..3 {
            low[axis] = low[axis].min(site.position[axis]);
            high[axis] = high[axis].max(site.position[axis]);
        }
    }
    let size = (0..3).map(|axis| (high[axis] - low[axis]).powi(2)).sum::<f64>().sqrt();
    let far = low.iter().chain(&high).fold(0.0f64, |far, x| far.max(x.abs()));
    (size > ONE_PLACE * far).then_some(size)
}

/// Puts a rigid motion into words: the axis it turns about, or the direction it moves in.
fn describe(sites: &[Option<Site>], motion: &[f64]) -> String {
    let Some([t, r]) = fit(sites, motion) else {
        return String::new();
    };
    let (turning, moving) = (length(r), length(t));
    let size = extent(sites).unwrap_or(1.0);
    if turning * size <= 1e-6 * moving {
        let [x, y, z] = t.map(|value| value / moving);
        return format!("; free: translation along ({x:.3}, {y:.3}, {z:.3})");
    }
    let axis = r.map(|value| value / turning);
    // The point of the axis nearest the origin: (θ × t) / θ².
    let cross = [r[1] * t[2] - r[2] * t[1], r[2] * t[0] - r[0] * t[2], r[0] * t[1] - r[1] * t[0]];
    let point = cross.map(|value| value / (turning * turning));
    let show = |values: [f64; 3]| {
        // What rounds to zero has no sign.
        let [x, y, z] = values.map(|value| (value * 1e4).round() / 1e4 + 0.0);
        format!("({x:.4}, {y:.4}, {z:.4})")
    };
    format!("; free: rotation about the axis through {} along {}", show(point), show(axis))
}

/// Translation and rotation about the origin that make up a rigid motion, by least squares.
fn fit(sites: &[Option<Site>], motion: &[f64]) -> Option<[[f64; 3]; 2]> {
    // Only the part that moves takes part: a motion of one body of several is zero elsewhere, but for rounding.
    let least = 1e-9 * motion.iter().fold(0.0f64, |max, value| max.max(value.abs()));
    let moving = sites.iter().zip(motion).filter(|(_, motion)| motion.abs() > least);
    let moving: Vec<(Site, f64)> = moving.filter_map(|(site, motion)| Some(((*site)?, *motion))).collect();
    if moving.len() < 6 {
        return None;
    }
    let a = Mat::from_fn(moving.len(), 6, |i, j| moving[i].0.rigid_motion()[j]);
    let b = Mat::from_fn(moving.len(), 1, |i, _| moving[i].1);
    // A rotation about an axis through all moving dofs moves none of them: the least squares solution of least norm is the
    // one that leaves it out.
    let svd = a.thin_svd().ok()?;
    let singular = svd.S().column_vector();
    let along = svd.U().transpose() * &b;
    let floor = RANK_TOLERANCE * singular[0];
    let weights = Mat::from_fn(6, 1, |i, _| if singular[i] > floor { along[(i, 0)] / singular[i] } else { 0.0 });
    let x = svd.V() * &weights;
    let part = |start: usize| [x[(start, 0)], x[(start + 1, 0)], x[(start + 2, 0)]];
    Some([part(0), part(3)])
}

fn length(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}
