//! What the enclosures prove of the retained modes: M-06, M-07 and M-08.

use super::check::{Check, Limits};
use super::enclosure::Enclosures;
use super::evidence::Evidence;
use crate::dense;
use crate::eigen::ModeError;

/// M-07 and M-08, and how far the count is proved: M-06.
pub(super) fn checks(evidence: &Evidence<'_>) -> Vec<Check> {
    let Some(enclosures) = evidence.enclosures else { return Vec::new() };
    let mut checks = vec![counted(enclosures)];
    if let Some(intervals) = enclosures.intervals.iter().copied().collect::<Option<Vec<[f64; 2]>>>() {
        checks.push(widths(evidence, &intervals));
        checks.push(bars(evidence, &intervals));
    }
    checks.extend(enclosures.angles.iter().copied().collect::<Option<Vec<f64>>>().map(angles));
    checks
}

/// M-06, rounding included.
fn counted(enclosures: &Enclosures) -> Check {
    /// Shown where nothing could be proved.
    const UNPROVED: f64 = 1e9;
    let count = enclosures.count;
    let word = if count.is_proved() { "proven" } else { "likely" };
    let said = match count.enclosed {
        0 => format!("count {word}: K − σM could not be proved definite, nothing is enclosed"),
        enclosed => format!("count {word}: {} counted, {enclosed} enclosed", count.counted),
    };
    Check {
        id: "M-06",
        name: "count is proven, not only likely",
        equation: "‖K − σM − LBLᵀ‖ relative to the distance of σ to the highest mode, in the metric of K + |σ|M",
        value: if count.counted == count.enclosed { count.uncertainty.min(UNPROVED) } else { f64::INFINITY },
        limits: Limits { engineering: 1.0, ..Limits::default() },
        fail_above: UNPROVED,
        worst: Some(said),
    }
}

fn worst(values: impl Iterator<Item = f64>) -> (f64, Option<String>) {
    let mut worst = (0.0, None);
    for (mode, value) in values.enumerate() {
        if dense::worse(value, worst.0) {
            worst = (value, Some(format!("mode {}", mode + 1)));
        }
    }
    worst
}

/// M-07: half-widths.
fn widths(evidence: &Evidence<'_>, intervals: &[[f64; 2]]) -> Check {
    let lambda = &evidence.retained.modes.lambda;
    let (value, worst) = worst(intervals.iter().zip(lambda).map(|([low, high], lambda)| 0.5 * (high - low) / lambda));
    Check {
        id: "M-07",
        name: "eigenvalues are enclosed",
        equation: "max half-width of the proven interval / λ",
        value,
        limits: Limits { engineering: 1e-6, ..Limits::default() },
        fail_above: 1e-3,
        worst,
    }
}

/// M-07: the printed eigenvalue is within its bar of the proven interval.
fn bars(evidence: &Evidence<'_>, intervals: &[[f64; 2]]) -> Check {
    let modes = &evidence.retained.modes;
    let excess = |(([low, high], lambda), error): ((&[f64; 2], &f64), &ModeError)| {
        let distance = (low - lambda).max(lambda - high).max(0.0);
        if distance > 0.0 { distance / (error.relative_bar * lambda) } else { 0.0 }
    };
    let (value, worst) = worst(intervals.iter().zip(&modes.lambda).zip(&modes.errors).map(excess));
    Check {
        id: "M-07",
        name: "error bars reach the proven intervals",
        equation: "max distance of λ to its interval / its error bar",
        value,
        limits: Limits { engineering: 1.0, ..Limits::default() },
        fail_above: 10.0,
        worst,
    }
}

/// M-08.
fn angles(angles: Vec<f64>) -> Check {
    let (value, worst) = worst(angles.into_iter());
    Check {
        id: "M-08",
        name: "modes lie close to eigenvectors",
        equation: "max sin ∠(x, eigenvectors of its cluster) ≤ ρ/gap, in the energy of K_s",
        value,
        limits: Limits { engineering: 1e-6, ..Limits::default() },
        fail_above: 1e-2,
        worst,
    }
}
