//! Frequencies and their error bars against those found again: M-14, M-09.

use supel_runtime::Superelement;

use super::asked::AskedModes;
use super::entries::FAR;
use super::scaled::Scaled;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::{ModeError, Modes, RESIDUAL_FLOOR, frequency_bar, mean_is_away, taken_for_one};
use crate::sparse::Precision;
use crate::verification::check::{Check, Limits};
use crate::verification::limits::LARGEST_EXCUSE;

/// Of an error bar the share of the arithmetic: both frequencies were computed from the same data.
fn share_of_arithmetic(precision: Precision) -> f64 {
    f64::EPSILON / (f64::EPSILON + precision.stiffness.share)
}

/// M-14: stated frequencies against those found again.
pub(super) fn frequencies(file: &Scaled, asked: &AskedModes, precision: Precision) -> Check {
    let mut worst = (0.0, None);
    for (mode, (stored, found)) in file.lambda.iter().zip(asked.lambda()).enumerate() {
        let difference = 0.5 * (stored / found - 1.0).abs();
        if dense::worse(difference, worst.0) {
            worst = (difference, Some(format!("mode {}", mode + 1)));
        }
    }
    let bars = asked.modes.errors.iter().map(|error| error.relative_bar).fold(0.0, f64::max);
    // Roundings of the terms, those of a heavy mass among them, of which digits of K are no measure.
    let of_terms = f64::EPSILON * asked.modes.largest_cancellation();
    let arithmetic = NOISE_FACTOR * of_terms.max(bars * share_of_arithmetic(precision));
    // A shape that is turned by an angle has a Rayleigh quotient that is off by the square.
    let turned = asked.angles.iter().map(|angle| NOISE_FACTOR * angle * angle).fold(0.0, f64::max);
    let limits =
        Limits { engineering: 1e-10, arithmetic: arithmetic.max(turned), data: 0.0 }.capped(LARGEST_EXCUSE, 0.0);
    Check {
        id: "M-14",
        name: "frequencies are those of the full model",
        equation: "max |f_stated / f − 1|, f by another eigensolver on K − σM",
        value: worst.0,
        limits,
        fail_above: FAR * limits.value(),
        worst: worst.1,
    }
}

/// M-09: error bars are those of the modes found again. The share of the data is one of shapes and matrices alone; what the residual
/// adds is another eigensolver's own and may be anything up to a bound.
pub(super) fn error_bars(superelement: &Superelement, file: &Scaled, asked: &AskedModes) -> Check {
    /// Relative difference of the share of the data: shapes that differ by rounding have the same.
    const SAME_SHAPES: f64 = 1e-6;
    /// Relative difference of a bar that no turn of a shape excuses.
    const LARGEST_TURN: f64 = 0.1;
    /// Relative difference of a bar that fails in any case: a bar of zero is off by one.
    const NO_BAR: f64 = 0.5;
    let metadata = superelement.metadata();
    let (of_products, of_data) = (turned_by_products(&asked.modes), shares_of_data(&asked.modes));
    // Shapes turn by rounding, and where two eigenvalues are nearly one they turn far, and their bars with them.
    let limits_of = |mode: usize| {
        let turn = NOISE_FACTOR * asked.angles[mode].max(asked.turns_inside[mode]).max(of_products[mode]);
        Limits { engineering: SAME_SHAPES, arithmetic: turn, data: 0.0 }.capped(LARGEST_TURN, 0.0)
    };
    let limits_of_none = Limits { engineering: SAME_SHAPES, ..Limits::default() };
    let (mut excess, mut value, mut limits, mut worst) = (0.0, 0.0, limits_of_none, None);
    for coordinate in metadata.named_columns() {
        let Some((mode, frequency_hz)) = coordinate.mode() else { continue };
        let error_bar_hz = coordinate.error_bar_hz();
        let (Some(error), Some(stated)) = (asked.modes.errors.get(mode), file.lambda.get(mode)) else { continue };
        let of_residual = error.residual_bar.max(asked.residual_bars[mode]);
        // A bar is what roundings make of an energy over λ, and λ may be known to a few digits only: energies are compared.
        let same_lambda = stated / asked.lambda()[mode];
        let found = match error_bar_hz {
            Some(bar) => {
                let [low, high] = of_data[mode];
                let high = high.max(reach_of_mean(*stated, file, (asked, &of_data)));
                let of_lambda = [low, high + NOISE_FACTOR * of_residual];
                // Frequencies have bars of their own, which reach to the farther root.
                outside(bar / frequency_hz, of_lambda.map(|bar| frequency_bar(bar / same_lambda, 1.0)))
            }
            None if error.relative_bar.is_finite() => f64::INFINITY,
            None => 0.0,
        };
        if dense::worse(found / limits_of(mode).value(), excess) {
            (excess, value, limits) = (found / limits_of(mode).value(), found, limits_of(mode));
            worst = Some(format!("mode {}", mode + 1));
        }
    }
    Check {
        id: "M-09",
        name: "error bars are those of the full model",
        equation: "max distance of bar/f from 1 − √(1 − β), β from that of the data to data + residual, relative to the nearer end",
        value,
        limits,
        fail_above: (FAR * limits.value()).min(NO_BAR),
        worst,
    }
}

/// What the share of the data in each bar may be, at least and at most. Of two frequencies a few roundings apart one eigensolver makes their
/// mean, with a bar that reaches both, and another one does not.
fn shares_of_data(modes: &Modes) -> Vec<[f64; 2]> {
    let of_mode = |(error, n_alike): (&ModeError, usize)| {
        let away = mean_is_away(error.cancellation, n_alike);
        // Without digits that are missing the bar of a mean is so many times that of one.
        let least = error.data_bar / (2 * n_alike - 1) as f64;
        [least.max(error.data_bar - away), error.data_bar + away]
    };
    modes.errors.iter().zip(taken_for_one(&modes.lambda, &modes.errors)).map(of_mode).collect()
}

/// How far the bar of a mean has to reach that a file states for several modes, relative to it: to all of these as they were found again, whether
/// or not the same ones were taken for one then; nothing where a file states an eigenvalue once.
fn reach_of_mean(stated: f64, file: &Scaled, (asked, of_data): (&AskedModes, &[[f64; 2]])) -> f64 {
    let found = file.lambda.iter().zip(asked.lambda()).zip(of_data);
    let of_mean = found.filter(|((other, _), _)| **other == stated);
    let reaches: Vec<f64> = of_mean.map(|((_, lambda), [_, high])| (lambda / stated - 1.0).abs() + high).collect();
    if reaches.len() > 1 { reaches.into_iter().fold(0.0, f64::max) } else { 0.0 }
}

/// What rounding of products makes of the terms of each mode, relative to them. An eigensolver takes a pair at 16 ε of the largest terms and
/// of the largest θ. By so much of its length a shape is turned along a motion that has terms c_max and next to no mass, and terms of
/// c_j change by twice √(c_max / c_j) times that.
fn turned_by_products(modes: &Modes) -> Vec<f64> {
    let largest = modes.largest_cancellation();
    let turned = 2.0 * RESIDUAL_FLOOR * f64::EPSILON * largest * modes.spread();
    modes.errors.iter().map(|error| turned * (largest / error.cancellation).sqrt()).collect()
}

/// How far a relative error bar lies outside of what it can be.
fn outside(bar: f64, [low, high]: [f64; 2]) -> f64 {
    if bar < low {
        (low - bar) / low
    } else if bar > high {
        (bar - high) / high
    } else if bar.is_nan() {
        bar
    } else {
        0.0
    }
}
