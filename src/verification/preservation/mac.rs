//! The retained modes in the full and in the reduced model: M-15, and a row of the report for each.

use faer::{Mat, MatRef};

use super::super::check::{Check, Limits};
use super::super::evidence::{Evidence, reduced_norms};
use super::outcome::PreservedMode;
use crate::dense;
use crate::eigen::{CLUSTER_GAP, Spectral};
use crate::error::Result;
use crate::reduction::transpose_apply;
use crate::sparse::product;

/// Modes shown in the matrix of the report; more do not fit on a readable page.
const SHOWN: usize = 48;
/// Eigenvalues within this many error bars of one another are one cluster: which vectors span it is rounding.
const WITHIN_BARS: f64 = 10.0;

/// The retained modes as the reduced model has them.
pub(super) struct Preserved {
    pub(super) modes: Vec<PreservedMode>,
    pub(super) mac: Vec<Vec<f64>>,
}

/// Compares each retained mode x with the eigenvector y = Ψφ of the reduced model under the same boundary.
///
/// # Errors
/// A reduced pencil that is not definite.
pub(super) fn preserved(evidence: &Evidence<'_>) -> Result<Preserved> {
    let modes = &evidence.retained.modes;
    let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
    let (moving, n_zero) = (evidence.moving(), evidence.n_zero());
    let alpha = modes.lambda.first().copied().unwrap_or(1.0);
    let spectral = Spectral::of(dense::part(k, &moving).as_ref(), dense::part(m, &moving).as_ref(), alpha)?;
    let spectral = spectral.of_rank(evidence.reduction.mass_rank());
    let reduced: Vec<f64> = spectral.eigenvalues().into_iter().skip(n_zero).collect();
    let n_found = modes.count().min(reduced.len());
    let vectors: Vec<Vec<f64>> = (0..n_found).map(|j| spectral.eigenvector(n_zero + j)).collect();
    let phi = Mat::from_fn(moving.len(), n_found, |i, j| vectors[j][i]);
    let projected = projected_modes(evidence);
    let projected = Mat::from_fn(moving.len(), projected.ncols(), |i, j| projected[(moving[i], j)]);
    let cross = dense::gram(projected.as_ref(), phi.as_ref());
    let by_mode = cluster_mac(evidence, cross.as_ref());
    let errors = backward_errors(evidence);
    let hz = |lambda: f64| evidence.partition.scaling.hertz(lambda);
    let row = |j: usize| {
        let (full_hz, reduced_hz) = (hz(modes.lambda[j]), reduced.get(j).map_or(f64::INFINITY, |lambda| hz(*lambda)));
        PreservedMode {
            index: j + 1,
            full_hz,
            reduced_hz,
            relative_difference: (reduced_hz / full_hz - 1.0).abs(),
            backward_error: errors[j],
            mac: by_mode[j],
        }
    };
    let n_shown = n_found.min(SHOWN);
    let mac = (0..n_shown).map(|i| (0..n_shown).map(|j| cross[(i, j)].powi(2)).collect()).collect();
    Ok(Preserved { modes: (0..modes.count()).map(row).collect(), mac })
}

/// ΨᵀM X, r × k, with the full mass matrix.
fn projected_modes(evidence: &Evidence<'_>) -> Mat<f64> {
    let shapes = &evidence.retained.modes.shapes;
    let n = evidence.partition.n_dofs();
    let padded = Mat::from_fn(n, shapes.ncols(), |i, j| if i < shapes.nrows() { shapes[(i, j)] } else { 0.0 });
    transpose_apply(evidence.basis, product(&evidence.partition.mass, padded.as_ref()).as_ref())
}

/// The squared smallest singular value of X_cᵀ M Y_c for the cluster of every mode; zero where Y lacks it.
fn cluster_mac(evidence: &Evidence<'_>, cross: MatRef<'_, f64>) -> Vec<f64> {
    let modes = &evidence.retained.modes;
    let n = modes.count();
    let mut by_mode = Vec::with_capacity(n);
    let mut start = 0;
    while start < n {
        let mut end = start + 1;
        while end < n && {
            let bar = modes.errors[end].relative_bar.max(modes.errors[end - 1].relative_bar);
            let gap = CLUSTER_GAP.max(WITHIN_BARS * bar);
            modes.lambda[end] - modes.lambda[end - 1] <= gap * modes.lambda[end]
        } {
            end += 1;
        }
        let smallest = (end <= cross.ncols())
            .then(|| dense::right_singular(cross.submatrix(start, start, end - start, end - start)).ok())
            .flatten()
            .and_then(|(singular, _)| singular.last().copied());
        // Rounding may carry a perfect match past one.
        by_mode.resize(end, smallest.map_or(0.0, |value| value.powi(2).min(1.0)));
        start = end;
    }
    by_mode
}

/// Backward error of every (λ, V̄) in the reduced pencil.
fn backward_errors(evidence: &Evidence<'_>) -> Vec<f64> {
    let held = evidence.partition.held_under(evidence.retained.boundary);
    let (reduction, modes) = (evidence.reduction, &evidence.retained.modes);
    let norms = reduced_norms(evidence);
    let reduced = evidence.basis.reduced_modes(modes, evidence.partition.n_internal);
    let forces = dense::product(reduction.stiffness.as_ref(), reduced.as_ref());
    let momenta = dense::product(reduction.mass.as_ref(), reduced.as_ref());
    let error = |(j, lambda): (usize, &f64)| {
        let pairs = dense::column(forces.as_ref(), j).iter().zip(dense::column(momenta.as_ref(), j)).enumerate();
        // A held interface takes up the reaction: its rows are not part of the eigenproblem.
        let residual: Vec<f64> =
            pairs.map(|(i, (f, p))| if held.get(i) == Some(&true) { 0.0 } else { f - lambda * p }).collect();
        norms.backward_error(*lambda, dense::column(reduced.as_ref(), j), &residual)
    };
    modes.lambda.iter().enumerate().map(error).collect()
}

/// M-15.
pub(super) fn check(modes: &[PreservedMode]) -> Check {
    let mut worst = (0.0, None);
    for mode in modes {
        if dense::worse(1.0 - mode.mac, worst.0) {
            worst = (1.0 - mode.mac, Some(format!("mode {}", mode.index)));
        }
    }
    Check {
        id: "M-15",
        name: "mode shapes are preserved",
        equation: "1 − min σ²(X_cᵀ M Ψφ_c) over clusters of modes",
        value: worst.0,
        // A MAC of 0.999 is what practice asks of a reduction, 0.9 what it asks of a test.
        limits: Limits { engineering: 1e-3, ..Limits::default() },
        fail_above: 0.1,
        worst: worst.1,
    }
}
