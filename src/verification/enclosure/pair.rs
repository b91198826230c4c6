//! Computed pairs with bounds of their residuals.

use faer::{Mat, MatRef};
use rayon::prelude::*;

use super::exact;
use super::metric::Metric;
use crate::dense;
use crate::eigen::Modes;
use crate::factor::SolveOperator;
use crate::rigid::RigidBodyModes;
use crate::twofold::{Twofold, UNIT};

/// A computed mode, λ̃ and ρ.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    /// λ̃: the Rayleigh quotient to twice the working precision, rounded.
    pub(super) lambda: f64,
    /// μ̃ = λ̃ − σ.
    pub(super) mu: f64,
    /// ρ, an upper bound.
    pub(super) residual: f64,
    /// Absolute error of λ̃ as a Rayleigh quotient, an upper bound.
    pub(super) rounding: f64,
    /// x / ‖x‖ and K_s x / ‖x‖ in the norm of K_s, for the angles between modes.
    x: Vec<f64>,
    image: Vec<f64>,
}

/// Roundings of one operation, and of a bound's own few.
const U: f64 = f64::EPSILON;
/// What covers the rounding of a bound's own computation.
const OUTWARD: f64 = 1.0 + 1e-10;

impl Pair {
    /// |cos| of the angle to another mode in the inner product of K_s, an upper bound.
    pub(super) fn cosine(&self, other: &Self) -> f64 {
        let terms: f64 = self.x.iter().zip(&other.image).map(|(a, b)| (a * b).abs()).sum();
        // The image is rounded once; the sum adds a rounding for each term.
        dense::dot(&self.x, &other.image).abs() + (self.x.len() + 2) as f64 * U * terms
    }
}

/// Zero modes first, then the elastic ones, in ascending order as the modes have it.
pub(super) fn pairs(metric: &Metric<'_>, zero_modes: Option<&RigidBodyModes>, modes: &Modes) -> Vec<Pair> {
    // λ̃ of a zero mode is zero; that of the others is computed.
    let zero = zero_modes.map(|rigid| (rigid.orthonormal.as_ref(), Some(0.0)));
    let blocks: Vec<(MatRef<'_, f64>, Option<f64>)> = zero.into_iter().chain([(modes.shapes.as_ref(), None)]).collect();
    let columns: Vec<(&[f64], Option<f64>)> = blocks
        .iter()
        .flat_map(|(block, known)| (0..block.ncols()).map(|j| (dense::column(*block, j), *known)))
        .collect();
    let started: Vec<Started> = columns.into_par_iter().map(|(x, known)| Started::of(metric, x, known)).collect();
    let mut solutions = Mat::from_fn(metric.scale.len(), started.len(), |i, j| started[j].residual[i]);
    metric.factor.solve_in_place(solutions.as_mut());
    let solutions = solutions.as_ref();
    started
        .into_par_iter()
        .enumerate()
        .map(|(j, started)| started.finish(metric, dense::column(solutions, j)))
        .collect()
}

/// A pair before K_s y = r is solved.
struct Started {
    lambda: f64,
    rounding: f64,
    /// ‖x‖ in the norm of K_s, from below.
    length: f64,
    residual: Vec<f64>,
    /// Bound of the error of each entry of the residual.
    error: Vec<f64>,
    x: Vec<f64>,
    image: Vec<f64>,
}

impl Started {
    fn of(metric: &Metric<'_>, x: &[f64], known: Option<f64>) -> Self {
        let (force, momentum) = (exact::product(metric.pencil.stiffness, x), exact::product(metric.pencil.mass, x));
        let (energy, inertia) = (exact::dot(x, &force.image).value(), exact::dot(x, &momentum.image).value());
        let lambda = known.unwrap_or(energy / inertia);
        let sums = |terms: &[f64]| x.iter().zip(terms).map(|(x, t)| x.abs() * t).sum::<f64>();
        // Each of the n terms of a sum of twice the precision may lose one unit of it.
        let many = (x.len() + 8) as f64 * UNIT;
        let (energy_error, inertia_error) = (many * sums(&force.terms), many * sums(&momentum.terms));
        let rounding = 4.0 * U * lambda.abs() + (energy_error + lambda.abs() * inertia_error) / inertia;
        let square = energy - metric.sigma * inertia;
        let square_error =
            4.0 * U * (energy.abs() - metric.sigma * inertia) + energy_error - metric.sigma * inertia_error;
        let row = |i: usize| {
            let residual = force.image[i] - momentum.image[i] * lambda;
            let terms = force.terms[i] + lambda.abs() * momentum.terms[i];
            (residual.value(), U * residual.value().abs() + many * terms)
        };
        let (residual, error): (Vec<f64>, Vec<f64>) = (0..x.len()).map(row).unzip();
        let length = (square - square_error).max(0.0).sqrt();
        let of_length = |value: f64| value / length;
        let image =
            (0..x.len()).map(|i| (force.image[i] - momentum.image[i] * metric.sigma).value() / length).collect();
        Self { lambda, rounding, length, residual, error, x: x.iter().copied().map(of_length).collect(), image }
    }

    /// ‖r‖_{K_s⁻¹} ≤ ‖y‖_{K_s} + ‖r̃ − K_s y‖_{K_s⁻¹} + ‖r − r̃‖_{K_s⁻¹} for any y; the factor made a good one.
    fn finish(self, metric: &Metric<'_>, y: &[f64]) -> Pair {
        let (force, momentum) = (exact::product(metric.pencil.stiffness, y), exact::product(metric.pencil.mass, y));
        let many = (y.len() + 8) as f64 * UNIT;
        let image = |i: usize| force.image[i] - momentum.image[i] * metric.sigma;
        let terms = |i: usize| force.terms[i] - metric.sigma * momentum.terms[i];
        let images: Vec<Twofold> = (0..y.len()).map(image).collect();
        let energy_terms: f64 = y.iter().enumerate().map(|(i, y)| y.abs() * terms(i)).sum();
        let energy = (exact::dot(y, &images).value() + many * energy_terms).max(0.0).sqrt();
        let left = (0..y.len()).map(|i| {
            let left = (Twofold::from(self.residual[i]) - images[i]).value();
            left.abs() * (1.0 + U) + many * terms(i) + self.error[i]
        });
        let residual = OUTWARD * (energy * (1.0 + 4.0 * U) + metric.dual_bound(left)) / self.length;
        Pair {
            lambda: self.lambda,
            mu: self.lambda - metric.sigma,
            residual,
            rounding: self.rounding,
            x: self.x,
            image: self.image,
        }
    }
}
