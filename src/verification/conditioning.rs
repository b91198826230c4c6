//! How much the matrices amplify rounding: M-23.

use faer::{Mat, MatRef};

use super::check::{Check, Limits};
use super::evidence::{Evidence, coordinate_name, coordinate_scales};
use crate::basis::DynamicCoordinate;
use crate::cache::{Kind, Reader, Recorded, Writer, recalled};
use crate::dense;
use crate::eigen::{Equilibrated, scaled_by};
use crate::error::Result;
use crate::factor::{SolveOperator, Storage};
use crate::rigid::ILL_CONDITIONED;

/// ‖DK_IID‖₁ ‖(DK_IID)⁻¹‖₁, the second norm estimated from below by a few solves (Hager 1984, Higham 1988).
///
/// The estimate is within a factor of three of the truth in practice. Where the interface leaves rigid-body motions free, there is no such
/// inverse, and the condition of the answers at the interface counts.
pub(super) fn internal_condition(evidence: &Evidence<'_>) -> f64 {
    if let Some(attachment) = &evidence.constraint.attachment {
        return attachment.condition;
    }
    let cache = evidence.partition.cache().filter(|_| evidence.factor.storage() == Storage::Double);
    let key = || evidence.partition.key_of_matrices("condition of the interior");
    let Condition(condition) =
        recalled(cache, key, || Ok(Condition(estimated(evidence)))).expect("solves give a number");
    condition
}

/// A condition as an entry of a cache has it.
struct Condition(f64);

impl Recorded for Condition {
    const KIND: Kind = Kind::Statics;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        to.array(&[self.0])
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        from.number().map(Self)
    }
}

/// The estimate by solves.
fn estimated(evidence: &Evidence<'_>) -> f64 {
    const MAX_STEPS: usize = 5;
    let norms = Equilibrated::of(evidence.partition.internal());
    let n = norms.scale.len();
    let solve = |x: &[f64]| -> Vec<f64> {
        let mut block = Mat::from_fn(n, 1, |i, _| x[i] / norms.scale[i]);
        evidence.factor.solve_in_place(block.as_mut());
        dense::column(block.as_ref(), 0).iter().zip(&norms.scale).map(|(y, d)| y / d).collect()
    };
    let mut x = vec![1.0 / n as f64; n];
    let mut estimate = 0.0;
    for _ in 0..MAX_STEPS {
        let y = solve(&x);
        let norm: f64 = y.iter().map(|y| y.abs()).sum();
        if norm.is_nan() {
            return norm;
        }
        if norm <= estimate {
            break;
        }
        estimate = norm;
        let signs: Vec<f64> = y.iter().map(|y| if *y < 0.0 { -1.0 } else { 1.0 }).collect();
        let z = solve(&signs);
        let (mut at, mut largest) = (0, 0.0);
        for (i, z) in z.iter().enumerate() {
            if z.abs() > largest {
                (at, largest) = (i, z.abs());
            }
        }
        if largest <= dense::dot(&z, &x) {
            break;
        }
        x.fill(0.0);
        x[at] = 1.0;
    }
    norms.stiffness_norm * estimate
}

/// The checks of M-23.
pub(super) fn conditioning(evidence: &Evidence<'_>, internal: f64) -> Result<Vec<Check>> {
    let mut checks = of_interior(evidence, internal);
    // What MacNeal's method leaves without mass has none by its making; clients are told that M̂ is singular.
    let n_massless = evidence.reduction.mass_rank().map_or(0, |rank| evidence.reduction.n_reduced() - rank);
    let equation = match n_massless {
        0 => "κ₂(D M̂ D), unit diagonal",
        _ => "κ₂(D M̂ D), unit diagonal, on the motions with mass",
    };
    let mass = condition(evidence, evidence.reduction.mass.as_ref(), &mass_scales(evidence), n_massless)?;
    // At this condition a client that factors M̂ loses half its digits.
    checks.push(judged("condition of the reduced mass", equation, mass, 1e8));
    checks.extend(of_reduced_stiffness(evidence)?);
    Ok(checks)
}

/// The checks of M-23 that do not depend on a mass.
pub(super) fn of_stiffness(evidence: &Evidence<'_>, internal: f64) -> Result<Vec<Check>> {
    let mut checks = of_interior(evidence, internal);
    checks.extend(of_reduced_stiffness(evidence)?);
    Ok(checks)
}

fn of_interior(evidence: &Evidence<'_>, internal: f64) -> Vec<Check> {
    if !evidence.is_held() {
        // At this condition half the digits of the static modes are lost.
        return vec![judged("condition of the attachment modes", "κ₂(D A_B D), unit diagonal", (internal, None), 1e8)];
    }
    vec![
        judged(
            "interface reacts all rigid-body motions alike",
            "s_max / s_min of U_B, rotations times the size of the component",
            (1.0 / evidence.rank.singular_ratio, None),
            1.0 / ILL_CONDITIONED,
        ),
        shown("condition of the internal stiffness", "κ₁(D K_II D), estimated", (internal, None)),
    ]
}

fn of_reduced_stiffness(evidence: &Evidence<'_>) -> Result<Vec<Check>> {
    let stiffness = evidence.reduction.stiffness.as_ref();
    let (stiffness, softest) = condition(evidence, stiffness, &coordinate_scales(evidence), evidence.rigid.count())?;
    let equation = "κ₂(D K̂ D) without its rigid-body modes, in the scales of the uncondensed stiffness";
    let mut checks = vec![shown("condition of the reduced elastic stiffness", equation, (stiffness, softest))];
    if evidence.basis.n_dynamic() > 0 {
        let equation = "min |R_jj| / ‖R_j‖ of Ψ_D = named columns · R⁻¹";
        checks.push(shown("least independent dynamic mode", equation, independence(evidence, Columns::All)));
    }
    Ok(checks)
}

/// Near 1/√M̂_ii.
fn mass_scales(evidence: &Evidence<'_>) -> Vec<f64> {
    let mass = &evidence.reduction.mass;
    (0..mass.nrows()).map(|i| dense::power_of_two_root(mass[(i, i)])).collect()
}

/// Largest over smallest eigenvalue of D A D, the first `n_zero` left out, and the coordinate with the largest part in the
/// smallest.
fn condition(
    evidence: &Evidence<'_>,
    a: MatRef<'_, f64>,
    scales: &[f64],
    n_zero: usize,
) -> Result<(f64, Option<String>)> {
    let (values, vectors) = dense::symmetric_eigen(scaled_by(a, scales).as_ref())?;
    let Some(least) = values.get(n_zero) else {
        return Ok((1.0, None));
    };
    let part = |i: usize| vectors[(i, n_zero)].abs();
    let softest = (0..values.len()).max_by(|a, b| part(*a).total_cmp(&part(*b)));
    // An eigenvalue below zero is rounding or worse; M-25 says which.
    let ratio = if *least > 0.0 { values[values.len() - 1] / least } else { f64::MAX };
    Ok((ratio, softest.map(|i| coordinate_name(evidence, i))))
}

/// Which columns of Ψ_D are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Columns {
    /// Every one.
    All,
    /// Those that modes are put together from: residual vectors come after them.
    BeforeResidualVectors,
}

/// The smallest share of its length that a column of Ψ_D keeps when the columns before it are taken out.
pub(super) fn independence(evidence: &Evidence<'_>, columns: Columns) -> (f64, Option<String>) {
    let basis = evidence.basis;
    let mut least = (1.0, None);
    let is_residual = |slot: usize| matches!(basis.coordinates[slot], DynamicCoordinate::ResidualVector(_));
    for (slot, named) in basis.kept.iter().enumerate() {
        if columns == Columns::BeforeResidualVectors && is_residual(slot) {
            continue;
        }
        let length = dense::norm(dense::column(basis.mixing.as_ref(), *named));
        let share = basis.mixing[(slot, *named)].abs() / length;
        // Below the limit, or NaN.
        if share.is_nan() || share < least.0 {
            least = (share, Some(coordinate_name(evidence, evidence.partition.n_interface() + slot)));
        }
    }
    least
}

fn shown(name: &'static str, equation: &'static str, (value, worst): (f64, Option<String>)) -> Check {
    Check { id: "M-23", name, equation, value, limits: Limits::NONE, fail_above: f64::INFINITY, worst }
}

/// A check that warns above its limit and never fails: a bad condition loses digits, and other checks say whether too many
/// are lost.
fn judged(name: &'static str, equation: &'static str, (value, worst): (f64, Option<String>), limit: f64) -> Check {
    let limits = Limits { engineering: limit, ..Limits::default() };
    Check { id: "M-23", name, equation, value, limits, fail_above: Check::NEVER, worst }
}
