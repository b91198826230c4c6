//! Rigid-body motion passes through the model, the basis and the reduced stiffness: M-05, M-11, M-12.

use super::check::{Check, Limits};
use super::reduced::{Spectrum, zero_level};
use super::{Evidence, reduced_norms};
use crate::dense;

/// How far roundings of one sign may exceed their typical sum.
const NOISE_FACTOR: f64 = 10.0;

/// M-05, energy.
pub(super) fn energy(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Check {
    let energy = evidence.rigid.energy;
    let first = spectrum.first_elastic();
    let precision = evidence.partition.precision.stiffness;
    let noise = NOISE_FACTOR * evidence.partition.cancellation * energy.noise / first;
    let share = f64::EPSILON / (f64::EPSILON + precision);
    let limits = Limits { engineering: 1e-8, arithmetic: noise * share, data: noise * (1.0 - share) };
    Check {
        id: "M-05",
        name: "rigid-body motion costs no energy",
        equation: "max qᵀKq / λ of the first elastic mode",
        value: energy.largest_quotient / first,
        limits,
        // An energy of 10⁻⁴ is a rigid-body frequency of a hundredth of the first elastic one: the model is grounded.
        fail_above: limits.value().max(1e-4),
        worst: None,
    }
}

/// M-05, residual.
pub(super) fn residual(evidence: &Evidence<'_>) -> Check {
    let precision = evidence.partition.precision.stiffness;
    let cancellation = evidence.partition.cancellation;
    let data = if precision > f64::EPSILON { NOISE_FACTOR * precision * cancellation } else { 0.0 };
    let limits = Limits { engineering: 1e-14, arithmetic: f64::EPSILON * cancellation, data };
    Check {
        id: "M-05",
        name: "rigid-body motion makes no force",
        equation: "max ‖Kq‖ / ‖|K||q|‖",
        value: evidence.rigid.energy.largest_residual,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: None,
    }
}

/// M-11, equation (24).
pub(super) fn carried_by_interface(evidence: &Evidence<'_>) -> Check {
    let (value, at) = evidence.constraint.rigid_error;
    let raw = evidence.constraint.raw_rigid_error;
    Check {
        id: "M-11",
        name: "interface carries rigid-body motion",
        equation: "max |Ψ_S U_B − U_I| / max |U_I| (24), after the correction",
        value,
        limits: Limits { engineering: 1e-12, ..Limits::default() },
        fail_above: 1e-9,
        worst: (value > 0.0).then(|| format!("{}, {raw:.1e} before the correction", evidence.partition.name_of(at))),
    }
}

/// M-12, null space.
pub(super) fn null_space(evidence: &Evidence<'_>) -> Check {
    let reduction = evidence.reduction;
    let norms = reduced_norms(evidence);
    let forces = dense::product(reduction.stiffness.as_ref(), reduction.rigid_body_modes.as_ref());
    let mut worst = (0.0, None);
    for j in 0..forces.ncols() {
        let u = dense::column(reduction.rigid_body_modes.as_ref(), j);
        let error = norms.backward_error(0.0, u, dense::column(forces.as_ref(), j));
        if dense::worse(error, worst.0) {
            worst = (error, Some(format!("rigid-body mode {}", j + 1)));
        }
    }
    let limits = Limits { engineering: 1e-12, ..zero_level(evidence) };
    Check {
        id: "M-12",
        name: "reduced stiffness lets rigid motion pass",
        equation: "max ‖K̂Û‖ / (‖K‖ ‖Û‖), in the scales of the uncondensed stiffness",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-8),
        worst: worst.1,
    }
}

/// M-12, number of zero modes.
pub(super) fn zero_modes(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Check {
    Check {
        id: "M-12",
        name: "reduced stiffness has no other zero modes",
        equation: "|zero eigenvalues of K̂ − n_r|",
        value: spectrum.n_zero.abs_diff(evidence.rigid.count()) as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some(format!("{} zero modes, {} rigid-body modes", spectrum.n_zero, evidence.rigid.count())),
    }
}
