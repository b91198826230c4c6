//! How well modes are known: Rayleigh quotients, backward errors, error bars.

use std::ops::Range;

use faer::{Mat, MatRef};

use super::problem::Problem;
use super::{CLUSTER_GAP, Equilibrated, ModalProblem, zero};
use crate::dense;
use crate::sparse::energies_of_terms;
use crate::sparse::{Leading, panels, product, product_and_terms};

/// What is known of the error of one mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModeError {
    /// Normwise backward error of the pair (M-01).
    pub backward: f64,
    /// ‖Dr‖ / ‖D(|K| + λ|M|)|x|‖: the residual over the terms it is summed from, which the norms of the whole do not hide where a few
    /// soft motions are all of ‖M‖.
    pub of_terms: f64,
    /// c = (|x|ᵀ|K||x| + λ|x|ᵀ|M||x|) / (λ xᵀMx): how much larger the cancelling terms are than the modal energy (M-09).
    pub cancellation: f64,
    /// Relative error bar of λ: that of the data and that of the residual.
    pub relative_bar: f64,
    /// The share of the arithmetic, ε c, and of the digits of the data: their precision times its share of c, or where the entries
    /// of K are known one by one what their roundings add up to but for a chance of [`crate::partition::CHANCE_OF_MORE`].
    pub data_bar: f64,
    /// The share of the residual: what the eigensolver left, by Kato and Temple.
    pub residual_bar: f64,
    /// ε ‖K‖ ‖x‖² / xᵀMx, equilibrated: an eigenvalue of this size is rounding of the program that wrote K, whatever the terms of
    /// xᵀKx, which may all vanish for a matrix that was itself projected.
    pub rounding_floor: f64,
    /// λ up to which the motion costs no energy as far as anybody can tell; see `modes::zero`.
    pub zero_level: f64,
}

impl ModeError {
    /// The error bar of a frequency, in its unit.
    pub fn bar_of(&self, frequency: f64) -> f64 {
        frequency_bar(self.relative_bar, frequency)
    }
}

/// The error bar of a frequency, in its unit, by the relative bar of its λ: as far as the farther root of λ (1 ± bar), zero for what is
/// below it. That is the lower one up to bar = 3; to first order it is half the bar.
pub(crate) fn frequency_bar(bar_of_lambda: f64, frequency: f64) -> f64 {
    let share = match bar_of_lambda {
        bar if bar < 1.0 => bar / (1.0 + (1.0 - bar).sqrt()),
        bar if bar < 3.0 => 1.0,
        bar => (1.0 + bar).sqrt() - 1.0,
    };
    share * frequency.abs()
}

/// The relative bar of λ that an error bar of a frequency stands for: the inverse of [`frequency_bar`], and the largest where it has several.
pub(crate) fn bar_of_lambda(bar: f64, frequency: f64) -> f64 {
    match (bar / frequency).abs() {
        share if share < 1.0 => share * (2.0 - share),
        share => share * (2.0 + share),
    }
}

/// Relative error bar of a frequency that is worth a look: what a modal test resolves, the limit of M-09.
pub const NOTICED_BAR: f64 = 1e-4;

/// Components of a mode nearer than this, relatively, are of one size: far above the error of a mode, far below what differs
/// by design.
const ALIKE: f64 = 1e-6;

/// Scales every column to xᵀMx = 1, largest component positive.
pub(super) fn normalise(mass: Leading<'_>, shapes: &mut Mat<f64>) {
    let images = product(mass, shapes.as_ref());
    for j in 0..shapes.ncols() {
        let column = dense::column(shapes.as_ref(), j);
        let length = dense::dot(column, dense::column(images.as_ref(), j)).max(0.0).sqrt();
        // The first of the largest components decides the sign, so that it does not flip from run to run; in symmetric
        // structures many are the largest but for rounding.
        let largest = column.iter().fold(0.0f64, |max, value| max.max(value.abs()));
        let decisive = column.iter().find(|value| value.abs() >= (1.0 - ALIKE) * largest).copied().unwrap_or(1.0);
        let factor = decisive.signum() / length;
        dense::column_mut(shapes.as_mut(), j).iter_mut().for_each(|value| *value *= factor);
    }
}

/// λ = xᵀKx of M-orthonormal shapes, what is known of their errors but for the residual, and r = Kx − λMx.
pub(crate) fn rayleigh_quotients(
    problem: ModalProblem<'_>,
    shapes: MatRef<'_, f64>,
) -> (Vec<f64>, Vec<ModeError>, Mat<f64>) {
    let both = |matrix| {
        let (image, terms) = product_and_terms(matrix, shapes);
        let energies = energies_of_terms(shapes, terms.as_ref());
        (image, terms, energies)
    };
    let (mut forces, force_terms, mut stiffness_terms) = both(problem.stiffness);
    if let Some(noise) = problem.noise {
        stiffness_terms.iter_mut().zip(noise.hidden_terms(shapes)).for_each(|(terms, more)| *terms += more);
    }
    let (momenta, momentum_terms, mass_terms) = both(problem.mass);
    let norms = Equilibrated::of(problem.pencil());
    let rounding = f64::EPSILON;
    let quotient = |j: usize| {
        let (x, momentum) = (dense::column(shapes, j), dense::column(momenta.as_ref(), j));
        let modal_mass = dense::dot(x, momentum);
        [dense::dot(x, dense::column(forces.as_ref(), j)) / modal_mass, modal_mass]
    };
    let quotients: Vec<[f64; 2]> = (0..shapes.ncols()).map(quotient).collect();
    let noise = energy_noise(problem, shapes, &stiffness_terms);
    let mass_noise = problem.noise.and_then(|noise| noise.mass_noise(shapes));
    let (lambda, errors) = (0..shapes.ncols())
        .map(|j| {
            let x = dense::column(shapes, j);
            let (force, momentum) = (dense::column_mut(forces.as_mut(), j), dense::column(momenta.as_ref(), j));
            let [lambda, modal_mass] = quotients[j];
            dense::add_scaled(force, -lambda, momentum);
            let (k_share, m_share) = (stiffness_terms[j] / (lambda.abs() * modal_mass), mass_terms[j] / modal_mass);
            let of_mass = match &mass_noise {
                Some(noise) => noise[j] / modal_mass,
                None => problem.precision.mass.share * m_share,
            };
            let digits = noise[j] / (lambda.abs() * modal_mass) + of_mass;
            let data_bar = digits + rounding * (k_share + m_share);
            let rounding_floor = rounding * norms.stiffness_norm * norms.scaled_norm(x).powi(2) / modal_mass;
            let error = ModeError {
                backward: norms.backward_error(lambda, x, force),
                of_terms: norms.error_of_terms(
                    lambda,
                    force,
                    [&force_terms, &momentum_terms].map(|terms| dense::column(terms.as_ref(), j)),
                ),
                cancellation: k_share + m_share,
                relative_bar: data_bar,
                data_bar,
                residual_bar: 0.0,
                rounding_floor,
                zero_level: zero::level(
                    noise[j] / modal_mass,
                    rounding * stiffness_terms[j] / modal_mass,
                    rounding_floor,
                ),
            };
            (lambda, error)
        })
        .unzip();
    (lambda, errors, forces)
}

/// What the digits of K leave open of xᵀKx: its precision times the terms, or less, where few digits are known entry by entry.
fn energy_noise(problem: ModalProblem<'_>, shapes: MatRef<'_, f64>, terms: &[f64]) -> Vec<f64> {
    let of_entries = problem.noise.and_then(|noise| noise.energy_noise(shapes));
    of_entries.unwrap_or_else(|| terms.iter().map(|terms| problem.precision.stiffness.share * terms).collect())
}

/// Adds to the error bars what the residuals leave in doubt; one solve for each mode.
///
/// With y = (K − σM)⁻¹ r and δ² = rᵀy / (λ − σ), some θ = 1/(λ − σ) lies within the relative distance δ of the Rayleigh
/// quotient's, and for a group of modes that are a relative distance γ of θ away from all others within Σδ²/γ (Kato 1949,
/// Temple 1928), δ added up over the group. What a residual moves along the rigid-body modes, which deflation took out,
/// counts (‖Qᵀr‖/λ)².
///
/// With σ inside the spectrum rᵀy is not a square any more; δ² is then yᵀMy, since y = (λ − σ) (OP x − θx).
///
/// `around` are the nearest other eigenvalues below the lowest and above the highest mode, or what they lie beyond.
pub(super) fn add_residual_bars(
    problem: Problem<'_>,
    lambda: &[f64],
    errors: &mut [ModeError],
    mut residuals: Mat<f64>,
    around: [Option<f64>; 2],
) {
    let sigma = problem.operator.shift();
    let resultants = dense::gram(problem.deflated[0], residuals.as_ref());
    let is_inside = lambda.iter().any(|lambda| *lambda < sigma);
    let energies = if is_inside || resultants.nrows() > 0 {
        problem.equilibrate(residuals.as_mut());
        let mut y = residuals.clone();
        problem.operator.solve_in_place(y.as_mut());
        problem.deflate(y.as_mut());
        let momenta = if is_inside { product(problem.mass, y.as_ref()) } else { residuals };
        dense::dots(momenta.as_ref(), y.as_ref())
    } else {
        problem.operator.compliances(residuals.as_ref())
    };
    let over = |lambda: f64| if is_inside { 1.0 } else { (lambda - sigma).abs() };
    let squares: Vec<f64> = energies.iter().zip(lambda).map(|(energy, lambda)| energy.abs() / over(*lambda)).collect();
    for group in groups(lambda, sigma) {
        let sum: f64 = squares[group.clone()].iter().sum();
        for j in group.clone() {
            let of_theta = sum.sqrt().min(sum / gap_of(lambda, (j, &group), (sigma, around)));
            let resultant: f64 = (0..resultants.nrows()).map(|i| (resultants[(i, j)] / lambda[j]).powi(2)).sum();
            let error = &mut errors[j];
            error.residual_bar = of_theta * (1.0 - sigma / lambda[j]).abs() + resultant;
            error.relative_bar = error.data_bar + error.residual_bar;
        }
    }
}

/// Widens the error bars of modes that were judged by themselves, as if nothing were below the first and above the last, to what they are with
/// the nearest others there; σ is that of [`add_residual_bars`]. Where a bar is Σδ²/γ it grows as γ shrinks, up to Σδ.
pub(crate) fn bars_with_neighbours(lambda: &[f64], errors: &mut [ModeError], (sigma, around): (f64, [Option<f64>; 2])) {
    for group in groups(lambda, sigma) {
        for j in group.clone() {
            let gap = |around| gap_of(lambda, (j, &group), (sigma, around));
            let (alone, own) = (gap([None, None]), errors[j].residual_bar);
            let most = own.max((own * alone * (1.0 - sigma / lambda[j]).abs()).sqrt());
            let error = &mut errors[j];
            error.residual_bar = (own * alone / gap(around)).min(most);
            error.relative_bar = error.data_bar + error.residual_bar;
        }
    }
}

/// Modes with near eigenvalues.
fn groups(lambda: &[f64], sigma: f64) -> Vec<Range<usize>> {
    let mut groups = Vec::new();
    let mut first = 0;
    for end in 1..=lambda.len() {
        let is_near = |end: usize| (lambda[end] - lambda[end - 1]).abs() <= CLUSTER_GAP * (lambda[end] - sigma).abs();
        if end == lambda.len() || !is_near(end) {
            groups.push(first..end);
            first = end;
        }
    }
    groups
}

/// γ: how far θ of a mode is from all others but those of its group, relative to it.
fn gap_of(lambda: &[f64], (mode, group): (usize, &Range<usize>), (sigma, around): (f64, [Option<f64>; 2])) -> f64 {
    let below = group.start.checked_sub(1).map(|below| lambda[below]).or(around[0]);
    let above = lambda.get(group.end).copied().or(around[1]);
    relative_gap(lambda[mode] - sigma, below.map(|l| l - sigma), above.map(|l| l - sigma))
}

/// The distance of θ = 1/μ to those of the neighbours, relative to it; the infinite eigenvalues of massless motions are at
/// θ = 0.
fn relative_gap(mu: f64, below: Option<f64>, above: Option<f64>) -> f64 {
    let distance = |other: f64| (mu / other - 1.0).abs();
    [below, above].into_iter().flatten().map(distance).fold(1.0, f64::min)
}

/// How far some modes are from orthonormal in the mass.
#[derive(Clone, Copy, Debug, Default)]
pub struct MassOrthogonality {
    /// max |XᵀMX − I| over all pairs (M-03).
    pub error: f64,
    /// The pair it is reached at.
    pub pair: (usize, usize),
    /// max |x|ᵀ|M||x|: how large the terms are that the products are summed from.
    pub largest_terms: f64,
}

/// Measures it, one panel of modes after the other.
pub fn mass_orthogonality<'a>(mass: impl Into<Leading<'a>>, shapes: MatRef<'_, f64>) -> MassOrthogonality {
    let mass = mass.into();
    let mut found = MassOrthogonality::default();
    for columns in panels(shapes.ncols()) {
        let (start, panel) = (columns.start, shapes.get(.., columns.clone()));
        let (images, terms) = product_and_terms(mass, panel);
        found.largest_terms = energies_of_terms(panel, terms.as_ref()).into_iter().fold(found.largest_terms, f64::max);
        let products = dense::gram(shapes.subcols(0, columns.end), images.as_ref());
        for j in 0..panel.ncols() {
            for i in 0..=start + j {
                let error = (products[(i, j)] - f64::from(u8::from(i == start + j))).abs();
                if dense::worse(error, found.error) {
                    (found.error, found.pair) = (error, (i, start + j));
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{bar_of_lambda, frequency_bar};

    /// A bar of λ holds λ (1 ± bar), and that of the frequency the roots of both, zero for what is below it.
    #[test]
    fn bars_of_frequencies_hold_the_roots_of_those_of_eigenvalues() {
        for bar in [1e-12, 1e-3, 0.028, 0.5, 0.999, 1.0, 2.0, 3.0, 8.0, 1e6, 1e18] {
            let above = 2.0 * f64::sqrt(1.0 + bar) - 2.0;
            let below = 2.0 - 2.0 * f64::sqrt((1.0 - bar).max(0.0));
            let (farther, found) = (above.max(below), frequency_bar(bar, -2.0));
            // The roots themselves are rounded, twice each, and so is their distance from two.
            assert!((found - farther).abs() <= 8.0 * f64::EPSILON * (1.0 + farther), "{bar}: {found} {farther}");
            // Between one and three all bars reach to zero. Elsewhere roundings of the share grow by the slope of its square.
            let (back, expected) = (bar_of_lambda(found, -2.0), if (1.0..3.0).contains(&bar) { 3.0 } else { bar });
            assert!((back - expected).abs() <= 16.0 * f64::EPSILON * (1.0 + expected), "{bar}: {back}");
        }
        assert_eq!((frequency_bar(f64::INFINITY, 1.0), frequency_bar(0.0, 1.0)), (f64::INFINITY, 0.0));
        assert!(frequency_bar(f64::NAN, 1.0).is_nan());
    }
}
