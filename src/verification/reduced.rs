//! The reduced pencil: M-13, M-14, M-25.

use faer::{Mat, MatRef, Side};

use super::check::{Check, Limits};
use super::{Evidence, coordinate_scales, reduced_norms};
use crate::dense;
use crate::error::Result;
use crate::modes::Boundary;

/// Eigenvalues of the reduced pencil with its interface free, and under the boundary of the retained modes.
pub(super) struct Spectrum {
    /// All finite ones, ascending, interface free.
    free: Vec<f64>,
    /// Those under the boundary of the retained modes, zero modes left out.
    same_boundary: Vec<f64>,
    /// Zero modes of K̂.
    pub(super) n_zero: usize,
    /// The smallest eigenvalue of K̂ in the scales of its coordinates.
    lowest_stiffness: f64,
    /// Whether M̂ has a Cholesky factor.
    mass_is_definite: bool,
}

impl Spectrum {
    pub(super) fn of(evidence: &Evidence<'_>) -> Result<Self> {
        let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
        let n_b = evidence.partition.n_interface();
        let lambda = evidence.retained.modes.lambda.first().copied().unwrap_or(1.0);
        let scaled_stiffness = dense::symmetric_eigen(scaled_by(k, &coordinate_scales(evidence)).as_ref())?.0;
        let n_zero = evidence.rigid.count() + further_zero_modes(evidence)?;
        let free = lowest_eigenvalues(k, m, lambda)?;
        let same_boundary = match evidence.retained.boundary {
            Boundary::FreeInterface => free.get(evidence.rigid.count()..).unwrap_or_default().to_vec(),
            Boundary::FixedInterface => {
                let n = k.nrows() - n_b;
                lowest_eigenvalues(k.submatrix(n_b, n_b, n, n), m.submatrix(n_b, n_b, n, n), lambda)?
            }
        };
        Ok(Self {
            free,
            same_boundary,
            n_zero,
            lowest_stiffness: scaled_stiffness.first().copied().unwrap_or(0.0),
            mass_is_definite: equilibrated(m, m).llt(Side::Lower).is_ok(),
        })
    }

    /// The first eigenvalue of the free reduced model that is no zero mode: infinite where all are, not a number where the
    /// reduced pencil is too far from definite to have a spectrum.
    pub(super) fn first_elastic(&self) -> f64 {
        let beyond = if self.free.is_empty() { f64::NAN } else { f64::INFINITY };
        self.free.get(self.n_zero).copied().unwrap_or(beyond)
    }
}

/// Size below which an eigenvalue of K̂ in the scales of its coordinates is zero: rounding of its r terms before they
/// cancel, or the precision of the data.
pub(super) fn zero_level(evidence: &Evidence<'_>) -> Limits {
    let cancellation = evidence.constraint.cancellation;
    let precision = evidence.partition.precision.stiffness;
    Limits {
        engineering: 0.0,
        arithmetic: evidence.reduction.n_reduced() as f64 * f64::EPSILON * cancellation,
        data: if precision > f64::EPSILON { precision * cancellation } else { 0.0 },
    }
}

/// Zero modes of K̂ beside its rigid-body modes: with those lifted to order one, how many others stay at zero.
fn further_zero_modes(evidence: &Evidence<'_>) -> Result<usize> {
    let (k, u) = (&evidence.reduction.stiffness, &evidence.reduction.rigid_body_modes);
    let scales = coordinate_scales(evidence);
    let mut lifted = scaled_by(k.as_ref(), &scales);
    if u.ncols() > 0 {
        let scaled = Mat::from_fn(u.nrows(), u.ncols(), |i, j| u[(i, j)] / scales[i]);
        let z = scaled.qr().compute_thin_Q();
        dense::add_product(lifted.as_mut(), 1.0, z.as_ref(), z.transpose());
        dense::symmetrise(&mut lifted);
    }
    let (values, _) = dense::symmetric_eigen(lifted.as_ref())?;
    let zero = zero_level(evidence).value();
    Ok(values.iter().filter(|value| **value <= zero).count())
}

/// D A D.
fn scaled_by(a: MatRef<'_, f64>, scales: &[f64]) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] * scales[i] * scales[j])
}

/// D A D with powers of two D that bring the diagonal of `by` near one.
fn equilibrated(a: MatRef<'_, f64>, by: MatRef<'_, f64>) -> Mat<f64> {
    let scales: Vec<f64> = (0..by.nrows()).map(|i| dense::power_of_two_root(by[(i, i)])).collect();
    scaled_by(a, &scales)
}

/// Eigenvalues of K x = λ M x, ascending, accurate at the low end: θ = 1/(λ + α) of (M, K + αM) with α at the first
/// elastic eigenvalue, so that rounding is relative to the low eigenvalues and not to the high ones.
fn lowest_eigenvalues(k: MatRef<'_, f64>, m: MatRef<'_, f64>, alpha: f64) -> Result<Vec<f64>> {
    let n = k.nrows();
    let shifted = Mat::from_fn(n, n, |i, j| k[(i, j)] + alpha * m[(i, j)]);
    let scaled_m = equilibrated(m, shifted.as_ref());
    let scaled_k = equilibrated(shifted.as_ref(), shifted.as_ref());
    let Ok(factor) = scaled_k.llt(Side::Lower) else {
        return Ok(Vec::new());
    };
    let l = factor.L();
    let mut c = scaled_m;
    let par = faer::Par::Seq;
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(l, c.as_mut(), par);
    let mut c = c.transpose().to_owned();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(l, c.as_mut(), par);
    dense::symmetrise(&mut c);
    let (theta, _) = dense::symmetric_eigen(c.as_ref())?;
    let largest = theta.last().copied().unwrap_or(0.0);
    Ok(theta
        .into_iter()
        .rev()
        .take_while(|theta| *theta > f64::EPSILON * largest)
        .map(|theta| 1.0 / theta - alpha)
        .collect())
}

/// Rounding of the static solves, which the raw error of equation (24) shows. It is capped, so that a solve gone wrong
/// cannot excuse itself: a millionth is what the worst model that double precision can reduce leaves.
fn static_rounding(evidence: &Evidence<'_>) -> f64 {
    const WORST: f64 = 1e-6;
    evidence.constraint.raw_rigid_error.min(WORST)
}

/// M-13, equation (29).
pub(super) fn block_coupling(evidence: &Evidence<'_>) -> Check {
    let measured = evidence.reduction.measured;
    let (i, j) = measured.block_coupling_at;
    // The block is Ψ_Dᵀ times the residual of the static solve. Its rounding is that of K_II, which the raw error of
    // equation (24) shows.
    let limits = Limits { engineering: 1e-10, arithmetic: static_rounding(evidence), data: 0.0 };
    Check {
        id: "M-13",
        name: "interface and modes are uncoupled in stiffness",
        equation: "max |K̂_Bη| / √(K_BB K̂_ηη) (29), before it is set to zero",
        value: measured.block_coupling,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: (measured.block_coupling > 0.0).then(|| format!("coordinates {} and {}", i + 1, j + 1)),
    }
}

/// M-14, equations (34) and (35): backward error of the retained pairs in the reduced pencil.
pub(super) fn pair_residual(evidence: &Evidence<'_>) -> Check {
    let reduction = evidence.reduction;
    let modes = &evidence.retained.modes;
    let norms = reduced_norms(evidence);
    let n_b = evidence.partition.n_interface();
    let reduced = evidence.basis.reduced_modes(modes, evidence.partition.n_internal);
    let forces = dense::product(reduction.stiffness.as_ref(), reduced.as_ref());
    let momenta = dense::product(reduction.mass.as_ref(), reduced.as_ref());
    let mut worst = (0.0, None);
    for (j, lambda) in modes.lambda.iter().enumerate() {
        let (force, momentum) = (dense::column(forces.as_ref(), j), dense::column(momenta.as_ref(), j));
        let held = match evidence.retained.boundary {
            Boundary::FixedInterface => n_b,
            Boundary::FreeInterface => 0,
        };
        // A held interface takes up the reaction: its rows are not part of the eigenproblem.
        let residual: Vec<f64> = force
            .iter()
            .zip(momentum)
            .enumerate()
            .map(|(i, (f, p))| if i < held { 0.0 } else { f - lambda * p })
            .collect();
        let error = norms.backward_error(*lambda, dense::column(reduced.as_ref(), j), &residual);
        if dense::worse(error, worst.0) {
            worst = (error, Some(format!("mode {}", j + 1)));
        }
    }
    let limits = Limits { engineering: 1e-12, ..zero_level(evidence) };
    Check {
        id: "M-14",
        name: "modes are eigenpairs of the reduced model",
        equation: "max ‖K̂v − λM̂v‖ / ((‖K̂‖ + λ‖M̂‖) ‖v‖) (34)–(35)",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-9),
        worst: worst.1,
    }
}

/// M-14, frequencies of the reduced model under the boundary of the retained modes.
pub(super) fn frequency_difference(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Check {
    let modes = &evidence.retained.modes;
    let mut worst = (0.0, None);
    for (j, lambda) in modes.lambda.iter().enumerate() {
        let reduced = spectrum.same_boundary.get(j).copied().unwrap_or(f64::INFINITY);
        let difference = 0.5 * (reduced / lambda - 1.0).abs();
        if dense::worse(difference, worst.0) {
            worst = (difference, Some(format!("mode {}", j + 1)));
        }
    }
    let bars = modes.errors.iter().map(|error| error.relative_bar).fold(0.0, f64::max);
    let precision = evidence.partition.precision.stiffness;
    let share = f64::EPSILON / (f64::EPSILON + precision);
    // Both values carry the rounding of their quadratic forms, for which the error bars stand.
    let limits = Limits { engineering: 1e-9, arithmetic: 10.0 * bars * share, data: 10.0 * bars * (1.0 - share) };
    Check {
        id: "M-14",
        name: "reduced frequencies equal full ones",
        equation: "max |f_reduced / f − 1| under the same boundary (34)–(35)",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    }
}

/// M-25, symmetry.
pub(super) fn symmetry(evidence: &Evidence<'_>) -> Check {
    let measured = evidence.reduction.measured;
    Check {
        id: "M-25",
        name: "reduced matrices are symmetric",
        equation: "max |K̂ − K̂ᵀ|/|K̂|, |M̂ − M̂ᵀ|/|M̂| of the projections, which are then made symmetric to the bit",
        value: measured.stiffness_asymmetry.max(measured.mass_asymmetry),
        limits: Limits { engineering: 1e-12, arithmetic: static_rounding(evidence), data: 0.0 },
        fail_above: 1e-6,
        worst: None,
    }
}

/// M-25, definiteness.
pub(super) fn definiteness(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Check {
    let negative = (-spectrum.lowest_stiffness).max(0.0);
    let value = if spectrum.mass_is_definite { negative } else { f64::INFINITY };
    let limits = zero_level(evidence);
    Check {
        id: "M-25",
        name: "reduced mass is definite, stiffness not negative",
        equation: "M̂ = LLᵀ; max(0, −λ_min(K̂)), in the scales of the uncondensed stiffness",
        value,
        limits,
        fail_above: limits.value(),
        worst: (!spectrum.mass_is_definite).then(|| "the reduced mass has no Cholesky factor".to_owned()),
    }
}
