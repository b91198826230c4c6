//! Frequencies and their error bars against those found again: M-14, M-09.

use supel_runtime::Superelement;

use super::asked::AskedModes;
use super::entries::FAR;
use super::scaled::Scaled;
use crate::dense::{self, NOISE_FACTOR};
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
    let of_terms = asked.modes.errors.iter().map(|error| f64::EPSILON * error.cancellation).fold(0.0, f64::max);
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
    // Shapes turn by rounding, and where two eigenvalues are nearly one they turn far, and their bars with them.
    let limits_of = |mode: usize| {
        let turn = NOISE_FACTOR * asked.angles[mode].max(asked.turns_inside[mode]);
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
            Some(bar) => outside(2.0 * bar / frequency_hz * same_lambda, error.data_bar, NOISE_FACTOR * of_residual),
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
        equation: "max distance of (2 bar/f)(f_stated/f)² from [data, data + residual], relative to the nearer end",
        value,
        limits,
        fail_above: (FAR * limits.value()).min(NO_BAR),
        worst,
    }
}

/// How far a relative error bar lies outside of what it can be: the share of the data, and up to that of the residual more.
fn outside(bar: f64, of_data: f64, of_residual: f64) -> f64 {
    let (low, high) = (of_data, of_data + of_residual);
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
