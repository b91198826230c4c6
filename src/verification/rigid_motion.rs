//! Rigid-body motion passes through the model, the basis and the reduced stiffness: M-05, M-11, M-12.

use super::check::{Check, Limits, MAX_EXCUSE};
use super::evidence::{Evidence, coordinate_name, reduced_norms, rigid_name};
use super::force;
use super::grounding::{Grounding, Restraint};
use super::limits::{self, Judged, NOT_CARRIED, share_of_data};
use super::residual::Worst;
use super::spectrum::{NOT_FREE, Spectrum, zero_level, zero_levels};
use crate::basis::DynamicCoordinate;
use crate::constraint::rigid_error;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::Equilibrated;
use crate::error::Result;
use crate::reduction::sizes_of_modes;
use crate::rigid::{FORCE_ASKED, RigidEnergy, scales};

/// M-05, energy. The value is shown and not judged where no elastic mode is known to compare it with.
pub(super) fn energy(evidence: &Evidence<'_>, spectrum: &Spectrum, grounding: &[Grounding]) -> Check {
    let energy = evidence.rigid.energy;
    let worst = strained(grounding, |direction| direction.energy_ratio);
    let check = Check {
        id: "M-05",
        name: "rigid-body motion costs no energy",
        equation: "max qᵀKq / λ of the first elastic mode",
        value: energy.largest_quotient,
        limits: Limits::NONE,
        fail_above: f64::INFINITY,
        worst,
    };
    let Some(first) = spectrum.first_elastic() else {
        return Check {
            equation: "max qᵀKq over max K_ii / max M_ii; no elastic mode is known to compare it with",
            ..check
        };
    };
    let judged = energy_limits(evidence, spectrum);
    let value = energy.largest_quotient / first;
    let check = Check { value, limits: judged.limits, fail_above: judged.fail_above, ..check };
    named_by_digits(evidence, spectrum, check)
}

/// A check of the energy of rigid-body motion relative to the first elastic one, or of its force, that says so where it is past its limit and
/// what few digits make of that energy explains its value.
pub(super) fn named_by_digits(evidence: &Evidence<'_>, spectrum: &Spectrum, check: Check) -> Check {
    if check.value <= check.limits.value() || !are_explained_by_digits(evidence, spectrum, check.value) {
        return check;
    }
    let words = "by the digits of the stiffness; write it with more";
    let worst = check.worst.map_or_else(|| words.to_owned(), |worst| format!("{worst}, {words}"));
    Check { worst: Some(worst), ..check }
}

/// Whether few digits of K make as much of the energies of rigid-body motion, relative to the first elastic one; never where none is known.
fn are_explained_by_digits(evidence: &Evidence<'_>, spectrum: &Spectrum, energy: f64) -> bool {
    let noise = NOISE_FACTOR * spectrum.noise * share_of_data(evidence.partition);
    evidence.partition.has_few_digits() && energy <= noise
}

/// Limits of an energy that should be zero. They come from the error bars of the modes and from what few digits make of rigid-body motion
/// itself, which the bars of modes with the interface held do not show. Without either they come from the moduli of its terms.
pub(super) fn energy_limits(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Judged {
    limits::of_energy(spectrum.noise, share_of_data(evidence.partition))
}

/// M-05, residual.
pub(super) fn residual(evidence: &Evidence<'_>, grounding: &[Grounding]) -> Check {
    let precision = evidence.partition.precision.stiffness.share;
    let cancellation = evidence.partition.cancellation;
    let data = if precision > f64::EPSILON { NOISE_FACTOR * precision * cancellation } else { 0.0 };
    // Beyond what patches make of one rounding, coordinates and entries have roundings of their own: `rigid::rounding` derives them.
    let RigidEnergy { largest_residual, residual_rounding, .. } = evidence.rigid.energy;
    let arithmetic = residual_rounding.max(f64::EPSILON * cancellation);
    let limits = Limits { engineering: FORCE_ASKED, arithmetic, data }.capped(MAX_EXCUSE, MAX_EXCUSE);
    Check {
        id: "M-05",
        name: "rigid-body motion makes no force",
        equation: "max ‖Kq‖ / ‖|K||q|‖",
        value: largest_residual,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: strained(grounding, |direction| direction.force_ratio),
    }
}

/// The direction that is worst, with the dof that its force is largest at.
fn strained(grounding: &[Grounding], measure: impl Fn(&Grounding) -> f64) -> Option<String> {
    let worst = grounding
        .iter()
        .filter(|direction| direction.restraint != Restraint::Held)
        .max_by(|a, b| measure(a).total_cmp(&measure(b)))?;
    Some(match &worst.worst {
        Some(dof) => format!("{}, {dof}", worst.direction),
        None => worst.direction.clone(),
    })
}

/// M-11, equation (24), measured on the basis.
pub(super) fn carried_by_interface(evidence: &Evidence<'_>) -> Check {
    let motions = evidence.rigid.orthonormal.as_ref();
    let found = rigid_error(evidence.partition, &evidence.basis.constraint_modes, motions);
    let worst = Worst { value: found.value, at: found.at };
    let raw = evidence.constraint.raw_rigid_error;
    Check {
        id: "M-11",
        name: "interface carries rigid-body motion",
        equation: "max |Ψ_S U_B − U_I| / max |U_I| (24), after the correction",
        value: worst.value,
        limits: Limits { engineering: 1e-12, ..Limits::default() },
        fail_above: NOT_CARRIED,
        worst: worst.name(evidence, "rigid-body mode").map(|at| format!("{at}, {raw:.1e} before the correction")),
    }
}

/// M-12, null space.
pub(super) fn null_space(evidence: &Evidence<'_>) -> Check {
    /// The most that rounding excuses: four digits are left.
    const LARGEST_ROUNDING: f64 = 1e-4;
    let reduction = evidence.reduction;
    let norms = reduced_norms(evidence);
    let forces = dense::product(reduction.stiffness.as_ref(), reduction.rigid_body_modes.as_ref());
    let (mut worst, mut of_displacements) = ((0.0, None), 0.0f64);
    for j in 0..forces.ncols() {
        let u = dense::column(reduction.rigid_body_modes.as_ref(), j);
        let error = norms.backward_error(0.0, u, dense::column(forces.as_ref(), j));
        of_displacements = of_displacements.max(displacement_rounding(evidence, &norms, u));
        if dense::worse(error, worst.0) {
            let at = coordinate_name(evidence, norms.largest(dense::column(forces.as_ref(), j)));
            worst = (error, Some(format!("{}, {at}", rigid_name(evidence, j))));
        }
    }
    let limits = zero_level(evidence);
    let arithmetic = limits.arithmetic.max(NOISE_FACTOR * of_displacements).max(amplitude_rounding(evidence));
    let limits = Limits { engineering: 1e-12, arithmetic, ..limits }.capped(LARGEST_ROUNDING, MAX_EXCUSE);
    Check {
        id: "M-12",
        name: "reduced stiffness lets rigid motion pass",
        equation: "max ‖K̂Û‖ / (‖K‖ ‖Û‖), in the scales of the uncondensed stiffness",
        value: worst.0,
        limits,
        fail_above: limits.value().max(NOT_FREE),
        worst: worst.1,
    }
}

/// What rounding of its energy makes of the measure of a motion that leaves the interface at rest: its amplitude has no stiffness of its own,
/// and the size of the softest elastic one.
fn amplitude_rounding(evidence: &Evidence<'_>) -> f64 {
    let (n_b, basis) = (evidence.partition.n_interface(), evidence.basis);
    let is_rigid = |coordinate: &DynamicCoordinate| matches!(coordinate, DynamicCoordinate::RigidBody(_));
    let Some(slot) = basis.coordinates.iter().position(is_rigid).filter(|_| n_b > 0) else { return 0.0 };
    let size = sizes_of_modes(evidence.reduction.stiffness.as_ref(), n_b, basis)[slot];
    let levels = zero_levels(evidence, evidence.reduction.rigid_body_modes.as_ref());
    levels.into_iter().fold(0.0, f64::max) / size
}

/// What a rounding ε of the largest displacement, at every interface dof, makes of the measure of one motion: next to nothing where the motion
/// works against the stiffness of what it moves, and more where it slides along what has hardly any.
fn displacement_rounding(evidence: &Evidence<'_>, norms: &Equilibrated, u: &[f64]) -> f64 {
    let (n_b, k) = (evidence.partition.n_interface(), &evidence.reduction.stiffness);
    let scales = &scales(evidence.partition)[evidence.partition.n_internal..];
    let largest = u.iter().zip(scales).fold(0.0f64, |max, (u, scale)| max.max((u * scale).abs()));
    let force = |i: usize| (0..n_b).map(|j| k[(i, j)].abs() * largest / scales[j]).sum::<f64>();
    let forces: Vec<f64> = (0..k.nrows()).map(force).collect();
    f64::EPSILON * norms.backward_error(0.0, u, &forces)
}

/// M-12, force, as the verification of the file measures it.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn force(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Result<Check> {
    let Disturbance { first, noise, share_of_data } = Disturbance::of(evidence, spectrum)?;
    let judged = limits::of_force(noise, share_of_data);
    let name = |mode: usize, at: usize| format!("{}, {}", rigid_name(evidence, mode), coordinate_name(evidence, at));
    let (k, m, u) = evidence.reduction.pencil();
    let scales = force::scales((k, m, u), first, &evidence.directions());
    let check = force::of_rigid_motion((k, u), &scales, judged, &name);
    Ok(named_by_digits(evidence, spectrum, check))
}

/// What disturbs forces of rigid-body motion.
pub(super) struct Disturbance {
    /// The first elastic eigenvalue, that energies are compared with.
    pub(super) first: f64,
    /// Rounding in an energy, relative to the first elastic one.
    pub(super) noise: f64,
    /// The share of it that the digits of the data have.
    pub(super) share_of_data: f64,
}

impl Disturbance {
    /// # Errors
    /// A dense eigenproblem that does not converge.
    pub(super) fn of(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Result<Self> {
        let known = spectrum.first_elastic();
        let first = match known {
            Some(first) => first,
            None => evidence.reduction.elastic_scale()?.unwrap_or(1.0),
        };
        Ok(Self { first, noise: spectrum.noise, share_of_data: share_of_data(evidence.partition) })
    }
}

/// M-12, zero eigenvalues of K̂ alone, in the scales of its coordinates and with its rigid-body modes lifted.
pub(super) fn other_zero_modes(evidence: &Evidence<'_>, lifted: &[f64]) -> Check {
    let level = zero_level(evidence).value();
    let n_others = lifted.iter().filter(|value| value.abs() <= level).count();
    Check {
        id: "M-12",
        name: "reduced stiffness has no other zero modes",
        equation: "eigenvalues of K̂ beyond n_r that are rounding, in the scales of the uncondensed stiffness",
        value: n_others.saturating_sub(evidence.rigid.n_grey) as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some(format!("{n_others} beyond {} rigid-body modes", evidence.rigid.count())),
    }
}

/// M-12, number of zero modes.
pub(super) fn zero_modes(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Check {
    Check {
        id: "M-12",
        name: "reduced stiffness has no other zero modes",
        equation: "zero eigenvalues of (K̂, M̂) within their error bars beyond n_r, and rigid-body motions that are none",
        // A motion of the grey zone may fall on either side of the level; W-GREY has named it.
        value: (spectrum.n_others.saturating_sub(evidence.rigid.n_grey) + spectrum.n_held) as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some({
            let n_r = evidence.rigid.count();
            let found = format!("{} zero modes, {n_r} rigid-body modes", n_r + spectrum.n_others - spectrum.n_held);
            let energy =
                |first: f64| spectrum.rigid().iter().fold(0.0, |max: f64, energy| max.max(energy.abs())) / first;
            let of_digits = |first: &f64| are_explained_by_digits(evidence, spectrum, energy(*first));
            match spectrum.first_elastic().filter(of_digits) {
                Some(_) if spectrum.n_held > 0 => {
                    format!("{found}, as such motion costs energy by the digits of the stiffness; write it with more")
                }
                _ => found,
            }
        }),
    }
}
