//! Mass properties: M-16.

use super::check::{Check, Limits};
use super::rigid_body::mass_difference;
use super::{Evidence, rigid_name};
use crate::dense;
use crate::report::table::quantity;

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

/// Rounding of ÛᵀM̂Û: an interface that is small beside the component holds large masses on long levers, which cancel.
fn rounding(evidence: &Evidence<'_>) -> f64 {
    const NOISE_FACTOR: f64 = 10.0;
    let (m, u) = (&evidence.reduction.mass, &evidence.reduction.rigid_body_modes);
    let terms = |j: usize| {
        let of_row = |i: usize| (0..m.ncols()).map(|k| m[(i, k)].abs() * u[(k, j)].abs()).sum::<f64>();
        (0..m.nrows()).map(|i| u[(i, j)].abs() * of_row(i)).sum::<f64>()
    };
    let share = |j: usize| terms(j) / evidence.reduction.rigid_body_mass[(j, j)];
    NOISE_FACTOR * f64::EPSILON * (0..u.ncols()).map(share).fold(0.0, f64::max)
}

/// M-16 against what the job expects.
pub(super) fn expected(evidence: &Evidence<'_>) -> Option<Check> {
    let expect = evidence.expect?;
    if !evidence.rigid.is_classical {
        return None;
    }
    let m_f = &evidence.reduction.rigid_body_mass;
    let unit = evidence.partition.scaling.mass_unit();
    let mass = (m_f[(0, 0)] + m_f[(1, 1)] + m_f[(2, 2)]) / 3.0;
    let centre = [m_f[(1, 5)] / mass, m_f[(2, 3)] / mass, m_f[(0, 4)] / mass];
    // The radius of gyration is the length that a shift of the centre is compared with.
    let gyration = ((m_f[(3, 3)] + m_f[(4, 4)] + m_f[(5, 5)]) / (2.0 * mass)).sqrt();
    let mass_error = expect.mass.map(|known| (mass * unit / known - 1.0).abs());
    let shift = expect.cg.map(|known| (0..3).map(|i| (centre[i] - known[i]).powi(2)).sum::<f64>().sqrt() / gyration);
    let value = dense::worst(mass_error.into_iter().chain(shift));
    // What is rounding beside the component's size would only draw the eye.
    let coordinate = |value: f64| quantity(if value.abs() < 1e-12 * gyration { 0.0 } else { value }, 6);
    Some(Check {
        id: "M-16",
        name: "mass and centre are those expected",
        equation: "max |m/m_expected − 1|, |c − c_expected| / radius of gyration",
        value,
        limits: Limits { engineering: 1e-4, ..Limits::default() },
        fail_above: 1e-2,
        worst: Some(format!("mass {}, centre ({})", quantity(mass * unit, 6), centre.map(coordinate).join(", "))),
    })
}
