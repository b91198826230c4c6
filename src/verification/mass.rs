//! Mass properties: M-16.

use faer::{Mat, MatRef};

use super::check::{Check, Limits, Verdict};
use super::evidence::{Evidence, NAMES, rigid_name};
use super::place::{ALL_AXES, Place};
use super::rigid_body::mass_difference;
use crate::dense::{self, NOISE_FACTOR};
use crate::job::Expectation;
use crate::model::{PartWeight, Supports, Weight};
use crate::number::quantity;
use crate::partition::Partition;

/// M-16: ÛᵀM̂Û against UᵀMU.
pub(super) fn preserved(evidence: &Evidence<'_>) -> Check {
    const FAIL: f64 = 1e-6;
    let reduction = evidence.reduction;
    let full = &reduction.rigid_body_mass;
    let u = reduction.rigid_body_modes.as_ref();
    let reduced = dense::gram(u, dense::product(reduction.mass.as_ref(), u).as_ref());
    let (value, (i, j)) = mass_difference(reduced.as_ref(), full.as_ref());
    let limits = Limits { engineering: 1e-10, arithmetic: rounding(evidence), data: 0.0 }.capped(FAIL, 0.0);
    let name = |i| rigid_name(evidence, i);
    Check {
        id: "M-16",
        name: "mass, centre and inertia are preserved",
        equation: "max |ÛᵀM̂Û − UᵀMU|_ij / √(M_F,ii M_F,jj)",
        value,
        limits,
        fail_above: FAIL,
        worst: (value > 0.0).then(|| if i == j { name(i) } else { format!("{} and {}", name(i), name(j)) }),
    }
}

/// Rounding of ÛᵀM̂Û: an interface that is small compared with the component holds large masses on long levers, which cancel.
fn rounding(evidence: &Evidence<'_>) -> f64 {
    let (m, u) = (&evidence.reduction.mass, &evidence.reduction.rigid_body_modes);
    let terms = |j: usize| {
        let of_row = |i: usize| (0..m.ncols()).map(|k| m[(i, k)].abs() * u[(k, j)].abs()).sum::<f64>();
        (0..m.nrows()).map(|i| u[(i, j)].abs() * of_row(i)).sum::<f64>()
    };
    let share = |j: usize| terms(j) / evidence.reduction.rigid_body_mass[(j, j)];
    NOISE_FACTOR * f64::EPSILON * (0..u.ncols()).map(share).fold(0.0, f64::max)
}

/// Deviation of a rigid-body mass from that of a body above which it has no mass properties: text of six digits leaves 10⁻⁶.
const LIKE_A_BODY: f64 = 1e-5;
/// Deviation at which the mass is no body's: with rows of M in another order masses differ by some hundredths and more.
const UNLIKE_A_BODY: f64 = 1e-3;

/// M-16: M_F = [m I, −m c̃; m c̃, J] in six unit motions, whatever the body is. Nothing else is one mass with one centre.
///
/// `axes` are those along which the model has translations, and `precision` is the relative size of the last digit of M. A direction with
/// another mass than the others comes of rows of M in another order than those of K, of mass that acts in one direction, and of wrong
/// coordinates.
pub(crate) fn of_a_body(m_f: MatRef<'_, f64>, axes: &[usize], precision: f64) -> Check {
    let mass = axes.iter().map(|&i| m_f[(i, i)]).sum::<f64>() / axes.len() as f64;
    let inertia = (m_f[(3, 3)] + m_f[(4, 4)] + m_f[(5, 5)]) / 3.0;
    let mut worst = (0.0, None);
    for &i in axes {
        for &j in axes {
            let of_translations = m_f[(i, j)] - if i == j { mass } else { 0.0 };
            // What is not antisymmetric, compared with the largest first moment of such an inertia; a point mass has none.
            let of_both = 0.5 * (m_f[(i, 3 + j)] + m_f[(j, 3 + i)]);
            let first_moment = if inertia > 0.0 { of_both.abs() / (mass * inertia).sqrt() } else { 0.0 };
            for (error, other) in [(of_translations.abs() / mass, NAMES[j]), (first_moment, NAMES[3 + j])] {
                if dense::worse(error, worst.0) {
                    worst = (error, Some(format!("{} and {other}", NAMES[i])));
                }
            }
        }
    }
    let data = if precision > f64::EPSILON { NOISE_FACTOR * precision } else { 0.0 };
    Check {
        id: "M-16",
        name: "mass is that of a body",
        equation: "max |M_tt − m I|_ij / m, |M_tr + M_trᵀ|_ij / 2√(m J), in M_F of the unit motions",
        value: worst.0,
        limits: Limits { engineering: LIKE_A_BODY, arithmetic: 0.0, data }.capped(0.0, UNLIKE_A_BODY),
        fail_above: UNLIKE_A_BODY,
        worst: worst.1,
    }
}

/// How well M is known in the six unit motions, relative to the mass and the inertia that it has there. Entries that were printed with the same
/// count of decimals differ in digits: those of rotations may have few, but translations make most of the inertia.
pub(super) fn precision(evidence: &Evidence<'_>) -> f64 {
    let share = evidence.partition.precision.mass.share;
    let Some(noise) = evidence.partition.mass_noise(evidence.rigid.modes.as_ref().get(.., ..NAMES.len())) else {
        return share;
    };
    let m_f = &evidence.reduction.rigid_body_mass;
    dense::worst(noise.iter().enumerate().map(|(j, noise)| noise / m_f[(j, j)])).min(share)
}

/// Share of the mean moment of inertia that is worth a look, and share that fails: of a part that far from the origin M has no inertia.
const INERTIA_OPEN: [f64; 2] = [1e-3, 1e-2];

/// M-16: the inertia about the centre is one that a body can have, and M has the digits for it. None of a point, and of what is no body.
///
/// J = J_O − m(c² I − ccᵀ) is the difference of numbers that are (c/i)² times as large, i the radius of gyration. M is known to `precision` of
/// its terms, in each direction by itself, so that the rotation about an axis may be off by that times m(c² − c_a²). No body has a negative
/// moment, or one above the sum of the others. `extent` is the largest distance between nodes with mass, zero where it is not known: what
/// rounding leaves of the inertia of a body is not that of a point.
pub(crate) fn of_inertia(m_f: MatRef<'_, f64>, precision: f64, extent: f64) -> Option<Check> {
    let mass = (m_f[(0, 0)] + m_f[(1, 1)] + m_f[(2, 2)]) / 3.0;
    let Place { centre: c, gyration } = Place::of(m_f, mass);
    let square: f64 = c.iter().map(|x| x * x).sum();
    let moved = |i: usize, j: usize| mass * (if i == j { square } else { 0.0 } - c[i] * c[j]);
    let about_centre = Mat::from_fn(3, 3, |i, j| 0.5 * (m_f[(3 + i, 3 + j)] + m_f[(3 + j, 3 + i)]) - moved(i, j));
    let moments = dense::symmetric_eigen(about_centre.as_ref()).ok()?.0;
    let mean = moments.iter().sum::<f64>() / 3.0;
    let about_origin = (0..3).map(|i| m_f[(3 + i, 3 + i)]).sum::<f64>() / 3.0;
    // A point has none, but for the rounding of its distance.
    let is_point = extent == 0.0 && mean.abs() <= NOISE_FACTOR * f64::EPSILON * about_origin;
    let has_none = mass.is_nan() || mass <= 0.0 || is_point;
    if has_none || of_a_body(m_f, &ALL_AXES, precision).verdict() == Verdict::Fail {
        return None;
    }
    // Above one nothing of it is known, whatever rounding left of the mean.
    let digits = (precision.max(f64::EPSILON) * mass * square / mean.abs()).min(1.0);
    let against_bodies = (-moments[0]).max(moments[2] - moments[0] - moments[1]).max(0.0) / mean.abs();
    let [engineering, fail] = INERTIA_OPEN;
    Some(Check {
        id: "M-16",
        name: "inertia about the centre is known",
        equation: "max(u m c², −J₁, J₃ − J₁ − J₂) / J̄, J about the centre, u the precision of M",
        value: dense::worst([digits, against_bodies.min(1.0)]),
        limits: Limits { engineering, ..Limits::default() },
        fail_above: fail,
        worst: Some(format!(
            "centre {} from the origin, radius of gyration {}",
            quantity(square.sqrt(), 3),
            quantity(gyration, 3)
        )),
    })
}

/// The largest distance between nodes with mass; zero where it is not known.
pub(super) fn extent(partition: &Partition) -> f64 {
    partition.model.weight.as_ref().map_or(0.0, |weight| weight.extent)
}

/// M-16 of a component that is no free body – several, or one that the job holds – by its mass before supports of the job take rows out of
/// it. None where supports may have taken rows out before, of which all of a node leave the mass of no body as well as some: matrices that
/// something holds, such as those of a superelement with `[[fixed]]` of its own.
pub(crate) fn of_weighed_body(partition: &Partition) -> Option<Check> {
    let weight = partition.model.weight.as_ref()?;
    let motions = weight.motions.as_ref().filter(|_| is_whole(weight))?;
    Some(of_a_body(motions.as_ref(), &weight.axes, partition.precision.mass.share))
}

/// M-16 of each part of several nodes that M couples with no other, the worst of them: a light part behind springs is nothing in the mass of
/// all. None where M couples everything, and where supports may have taken rows out before.
pub(crate) fn of_parts(partition: &Partition) -> Option<Check> {
    let weight = partition.model.weight.as_ref()?;
    let of_part = |part: &PartWeight| {
        let check = of_a_body(part.motions.as_ref(), &weight.axes, partition.precision.mass.share);
        let at = check.worst.as_ref().map(|at| format!("{at} of the part with node {}", part.first_node));
        Check {
            name: "mass of each part is that of a body",
            equation: "max |M_tt − m I|_ij / m, |M_tr + M_trᵀ|_ij / 2√(m J) of parts that M does not couple",
            worst: at,
            ..check
        }
    };
    let checks = weight.parts.iter().filter(|_| is_whole(weight)).map(of_part);
    checks.reduce(|worst, next| if dense::worse(next.value, worst.value) { next } else { worst })
}

/// Whether all of the mass is there that the model had: nothing held it before it was read.
fn is_whole(weight: &Weight) -> bool {
    // One translation has none to be compared with.
    let has_masses = weight.axes.len() > 1 && weight.axes.iter().all(|axis| weight.translations[*axis] > 0.0);
    has_masses && weight.has_whole_nodes && weight.supports == Supports::None
}

/// M-16 against what the job expects.
///
/// A free body is compared by its rigid-body motions. The mass of any other model is that of the translations of its map, and
/// its centre that of its coordinates. Supports of the model take the rows of held dofs out of M, so that such a model may lack a part;
/// those of the job leave the whole known.
pub(super) fn expected(evidence: &Evidence<'_>) -> Option<Check> {
    compared(evidence.expect?, Known::of(evidence)?, evidence.partition.scaling.mass_unit())
}

/// M-16 against what the job expects, by the translations of the map and the coordinates alone.
pub(crate) fn expected_by_weight(expect: &Expectation, partition: &Partition) -> Option<Check> {
    compared(expect, Known::by_weight(partition)?, partition.scaling.mass_unit())
}

/// What of an expectation the map and the coordinates have nothing to compare with, in words.
pub(crate) fn not_comparable(expect: &Expectation, partition: &Partition) -> Vec<&'static str> {
    let weight = partition.model.weight.as_ref();
    let has_mass = weight.is_some();
    let has_centre = weight.is_some_and(|weight| weight.motions.is_some());
    let lacks = [
        (expect.mass.is_some() && !has_mass, "mass, which needs a dof map or nodes"),
        (expect.cg.is_some() && !has_centre, "centre of mass, which needs a dof map and nodes"),
    ];
    lacks.into_iter().filter(|(lacks, _)| *lacks).map(|(_, what)| what).collect()
}

/// M-16: there is something to compare with what the job expects.
pub(crate) fn comparable(lacks: &[&str]) -> Option<Check> {
    (!lacks.is_empty()).then(|| Check {
        id: "M-16",
        name: "what is expected can be compared",
        equation: "number of expectations that nothing in the model can be compared with",
        value: lacks.len() as f64,
        limits: Limits::default(),
        fail_above: Check::NEVER,
        worst: Some(lacks.join("; ")),
    })
}

fn compared(expect: &Expectation, known: Known, unit: f64) -> Option<Check> {
    let mass = known.mass * unit;
    let mass_error = expect.mass.map(|expected| (mass / expected - 1.0).abs());
    let shift = expect.cg.zip(known.place).map(|(expected, place)| place.shift_from(expected));
    if mass_error.is_none() && shift.is_none() {
        return None;
    }
    // Where the mass is that expected, no row is missing.
    let may_lack_rows = !known.is_whole && expect.mass.is_none_or(|expected| mass < (1.0 - AS_EXPECTED) * expected);
    let centre = known.place.map_or_else(String::new, |Place { centre, gyration }| {
        // Rounding compared with the component's size is shown as zero.
        let shown = |value: f64| quantity(if value.abs() < 1e-12 * gyration { 0.0 } else { value }, 6);
        format!(", centre ({})", centre.map(shown).join(", "))
    });
    let lacks = if may_lack_rows { ", without rows that supports took out of M" } else { "" };
    Some(Check {
        id: "M-16",
        name: "mass and centre are those expected",
        equation: "max |m/m_expected − 1|, |c − c_expected| / radius of gyration",
        value: dense::worst(mass_error.into_iter().chain(shift)),
        limits: Limits { engineering: AS_EXPECTED, ..Limits::default() },
        fail_above: if may_lack_rows { TAKEN_OUT } else { 1e-2 },
        worst: Some(format!("{}{centre}{lacks}", found_mass(mass, expect.mass))),
    })
}

/// `mass 0.0027252, expected 2.725: ratio 1000, a unit slip?`
fn found_mass(mass: f64, expected: Option<f64>) -> String {
    let found = format!("mass {}", quantity(mass, 6));
    let Some(expected) = expected else { return found };
    let ratio = (expected / mass).max(mass / expected);
    let decades = ratio.log10();
    // A slip of units is a power of ten but for the mass that either number leaves out, up to a fifth.
    let is_slip = decades > 0.5 && (decades - decades.round()).abs() < 0.08;
    let question = if is_slip { ", a unit slip?" } else { "" };
    let ratio = if ratio > 1.01 { format!(": ratio {}{question}", quantity(ratio, 3)) } else { String::new() };
    format!("{found}, expected {}{ratio}", quantity(expected, 6))
}

/// Relative difference from what the job expects, which people write with four digits.
const AS_EXPECTED: f64 = 1e-4;
/// Share of the mass that supports may take out of a held model. A model that lacks more has another fault.
const TAKEN_OUT: f64 = 0.5;

/// Mass and centre in scaled units.
struct Known {
    mass: f64,
    place: Option<Place>,
    /// Whether no support took out a row.
    is_whole: bool,
}

impl Known {
    fn of(evidence: &Evidence<'_>) -> Option<Self> {
        let Evidence { partition, rigid, .. } = evidence;
        // What moves of a component that the job holds has less mass than the whole.
        if rigid.is_classical && partition.held.count() == 0 {
            let m_f = evidence.reduction.rigid_body_mass.as_ref();
            let mass = (m_f[(0, 0)] + m_f[(1, 1)] + m_f[(2, 2)]) / 3.0;
            return Some(Self { mass, place: Some(Place::of(m_f, mass)), is_whole: true });
        }
        Self::by_weight(partition)
    }

    /// Mass of the translations of the map, and the centre where there are coordinates.
    fn by_weight(partition: &Partition) -> Option<Self> {
        let weight = partition.model.weight.as_ref()?;
        // A support may take out the rows of one direction and not of another.
        let mass = weight.translations.into_iter().fold(0.0, f64::max);
        let place = Place::of_weight(weight, mass);
        Some(Self { mass, place, is_whole: weight.supports == Supports::None })
    }
}
