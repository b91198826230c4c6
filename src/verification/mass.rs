//! Mass properties: M-16.

use faer::{Mat, MatRef};

use super::Evidence;
use super::check::{Check, Limits};
use super::rigid_body::mass_difference;
use crate::dense;

/// Roundings of one sign that the sums of a reduced mass may leave.
const ROUNDINGS: f64 = 10.0;

/// M-16: ÛᵀM̂Û against UᵀMU.
pub(super) fn preserved(evidence: &Evidence<'_>) -> Check {
    let reduction = evidence.reduction;
    let full = &reduction.rigid_body_mass;
    let u = reduction.rigid_body_modes.as_ref();
    let reduced = dense::gram(u, dense::product(reduction.mass.as_ref(), u).as_ref());
    let (value, (i, j)) = mass_difference(reduced.as_ref(), full.as_ref());
    // What cancels in the sums of both: a seismic mass leaves its rounding in every inertia.
    let sizes = |a: MatRef<'_, f64>| Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)].abs());
    let (sizes_u, sizes_m) = (sizes(u), sizes(reduction.mass.as_ref()));
    let terms = dense::gram(sizes_u.as_ref(), dense::product(sizes_m.as_ref(), sizes_u.as_ref()).as_ref());
    let cancellation = if full.ncols() > 0 && full[(i, i)] > 0.0 && full[(j, j)] > 0.0 {
        (terms[(i, i)] / full[(i, i)]).max(terms[(j, j)] / full[(j, j)])
    } else {
        1.0
    };
    let arithmetic = ROUNDINGS * f64::EPSILON * cancellation;
    let limits = Limits { engineering: 1e-10, arithmetic, data: 0.0 }.capped(1e-6, 1e-2);
    Check {
        id: "M-16",
        name: "mass, centre and inertia are preserved",
        equation: "max |ÛᵀM̂Û − UᵀMU|_ij / √(M_F,ii M_F,jj)",
        value,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: (value > 0.0).then(|| format!("rigid-body modes {} and {}", i + 1, j + 1)),
    }
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
    let value = mass_error.unwrap_or(0.0).max(shift.unwrap_or(0.0));
    Some(Check {
        id: "M-16",
        name: "mass and centre are those expected",
        equation: "max |m/m_expected − 1|, |c − c_expected| / radius of gyration",
        value,
        limits: Limits { engineering: 1e-4, ..Limits::default() },
        fail_above: 1e-2,
        worst: Some(format!(
            "mass {:.6e}, centre ({:.4e}, {:.4e}, {:.4e})",
            mass * unit,
            centre[0],
            centre[1],
            centre[2]
        )),
    })
}
