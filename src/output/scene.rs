//! Warnings of how the answer suits what the simulation will ask: its accuracy, its band, its size.

use super::results::Results;
use crate::error::Warning;
use crate::job::{Boundary, ModeSelection};
use crate::number::{quantity, typed};
use crate::size_forecast;
use crate::verification::preservation::{Accuracy, AccuracyMeasure, LimitSource};

/// W-ACCURACY, W-NO-MODES and W-LARGE.
pub(super) fn warnings(results: &Results<'_>) -> Vec<Warning> {
    let mut warnings: Vec<Warning> = results.preserved.report.accuracy.iter().filter_map(exceeded).collect();
    warnings.extend(no_modes(results));
    warnings.extend(size_forecast::of_interfaces(results.evidence.partition));
    warnings.extend(size_forecast::of_modes(results.evidence.retained.modes.count(), results.job()));
    warnings
}

/// An error past the limit of practice.
fn exceeded(accuracy: &Accuracy) -> Option<Warning> {
    if accuracy.set_by != LimitSource::Practice || accuracy.is_met() {
        return None;
    }
    let (error, limit) = (accuracy.error?, accuracy.limit?);
    let (what, differ, of, key) = match accuracy.measure {
        AccuracyMeasure::Frequency => ("frequencies", "differ", "those", "frequency"),
        AccuracyMeasure::Response => ("the frequency response", "differs", "that", "response_db"),
        AccuracyMeasure::InternalLoad => ("internal loads", "differ", "those", "internal_load"),
        AccuracyMeasure::Static => ("statics", "differ", "those", "static"),
    };
    let size = match error.is_finite() {
        true => format!("{differ} by {} from {of} of the full model", accuracy.in_words(error)),
        false => "of the full model are not all there".to_owned(),
    };
    let at = accuracy.at.as_deref().unwrap_or("somewhere");
    let advice = accuracy.advice.as_deref().unwrap_or("keep more modes");
    Some(Warning {
        code: "W-ACCURACY",
        message: format!(
            "in the band {what} {size}, {at} – practice asks for {} – {advice}; \
             `scene.accept = {{ {key} = … }}` says what is enough",
            accuracy.in_words(limit)
        ),
    })
}

/// No elastic mode where modes are asked for up to a frequency, or none in the band of the scene.
fn no_modes(results: &Results<'_>) -> Option<Warning> {
    let modes = &results.evidence.retained.modes;
    let report = &results.preserved.report;
    let stated = results.job().scene.as_ref().and_then(|scene| scene.band_hz);
    let is_below_all =
        !report.boundaries.is_empty() && report.boundaries.iter().all(|line| line.frequencies.is_empty());
    let asked = match (results.job().reduction.wanted(), stated) {
        (ModeSelection::UpTo { up_to_hz }, _) if modes.count() == 0 => {
            format!("no elastic mode lies below {} Hz, to which modes are asked for", typed(up_to_hz))
        }
        (_, Some([_, high])) if is_below_all => {
            format!(
                "no elastic frequency lies below {} Hz, where the band of the scene ends, under any boundary compared",
                typed(high)
            )
        }
        _ => return None,
    };
    let hertz = |lambda: f64| quantity(results.evidence.partition.scaling.hertz(lambda), 4);
    let first = modes.lambda.first().copied().or(modes.next);
    let under = match results.evidence.retained.boundary {
        Boundary::FreeInterface => "with the interface free",
        Boundary::FixedInterface => "with the interface held",
        Boundary::MixedInterface => "with the boundary of the modes",
    };
    let first = match (first, results.findings.first_elastic) {
        (Some(lambda), _) => format!("the first one {under} is at {} Hz", hertz(lambda)),
        (None, Some(lambda)) => {
            format!("the first one of the reduced model, its interface free, is at {} Hz", hertz(lambda))
        }
        (None, None) => "none was looked for above it".to_owned(),
    };
    Some(Warning { code: "W-NO-MODES", message: format!("{asked}: {first}; check the unit of the frequency") })
}
