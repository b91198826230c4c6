//! The reduced pencil: M-13, M-14, M-25.

use std::ops::Range;

use faer::MatRef;

use super::check::{Check, Limits, MAX_EXCUSE};
use super::conditioning::{Columns, independence};
use super::evidence::{Evidence, coordinate_name, data_noise, reduced_norms};
use super::limits::{self, HARMLESS_COUPLING, Judged};
use super::rigid_motion::{energy_limits, named_by_digits};
use super::spectrum::{Spectrum, zero_level};
use crate::basis::INDEPENDENT;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::{Modes, REPEATED_WITHIN};
use crate::sparse::absolute_energy;
use crate::sparse::{Leading, panels};

/// The size of the terms that the reduced matrices are summed from: rounding of an entry is ε times these.
pub(super) struct Terms {
    /// max (|Ψ|ᵀ|K||Ψ|)_ii / K_BB,ii of the interface columns; without an interface as for the dynamic ones.
    interface: f64,
    /// max (|Ψ|ᵀ|K||Ψ|)_jj / K̂_jj of the dynamic columns; without an interface over the largest K̂_jj, which M-13 divides by there.
    dynamic: f64,
    /// max (|Ψ|ᵀ|M||Ψ|)_ii / M̂_ii: modes that M nearly lets pass are of large terms.
    mass: f64,
}

impl Terms {
    pub(super) fn of(evidence: &Evidence<'_>) -> Self {
        let internal_mass = evidence.partition.internal().mass;
        let basis = evidence.basis;
        let of_statics =
            |columns: Range<usize>| terms_of(internal_mass, basis.constraint_modes.columns(columns).as_ref());
        // The mass of the interface itself adds to these, and leaving it out excuses less.
        let terms = panels(evidence.partition.n_interface()).flat_map(of_statics);
        let terms = terms.chain(terms_of(internal_mass, basis.dynamic_modes.as_ref()));
        let mass = terms.zip(dense::diagonal(evidence.reduction.mass.as_ref()));
        let shares = mass.filter(|(_, inertia)| *inertia > 0.0).map(|(terms, inertia)| terms / inertia);
        Self { mass: shares.fold(1.0, f64::max), ..Self::of_stiffness(evidence) }
    }

    /// The terms of K̂ alone.
    pub(super) fn of_stiffness(evidence: &Evidence<'_>) -> Self {
        let (partition, k) = (evidence.partition, &evidence.reduction.stiffness);
        let n_b = partition.n_interface();
        let mut dynamic = 1.0f64;
        // Rigid-body modes have no energy of their own.
        let highest = (n_b == 0).then(|| (0..k.nrows()).fold(0.0f64, |max, j| max.max(k[(j, j)])));
        for columns in panels(evidence.basis.n_dynamic()) {
            let panel = evidence.basis.dynamic_modes.as_ref().get(.., columns.clone());
            for (column, terms) in columns.zip(absolute_energy(partition.internal().stiffness, panel)) {
                let at = n_b + column;
                let energy = highest.unwrap_or_else(|| k[(at, at)].abs());
                // Where there is no energy at all, M-13 divides by the terms themselves.
                dynamic = if energy > 0.0 { dynamic.max(terms / energy) } else { dynamic };
            }
        }
        Self { interface: if n_b == 0 { dynamic } else { evidence.constraint.cancellation }, dynamic, mass: 1.0 }
    }
}

/// |x|ᵀ|A||x| of the columns: a product xᵀAy is rounded by ε times the root of that of x and of y.
fn terms_of(matrix: Leading<'_>, columns: MatRef<'_, f64>) -> Vec<f64> {
    panels(columns.ncols()).flat_map(|panel| absolute_energy(matrix, columns.get(.., panel))).collect()
}

/// M-13, equation (29).
pub(super) fn block_coupling(evidence: &Evidence<'_>, terms: &Terms) -> Check {
    const FAIL: f64 = 1e-6;
    let measured = evidence.reduction.measured;
    let (i, j) = measured.block_coupling_at;
    // The block is Ψ_Dᵀ (K_IB + K_II Ψ_S): rounding of its terms, and of those of K U = 0, which the correction of Ψ_S puts
    // in their place. By Schwarz both stay below √(c_B c_η). How well the solve went does not enter.
    let share = NOISE_FACTOR * (terms.interface * terms.dynamic).sqrt();
    let limits =
        Limits { engineering: 1e-10, arithmetic: share * f64::EPSILON, data: share * data_noise(evidence.partition) };
    let limits = limits.capped(FAIL, MAX_EXCUSE);
    Check {
        id: "M-13",
        name: "interface and modes are uncoupled in stiffness",
        equation: "max |K̂_Bη| / √(K_BB K̂_ηη) (29), before it is set to zero",
        value: measured.block_coupling,
        limits,
        fail_above: limits.value().max(FAIL),
        worst: (measured.block_coupling > 0.0)
            .then(|| format!("{} and {}", coordinate_name(evidence, i), coordinate_name(evidence, j))),
    }
}

/// M-14, equations (34) and (35): backward error of the retained pairs in the reduced pencil; `of_digits` is what few digits leave of it.
pub(super) fn pair_residual(evidence: &Evidence<'_>, of_digits: f64) -> Check {
    let reduction = evidence.reduction;
    let modes = &evidence.retained.modes;
    let norms = reduced_norms(evidence);
    let held = evidence.partition.held_under(evidence.retained.boundary);
    let reduced = evidence.basis.reduced_modes(modes, evidence.partition.n_internal);
    let forces = dense::product(reduction.stiffness.as_ref(), reduced.as_ref());
    let momenta = dense::product(reduction.mass.as_ref(), reduced.as_ref());
    let limits = PairLimits::of(evidence, of_digits);
    let has_few_digits = data_noise(evidence.partition) > 0.0;
    // A held interface takes up the reaction: its rows are not part of the eigenproblem.
    let on_free_rows = |forces: Vec<f64>| -> Vec<f64> {
        let of_row = |(i, f): (usize, f64)| if held.get(i) == Some(&true) { 0.0 } else { f };
        forces.into_iter().enumerate().map(of_row).collect()
    };
    let mut worst = (0.0, limits.of_mode(evidence, 0, 0.0), None);
    for (j, lambda) in modes.lambda.iter().enumerate() {
        let (force, momentum) = (dense::column(forces.as_ref(), j), dense::column(momenta.as_ref(), j));
        let mode = dense::column(reduced.as_ref(), j);
        let residual = on_free_rows(force.iter().zip(momentum).map(|(f, p)| f - lambda * p).collect());
        let error = norms.backward_error(*lambda, mode, &residual);
        let of_cleared = || norms.backward_error(*lambda, mode, &on_free_rows(forces_of_cleared(evidence, mode)));
        let judged = limits.of_mode(evidence, j, if has_few_digits { of_cleared() } else { 0.0 });
        if dense::worse(judged.severity(error), worst.1.severity(worst.0)) {
            let at = norms.largest(&residual);
            worst = (error, judged, Some(format!("mode {}, {}", j + 1, coordinate_name(evidence, at))));
        }
    }
    let (value, Judged { limits, fail_above }, worst) = worst;
    Check {
        id: "M-14",
        name: "modes are eigenpairs of the reduced model",
        equation: "max ‖K̂v − λM̂v‖ / ((‖K̂‖ + λ‖M̂‖) ‖v‖) (34)–(35)",
        value,
        limits,
        fail_above,
        worst,
    }
}

/// What the residual of a mode may be.
struct PairLimits {
    arithmetic: f64,
    /// What few digits leave of it in the full model.
    data: f64,
}

impl PairLimits {
    fn of(evidence: &Evidence<'_>, of_digits: f64) -> Self {
        let modes = &evidence.retained.modes;
        let zero = zero_level(evidence);
        // A mode that is nearly spanned by the columns before it is put together from what little it adds to them.
        let dependence = evidence.reduction.n_reduced() as f64 * f64::EPSILON
            / independence(evidence, Columns::BeforeResidualVectors).0;
        let arithmetic = zero.arithmetic.max(dependence).max(repeated_rounding(modes)).max(coupling_rounding(modes));
        Self { arithmetic, data: zero.data.max(of_digits) }
    }

    /// The limits of a mode, with the backward error that few digits of K leave of it by the block set to zero in K̂, which M-13 measures. A mode
    /// whose column was left out lacks of its length what the other columns have not, up to [`INDEPENDENT`] of it, and the residual is that share
    /// of its terms, some times over for the other measure of length.
    fn of_mode(&self, evidence: &Evidence<'_>, mode: usize, of_cleared: f64) -> Judged {
        let is_left_out = evidence.basis.dropped.iter().any(|column| column.coordinate.mode() == Some(mode));
        let arithmetic = if is_left_out { self.arithmetic.max(NOISE_FACTOR * INDEPENDENT) } else { self.arithmetic };
        let limits = Limits { engineering: 1e-12, arithmetic, data: self.data + of_cleared };
        let limits = limits.capped(MAX_EXCUSE, MAX_EXCUSE);
        Judged { limits, fail_above: limits.value().max(1e-9) }
    }
}

/// Forces on a reduced mode [v_B; q] of the block between interface and modes that is set to zero in K̂: [K̂_Bη q; K̂_ηB v_B].
fn forces_of_cleared(evidence: &Evidence<'_>, mode: &[f64]) -> Vec<f64> {
    let cleared = evidence.reduction.cleared.as_ref();
    let (v_b, q) = mode.split_at(evidence.partition.n_interface());
    let on_interface = (0..v_b.len()).map(|i| (0..q.len()).map(|j| cleared[(i, j)] * q[j]).sum());
    let on_modes = (0..q.len()).map(|j| dense::dot(dense::column(cleared, j), v_b));
    on_interface.chain(on_modes).collect()
}

/// What rounding of K̂ and of the modes leaves of x_iᵀKx_j, in the scales of the coordinates, as in M-04: the row of a mode in the
/// residual of another one is nothing else. Its terms are √(c_i c_j) times the energies.
fn coupling_rounding(modes: &Modes) -> f64 {
    (NOISE_FACTOR * f64::EPSILON * modes.largest_cancellation()).min(HARMLESS_COUPLING)
}

/// What the basis of a repeated eigenvalue leaves of it: its copies are told apart by the rounding of the full model only,
/// and the reduced one has that rounding in its entries.
fn repeated_rounding(modes: &Modes) -> f64 {
    let copies = (1..modes.count()).filter(|j| modes.lambda[*j] == modes.lambda[j - 1]);
    copies.map(|j| REPEATED_WITHIN * f64::EPSILON * modes.errors[j].cancellation).fold(0.0, f64::max)
}

/// M-14, frequencies of the reduced model under the boundary of the retained modes.
pub(super) fn frequency_difference(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Check {
    let modes = &evidence.retained.modes;
    let mut worst = (0.0, None);
    for (j, lambda) in modes.lambda.iter().enumerate() {
        let reduced = spectrum.same_boundary.get(j).copied().unwrap_or(f64::INFINITY);
        let difference = 0.5 * (reduced / lambda - 1.0).abs();
        if dense::worse(difference, worst.0) {
            worst = (difference, Some(j));
        }
    }
    let Judged { limits, fail_above } = limits::of_frequencies(modes, evidence.partition);
    let (value, at) = worst;
    let of_digits = at.filter(|_| value > limits.value()).and_then(|mode| left_by_digits(evidence, mode, value));
    Check {
        id: "M-14",
        name: "reduced frequencies equal full ones",
        equation: "max |f_reduced / f − 1| under the same boundary (34)–(35)",
        value,
        limits,
        fail_above,
        worst: at.map(|mode| format!("mode {}{}", mode + 1, of_digits.unwrap_or_default())),
    }
}

/// Why a frequency differs, where few digits of K are the reason: rigid-body motion then makes forces, which the columns of the interface
/// take over, and the work 2 v_Bᵀ K̂_Bη q that these do on a mode is left out of K̂ with its block.
fn left_by_digits(evidence: &Evidence<'_>, mode: usize, difference: f64) -> Option<String> {
    if data_noise(evidence.partition) == 0.0 {
        return None;
    }
    let modes = &evidence.retained.modes;
    let reduced = evidence.basis.reduced_modes(modes, evidence.partition.n_internal);
    let mode_of = dense::column(reduced.as_ref(), mode);
    let forces = forces_of_cleared(evidence, mode_of);
    // The work of both forces is the same.
    let work = 0.5 * dense::dot(&forces, mode_of);
    // Half of the difference of λ, to first order; what is missing to the whole is of second order.
    let explained = (work / modes.lambda[mode]).abs();
    let words = "as rigid-body motion costs energy by the digits of the stiffness; write it with more";
    (explained >= 0.5 * difference).then(|| format!(", {words}"))
}

/// M-25, symmetry.
pub(super) fn symmetry(evidence: &Evidence<'_>, terms: &Terms) -> Check {
    const FAIL: f64 = 1e-6;
    let measured = evidence.reduction.measured;
    // Both triangles are rounded by ε times the terms of an entry, (|Ψ|ᵀ|A||Ψ|)_ij ≤ √(t_i t_j) with t those of the diagonal.
    let arithmetic = NOISE_FACTOR * f64::EPSILON * terms.interface.max(terms.dynamic).max(terms.mass);
    // Capped as the level of zero is.
    let limits = Limits { engineering: 1e-12, arithmetic, data: 0.0 }.capped(1e-4, 0.0);
    Check {
        id: "M-25",
        name: "reduced matrices are symmetric",
        equation: "max |K̂ − K̂ᵀ|_ij/√(s_i s_j), |M̂ − M̂ᵀ|_ij/√(M̂_ii M̂_jj) of the projections, s of K_BB and K̂_ηη",
        value: measured.stiffness_asymmetry.max(measured.mass_asymmetry),
        limits,
        fail_above: limits.value().max(FAIL),
        worst: None,
    }
}

/// M-25, definiteness of K̂ alone, by its eigenvalues in the scales of its coordinates with the rigid-body modes lifted.
pub(super) fn definite_stiffness(evidence: &Evidence<'_>, lifted: &[f64]) -> Check {
    let limits = zero_level(evidence);
    Check {
        id: "M-25",
        name: "reduced stiffness is not negative",
        equation: "max(0, −λ_min(K̂)) in the scales of the uncondensed stiffness",
        value: (-lifted.first().copied().unwrap_or(0.0)).max(0.0),
        limits,
        fail_above: limits.value(),
        worst: None,
    }
}

/// M-25, definiteness.
///
/// A mass that is singular is not a failure: rotations without inertia leave one. M-23 warns of it.
pub(super) fn definiteness(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Check {
    let stiffness = spectrum.negative_share();
    let by_itself = || Judged { limits: zero_level(evidence), fail_above: zero_level(evidence).value() };
    let of_stiffness = spectrum.first_elastic().map_or_else(by_itself, |_| energy_limits(evidence, spectrum));
    let (mass, of_mass) = ((-spectrum.lowest_mass.0).max(0.0), by_itself());
    let is_mass = dense::worse(mass / of_mass.limits.value(), stiffness / of_stiffness.limits.value());
    let (value, Judged { limits, fail_above }, which, at) = match is_mass {
        true => (mass, of_mass, "mass", spectrum.lowest_mass.1),
        false => (stiffness, of_stiffness, "stiffness", spectrum.softest),
    };
    let check = Check {
        id: "M-25",
        name: "reduced mass and stiffness are not negative",
        equation: "max(0, −λ_min(K̂, M̂)) / λ of the first elastic mode, max(0, −λ_min) of M̂ with unit diagonal",
        value,
        limits,
        fail_above,
        worst: (value != 0.0).then(|| format!("{which}, {}", coordinate_name(evidence, at))),
    };
    if is_mass { check } else { named_by_digits(evidence, spectrum, check) }
}
