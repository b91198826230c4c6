//! Mass properties and the loads of gravity: M-16, M-18.

use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, MatRef};
use supel_runtime::{Coordinate, MassProperties, RigidBodyModes, Superelement, mass_properties};

use super::content::Content;
use super::rigid_motion::is_nearly_unit;
use crate::dense::{self, NOISE_FACTOR, unpacked};
use crate::partition::Partition;
use crate::verification::check::{Check, Limits};
use crate::verification::{self, mass_difference};

/// M-16: ÛᵀM̂Û against the rigid-body mass of the full model.
pub(super) fn rigid_body_mass(content: &Content<'_>) -> Option<Check> {
    if content.n_rigid() == 0 {
        return None;
    }
    let u = content.u.as_ref();
    let reduced = dense::gram(u, dense::product(content.m.as_ref(), u).as_ref());
    let (value, (i, j)) = mass_difference(reduced.as_ref(), content.m_f.as_ref());
    let limits = Limits { engineering: 1e-10, arithmetic: rounding(content), data: 0.0 }.capped(1e-6, 0.0);
    Some(Check {
        id: "M-16",
        name: "mass, centre and inertia are preserved",
        equation: "max |ÛᵀM̂Û − M_F|_ij / √(M_F,ii M_F,jj)",
        value,
        limits,
        fail_above: 100.0 * limits.value(),
        worst: (value > 0.0).then(|| format!("rigid-body modes {} and {}", i + 1, j + 1)),
    })
}

/// Rounding of ÛᵀM̂Û: an interface that is small for its component holds large masses on long levers, which cancel.
fn rounding(content: &Content<'_>) -> f64 {
    let (m, u) = (&content.m, &content.u);
    let terms = |j: usize| {
        let of_row = |i: usize| (0..m.ncols()).map(|k| m[(i, k)].abs() * u[(k, j)].abs()).sum::<f64>();
        (0..m.nrows()).map(|i| u[(i, j)].abs() * of_row(i)).sum::<f64>()
    };
    NOISE_FACTOR * f64::EPSILON * (0..u.ncols()).map(|j| terms(j) / content.m_f[(j, j)]).fold(0.0, f64::max)
}

/// Whether Û begins with the six unit motions of the body. Mechanisms come behind them.
fn has_unit_motions(content: &Content<'_>) -> bool {
    let metadata = content.superelement.metadata();
    let is_unit = metadata.model.rigid_body_modes == RigidBodyModes::Geometric || is_nearly_unit(content);
    is_unit && content.n_rigid() >= 6
}

/// ÛᵀM̂Û of the six motions of the body, where Û is unit motions.
fn mass_of_unit_motions(content: &Content<'_>) -> Option<Mat<f64>> {
    has_unit_motions(content).then(|| {
        let u = content.u.as_ref().subcols(0, 6);
        dense::gram(u, dense::product(content.m.as_ref(), u).as_ref())
    })
}

/// Mass properties by M̂ and Û, where Û is the six unit motions.
fn properties(content: &Content<'_>) -> Option<MassProperties> {
    properties_of(mass_of_unit_motions(content)?.as_ref())
}

/// Mass properties of the six unit motions, 6 × 6.
fn properties_of(m_f: MatRef<'_, f64>) -> Option<MassProperties> {
    mass_properties(&supel_runtime::Matrix::from_fn(6, 6, |i, j| m_f[(i, j)]))
}

/// Whether the first six motions of a rigid-body mass are those of one mass with one centre, which has mass properties.
pub(super) fn is_of_a_body(m_f: MatRef<'_, f64>) -> bool {
    let (n_rigid, m_f) = (m_f.ncols(), |i: usize, j: usize| m_f[(i, j)]);
    n_rigid >= 6 && mass_properties(&supel_runtime::Matrix::from_fn(6, 6, m_f)).is_some()
}

/// M-16: what Û moves is a body. Roundings of few digits in M are in M̂, and nothing in a file tells how many there were.
pub(super) fn of_a_body(content: &Content<'_>) -> Option<Check> {
    mass_of_unit_motions(content).map(|m_f| verification::of_a_body(m_f.as_ref(), &verification::ALL_AXES, 0.0))
}

/// M-16: the inertia of what Û moves is one that a body can have, where it moves one.
pub(super) fn of_inertia(content: &Content<'_>) -> Option<Check> {
    verification::of_inertia(mass_of_unit_motions(content)?.as_ref(), 0.0, 0.0)
}

/// The radius of gyration: the length that a shift of the centre is compared with.
fn gyration(properties: &MassProperties) -> f64 {
    let inertia = properties.inertia;
    ((inertia[0][0] + inertia[1][1] + inertia[2][2]) / (2.0 * properties.mass)).sqrt()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    dense::norm(&[a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

fn described(properties: &MassProperties) -> String {
    let [x, y, z] = properties.center_of_mass;
    format!("mass {:.6e}, centre ({x:.4e}, {y:.4e}, {z:.4e})", properties.mass)
}

/// M-16: the mass properties that the file states in words, by its rigid-body mass: that this is the one of M̂ is a check of its own. Of a
/// preloaded component that has the mass alone.
pub(super) fn stated(content: &Content<'_>) -> Option<Check> {
    let stated = content.superelement.metadata().model.mass_properties?;
    if content.is_preloaded() {
        return stated_mass(content, &stated);
    }
    let m_f = has_unit_motions(content).then(|| content.m_f.as_ref().submatrix(0, 0, 6, 6));
    Some(compared("stated mass properties are those of M_F", &stated, m_f.and_then(properties_of)))
}

/// M-16: the mass properties that the file of a preloaded component states, by all rows of the model.
pub(super) fn stated_of_model(superelement: &Superelement, partition: &Partition) -> Option<Check> {
    let (stated, m_f) = (superelement.metadata().model.mass_properties?, partition.mass_of_preloaded_body()?);
    let m_f = m_f * faer::Scale(partition.scaling.mass_unit());
    Some(compared("stated mass properties are those of the model", &stated, properties_of(m_f.as_ref())))
}

fn compared(name: &'static str, stated: &MassProperties, found: Option<MassProperties>) -> Check {
    // The inertia about the centre is what is left of that about the origin, which may be far away, and of m c²: two numbers
    // of the size of the first, in the words of the file and here.
    let remoteness = |found: &MassProperties| distance(found.center_of_mass, [0.0; 3]) / gyration(found);
    let cancelled = found.as_ref().map_or(0.0, |found| 4.0 * (1.0 + remoteness(found).powi(2)));
    let limits = Limits { engineering: 1e-11, arithmetic: NOISE_FACTOR * f64::EPSILON * cancelled, data: 0.0 };
    let value = found.as_ref().map_or(f64::NAN, |found| {
        let size = gyration(found);
        let inertia = (0..9).map(|k| (found.inertia[k / 3][k % 3] - stated.inertia[k / 3][k % 3]).abs());
        let scale = found.mass * size * size;
        dense::worst([
            (found.mass / stated.mass - 1.0).abs(),
            distance(found.center_of_mass, stated.center_of_mass) / size,
            dense::worst(inertia) / scale,
        ])
    });
    let limits = limits.capped(1.0, 0.0);
    Check {
        id: "M-16",
        name,
        equation: "max |m/m_stated − 1|, |c − c_stated| / i, |J − J_stated| / (m i²), i radius of gyration",
        value,
        limits,
        fail_above: 10.0 * limits.value(),
        worst: found.as_ref().map(described),
    }
}

/// M-16: the mass that the file of a preloaded component states, by its translations; none where its interface does not tell these.
fn stated_mass(content: &Content<'_>, stated: &MassProperties) -> Option<Check> {
    let translations = unit_translations(content)?;
    let inertia =
        dense::gram(translations.as_ref(), dense::product(content.m_f.as_ref(), translations.as_ref()).as_ref());
    Some(Check {
        id: "M-16",
        name: "stated mass is that of translations",
        equation: "max |aᵀM_F a / m_stated − 1|, Û a unit translations",
        value: dense::worst((0..3).map(|axis| (inertia[(axis, axis)] / stated.mass - 1.0).abs())),
        limits: Limits { engineering: 1e-8, ..Limits::default() },
        fail_above: 1e-6,
        worst: None,
    })
}

/// Unit translations of the interface nodes, n_B × 3; none where no node is known or the interface has too few dofs to tell.
fn unit_fields(content: &Content<'_>) -> Option<Mat<f64>> {
    let (n_b, metadata) = (content.n_b, content.superelement.metadata());
    if metadata.interface_nodes.is_empty() || n_b < content.n_rigid() || content.holds_dofs() {
        return None;
    }
    let is_along = |coordinate: &Coordinate, axis: usize| match coordinate {
        Coordinate::Interface { direction, .. } => *direction as usize == axis,
        _ => false,
    };
    let entry = |i: usize, axis: usize| f64::from(u8::from(is_along(&metadata.coordinates[i], axis)));
    Some(Mat::from_fn(n_b, 3, entry))
}

/// A with Û A the unit translations of the interface nodes, n_r × 3, where Û has them among its combinations.
fn unit_translations(content: &Content<'_>) -> Option<Mat<f64>> {
    let unit = unit_fields(content)?;
    Some(content.u.as_ref().subrows(0, content.n_b).qr().solve_lstsq(&unit))
}

/// A of a component with mechanisms, as [`unit_translations`]; none where the interface does not tell all motions apart or Û lacks one of the
/// three translations.
fn translations_with_mechanisms(content: &Content<'_>) -> Option<Mat<f64>> {
    /// Motions that the interface sees by less are not told apart.
    const LEAST_SEEN: f64 = 1e-6;
    /// Of a unit translation, where Û has it: digits of zero modes.
    const SAME: f64 = 1e-10;
    if content.n_rigid() <= 6 || content.is_attached() {
        return None;
    }
    let (unit, combination) = (unit_fields(content)?, unit_translations(content)?);
    let u_b = content.u.as_ref().subrows(0, content.n_b);
    let singular = u_b.singular_values().ok()?;
    let is_told = *singular.last()? > LEAST_SEEN * singular.first()?;
    let mut left = unit.clone();
    dense::add_product(left.as_mut(), -1.0, u_b, combination.as_ref());
    let is_had = |j: usize| dense::norm(dense::column(unit.as_ref(), j)) > 0.0;
    (is_told && (0..3).all(is_had) && left.norm_max() < SAME).then_some(combination)
}

/// M-16: the mass properties that the job kept in the file expects.
pub(super) fn expected(content: &Content<'_>) -> Option<Check> {
    let expect = content.job()?.model.expect.as_ref()?;
    let found = properties(content)?;
    let mass = expect.mass.map_or(0.0, |known| (found.mass / known - 1.0).abs());
    let shift = expect.cg.map_or(0.0, |known| distance(found.center_of_mass, known) / gyration(&found));
    Some(Check {
        id: "M-16",
        name: "mass and centre are those expected",
        equation: "max |m/m_expected − 1|, |c − c_expected| / radius of gyration",
        value: dense::worst([mass, shift]),
        limits: Limits { engineering: 1e-4, ..Limits::default() },
        fail_above: 1e-2,
        worst: Some(described(&found)),
    })
}

/// M-18: gravity accelerates the component as a rigid body, so that its loads are those of the unit translations.
pub(super) fn gravity(content: &Content<'_>) -> Option<Check> {
    /// Of the columns of Ψ, as M-11 has it, and so of the terms of M̂Û_t: an interface that is small for its component holds large masses on
    /// long levers, of which the loads of a translation are what is left.
    const OF_TERMS: f64 = 1e-12;
    const FAIL: f64 = 1e-8;
    /// Where Û has no more digits than zero modes of the matrices have.
    const FAIL_OF_ZERO_MODES: f64 = 1e-6;
    let gravity = unpacked(content.superelement.tensors().gravity.as_ref()?);
    let is_classical = content.superelement.metadata().model.rigid_body_modes == RigidBodyModes::Geometric;
    // Held dofs take part in the loads of gravity through the mass that couples them, and in M̂ they do not.
    let (translations, fail_above) = match content.is_preloaded() {
        true => (dense::product(content.u.as_ref(), unit_translations(content)?.as_ref()), FAIL),
        false if content.holds_dofs() => return None,
        false if is_classical && content.n_rigid() == 6 => (content.u.as_ref().subcols(0, 3).to_owned(), FAIL),
        false => {
            let combination = translations_with_mechanisms(content)?;
            (dense::product(content.u.as_ref(), combination.as_ref()), FAIL_OF_ZERO_MODES)
        }
    };
    let momenta = dense::product(content.m.as_ref(), translations.as_ref());
    let terms =
        dense::product(dense::absolute(content.m.as_ref()).as_ref(), dense::absolute(translations.as_ref()).as_ref());
    let (mut worst, mut cancelled) = ((0.0, None), 0.0_f64);
    for j in 0..3 {
        let (stored, rebuilt) = (dense::column(gravity.as_ref(), j), dense::column(momenta.as_ref(), j));
        let difference: Vec<f64> = stored.iter().zip(rebuilt).map(|(a, b)| a - b).collect();
        // A model in a plane has no loads across it.
        let error = match content.force_norm(&difference) {
            0.0 => 0.0,
            error => error / content.force_norm(rebuilt),
        };
        if error > 0.0 {
            cancelled =
                cancelled.max(content.force_norm(dense::column(terms.as_ref(), j)) / content.force_norm(rebuilt));
        }
        if dense::worse(error, worst.0) {
            worst = (error, Some(format!("along {}", ["x", "y", "z"][j])));
        }
    }
    let limits = Limits { engineering: 1e-2 * fail_above, arithmetic: OF_TERMS * cancelled, data: 0.0 };
    let limits = limits.capped(1e-6, 0.0);
    Some(Check {
        id: "M-18",
        name: "loads of gravity are those of M̂",
        equation: "max ‖g − M̂Û_t‖ / ‖M̂Û_t‖ over unit fields, Û_t unit translations",
        value: worst.0,
        limits,
        fail_above: fail_above.max(10.0 * limits.value()),
        worst: worst.1,
    })
}
