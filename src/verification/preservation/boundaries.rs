//! Frequencies of the reduced against the full model under the boundaries of the scene: M-24.

use super::outcome::{BoundaryComparison, FrequencyPair};
use super::reduced::{Answers, Quotient, quotients};
use super::reference::{ROUNDINGS, Reference};
use crate::dense;
use crate::eigen::{ModeError, zero};
use crate::error::Result;
use crate::number::counted;
use crate::verification::check::{Check, Limits};
use crate::verification::evidence::{Evidence, data_noise};

/// What arithmetic and data may excuse without a warning, and what they may excuse at most: past two digits the comparison says little, past one nothing.
const MOST_EXCUSED: [f64; 2] = [1e-2, 1e-1];

impl Reference {
    /// Largest relative difference of a frequency in the band, given the eigenvalues of a reduced model.
    pub(super) fn worst_difference(&self, evidence: &Evidence<'_>, answers: &Answers, band_hz: [f64; 2]) -> f64 {
        self.pairs(evidence, answers, band_hz)
            .iter()
            .filter(|pair| pair.in_band)
            .map(|pair| pair.relative_difference.abs())
            .fold(0.0, |worst, difference| if dense::worse(difference, worst) { difference } else { worst })
    }

    fn pairs(&self, evidence: &Evidence<'_>, answers: &Answers, band_hz: [f64; 2]) -> Vec<FrequencyPair> {
        let hertz = |lambda: f64| evidence.partition.scaling.hertz(lambda);
        let pair = |(j, at): (usize, &usize)| {
            let (full, error, reduced) = (self.lambda[*at], &self.errors[*at], answers.found.get(j));
            if reduced.is_some_and(|reduced| are_zero(full, error, reduced)) {
                return FrequencyPair::of_no_energy(hertz(error.zero_level), band_hz);
            }
            let reduced_hz = reduced.map_or(f64::INFINITY, |quotient| hertz(quotient.lambda));
            FrequencyPair::new([hertz(full), reduced_hz], error.bar_of(hertz(full)), band_hz)
        };
        answers.asked.iter().enumerate().map(pair).collect()
    }

    pub(super) fn comparison(&self, evidence: &Evidence<'_>, band_hz: [f64; 2]) -> Result<BoundaryComparison> {
        let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
        let answers = quotients(evidence, self, k, m)?;
        let but = match self.lambda.len() - answers.asked.len() {
            0 => String::new(),
            n => format!(", without {} that nothing starts or sees", counted(n, "mode", "modes")),
        };
        Ok(BoundaryComparison {
            boundary: self.boundary.name.clone(),
            description: format!("{}{but}", self.boundary.description),
            frequencies: self.pairs(evidence, &answers, band_hz),
            worst_in_band: self.worst_difference(evidence, &answers, band_hz),
            count: self.count,
        })
    }
}

/// Whether a motion costs no energy in either model as far as its rounding tells: of what is left no one can say which is larger. A mechanism
/// inside a thin plate, which a boundary leaves free, is one.
fn are_zero(full: f64, error: &ModeError, reduced: &Quotient) -> bool {
    let level_of_reduced = error.zero_level.max(ROUNDINGS * reduced.rounding * reduced.lambda.abs());
    zero::is_zero(full, error.zero_level) && zero::is_zero(reduced.lambda, level_of_reduced)
}

/// M-24: a reduced model is the full one with constraints; none of its eigenvalues lies below.
///
/// What may still be missing is bounded term by term. Each of the two Rayleigh quotients has the rounding of its own terms,
/// and of the entries of K̂, whose terms cancel from the size of K. The quotient of the full model lies above its eigenvalue
/// by what its residual leaves in doubt, and K̂ lost the block K̂_Bη, which (29) says is zero and the digits of K do not.
pub(super) fn monotonicity(evidence: &Evidence<'_>, references: &[Reference]) -> Result<Option<Check>> {
    let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
    // How far below, the limits of that mode, the quiet and the last one, and which it is.
    let least = Limits { engineering: 1e-9, ..Limits::default() };
    let mut worst: (f64, [Limits; 2], Option<String>) = (0.0, [least; 2], None);
    for reference in references {
        let answers = quotients(evidence, reference, k, m)?;
        for (at, reduced) in answers.asked.iter().zip(&answers.found) {
            let (full, error) = (&reference.lambda[*at], &reference.errors[*at]);
            if are_zero(*full, error, reduced) {
                continue;
            }
            let below = (1.0 - reduced.lambda / full).max(0.0);
            let terms = f64::EPSILON * error.cancellation + error.rounding_floor / full.abs();
            let rounding = ROUNDINGS * (terms + reduced.rounding);
            let left = error.residual_bar + reduced.uncoupled;
            let (arithmetic, data) = match data_noise(evidence.partition) > 0.0 {
                true => (rounding, left),
                false => (rounding + left, 0.0),
            };
            let limits = MOST_EXCUSED.map(|most| Limits { arithmetic, data, ..least }.capped(most, most));
            if dense::worse(below / limits[0].value(), worst.0 / worst.1[0].value()) {
                worst = (below, limits, Some(format!("{}, mode {}", reference.boundary.name, at + 1)));
            }
        }
    }
    let (value, limits, at) = worst;
    Ok((!references.is_empty()).then(|| Check {
        id: "M-24",
        name: "no reduced frequency lies below the full one",
        equation: "max (λ_full − λ_reduced) / λ_full over boundaries and modes (Rayleigh)",
        value,
        limits: limits[0],
        fail_above: limits[1].value(),
        worst: at,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mechanism of a thin plate with its corners held: −1.2e-5 Hz and 2.8e-5 Hz, where rounding leaves 7.6e-4 Hz to tell from nothing.
    #[test]
    fn motions_without_energy_are_no_frequencies_to_compare() {
        let square = |hertz: f64| hertz.abs() * hertz;
        let error = ModeError { zero_level: square(7.6e-4), relative_bar: 122.0, ..ModeError::default() };
        let reduced = |hertz: f64| Quotient { lambda: square(hertz), rounding: 1e-9, uncoupled: 0.0 };
        assert!(are_zero(square(-1.2e-5), &error, &reduced(2.8e-5)));
        // A frequency in one of the two is a difference, whichever has it.
        assert!(
            !are_zero(square(-1.2e-5), &error, &reduced(1e-2)) && !are_zero(square(1e-2), &error, &reduced(2.8e-5))
        );
        assert!(error.bar_of(-1.2e-5) > 0.0);
        let pair = FrequencyPair::of_no_energy(7.6e-4, [0.0, 1.0]);
        assert!(pair.in_band && pair.relative_difference == 0.0 && pair.full_error_bar_hz == 7.6e-4);
    }
}
