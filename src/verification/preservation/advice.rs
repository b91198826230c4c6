//! What would meet a limit that the reduced model exceeds.

use std::fmt;

use crate::number::{decade, quantity};

/// Points of the curve of errors that say how the error falls with the modes kept.
const POINTS: usize = 5;
/// Beyond this multiple of the frequency that modes are kept to, nothing is foretold.
const FORETOLD: f64 = 8.0;
/// The powers of the frequency with which errors are taken to fall at most, whatever a few points say: mode acceleration divides what
/// is left out by its frequency once more.
pub(super) const STEEPEST_HELD: f64 = 2.0;
pub(super) const STEEPEST_FREE: f64 = 4.0;
/// Modes of the free component up to this multiple of the band meet the limits of practice.
const FREE_MODES: f64 = 2.0;

/// What would meet a limit.
pub(super) struct Advice {
    /// Up to where it is met.
    pub(super) met: String,
    /// The frequency to which modes would be needed, as far as it can be foretold.
    pub(super) modes_to_hz: Option<f64>,
    /// The frequency to which modes are kept, where any are.
    pub(super) kept_to_hz: Option<f64>,
    pub(super) band_end_hz: f64,
    /// Whether the modes kept are those of the free component.
    pub(super) are_free: bool,
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.met)?;
        let twice = FREE_MODES * self.band_end_hz;
        let has_twice = self.are_free && self.kept_to_hz.is_some_and(|kept| kept >= twice);
        match self.modes_to_hz {
            Some(hz) => write!(f, "; by how it falls, modes to about {} Hz may meet it", quantity(rounded_up(hz), 2))?,
            None if has_twice => f.write_str("; keep more modes")?,
            None if self.are_free => write!(f, "; keep modes to {} Hz, twice the band, or more", quantity(twice, 3))?,
            None => {}
        }
        if !self.are_free {
            write!(f, "; so may `method = \"herting\"` with modes to {} Hz", quantity(twice, 3))?;
        }
        Ok(())
    }
}

/// The next larger number of two digits.
fn rounded_up(hz: f64) -> f64 {
    let unit = 10f64.powi(decade(hz) - 1);
    (hz / unit).ceil() * unit
}

/// Up to where a limit is met, by the errors at frequencies.
pub(super) fn band_met(what: &str, errors: impl Iterator<Item = (f64, f64)>, limit: f64) -> String {
    let errors: Vec<(f64, f64)> = errors.collect();
    let is_met = |error: f64| error <= limit;
    let first = errors.iter().filter(|(_, error)| !is_met(*error)).map(|(hz, _)| *hz).fold(f64::INFINITY, f64::min);
    match errors.iter().map(|(hz, _)| *hz).filter(|hz| *hz < first).reduce(f64::max) {
        Some(hz) => format!(
            "{what} up to {} Hz {} it",
            quantity(hz, 5),
            if what.starts_with("the ") { "meets" } else { "meet" }
        ),
        None => format!("nothing of the band meets it, from {} Hz on", quantity(first, 5)),
    }
}

/// The frequency to which modes have to be kept for an error to be met, from errors with fewer modes: a power of the frequency, by least
/// squares. None where the errors do not fall at least as its inverse, or where it is too far away to be told.
pub(super) fn modes_needed(points: &[(f64, f64)], limit: f64, steepest: f64) -> Option<f64> {
    let known: Vec<[f64; 2]> = points
        .iter()
        .filter(|(hz, error)| *hz > 0.0 && *error > 0.0 && error.is_finite())
        .map(|(hz, error)| [hz.ln(), error.ln()])
        .collect();
    let known = &known[known.len().saturating_sub(POINTS)..];
    let (last, n) = (known.last()?, known.len() as f64);
    let mean = [0, 1].map(|axis| known.iter().map(|point| point[axis]).sum::<f64>() / n);
    let moment = |axis: usize| known.iter().map(|point| (point[0] - mean[0]) * (point[axis] - mean[axis])).sum::<f64>();
    let slope = (moment(1) / moment(0)).max(-steepest);
    // The line through the means, or the last error where that is larger: what is left is not to be passed over.
    let at_last = (mean[1] + slope * (last[0] - mean[0])).max(last[1]);
    let needed = (last[0] + (at_last - limit.ln()) / -slope).exp();
    (known.len() >= 3 && slope <= -1.0 && needed <= FORETOLD * last[0].exp()).then_some(needed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_that_falls_as_a_power_is_followed_to_its_limit() {
        // 4 (100/f)²: a hundredth at 2000.
        let points: Vec<(f64, f64)> =
            (1..=8).map(|i| 100.0 * f64::from(i)).map(|hz| (hz, 4.0 * (100.0 / hz).powi(2))).collect();
        let needed = modes_needed(&points, 1e-2, 4.0).expect("it falls");
        assert!((needed / 2000.0 - 1.0).abs() < 1e-12, "{needed}");
        // Sixty-four times as far.
        assert_eq!(modes_needed(&points, 1e-6, 4.0), None);
        let flat: Vec<(f64, f64)> = points.iter().map(|(hz, _)| (*hz, 0.3)).collect();
        assert_eq!(modes_needed(&flat, 1e-2, 4.0), None);
        assert_eq!(modes_needed(&points[..2], 1e-2, 4.0), None);
        assert_eq!(modes_needed(&[], 1e-2, 4.0), None);
    }

    #[test]
    fn a_band_is_met_below_the_first_frequency_that_is_not() {
        let errors = [(300.0, 2.0), (100.0, 0.1), (200.0, 0.2), (400.0, 0.1)];
        assert_eq!(band_met("frequencies", errors.into_iter(), 1.0), "frequencies up to 200 Hz meet it");
        assert_eq!(band_met("the response", errors.into_iter(), 0.05), "nothing of the band meets it, from 100 Hz on");
    }

    #[test]
    fn advice_names_modes_and_method() {
        let advice = |modes_to_hz, kept_to_hz, are_free| {
            Advice { met: "x".to_owned(), modes_to_hz, kept_to_hz, band_end_hz: 100.0, are_free }.to_string()
        };
        assert_eq!(advice(Some(512.0), Some(150.0), true), "x; by how it falls, modes to about 520 Hz may meet it");
        assert_eq!(advice(None, Some(150.0), true), "x; keep modes to 200 Hz, twice the band, or more");
        assert_eq!(advice(None, Some(250.0), true), "x; keep more modes");
        assert_eq!(advice(None, None, false), "x; so may `method = \"herting\"` with modes to 200 Hz");
    }
}
