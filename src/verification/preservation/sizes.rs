//! What a smaller basis would cost in accuracy, and what the size that was chosen asks of an integrator.

use faer::Mat;

use super::super::evidence::Evidence;
use super::answered::{is_kept, n_left_out};
use super::explicit_step::explicit_step;
use super::leading::leading;
use super::outcome::{HighestFrequency, SizeError};
use super::reduced::quotients;
use super::reference::Reference;
use super::response::Full;
use super::shift::shift;
use crate::basis::DynamicCoordinate;
use crate::dense;
use crate::eigen::Spectral;
use crate::error::Result;

/// Points of the curve.
const POINTS: usize = 9;
/// Steps in a period with which an implicit scheme still follows an oscillation.
const STEPS_PER_PERIOD: f64 = 20.0;

/// The error of the reduced model cut down to its first modes, against the answers of the full model already there.
///
/// The dynamic columns were made orthogonal in their order, so the leading ones span what a smaller job would have kept.
///
/// # Errors
/// A reduced pencil that is not definite.
pub(super) fn size_errors(
    evidence: &Evidence<'_>,
    references: &[Reference],
    response: Option<&Full<'_>>,
    band_hz: [f64; 2],
) -> Result<Vec<SizeError>> {
    if references.is_empty() && response.is_none() {
        return Ok(Vec::new());
    }
    let n_modes = n_modes(evidence);
    let mut counts: Vec<usize> = (0..POINTS).map(|i| i * n_modes / (POINTS - 1)).collect();
    counts.dedup();
    counts.into_iter().map(|count| size_error(evidence, references, response, (count, band_hz))).collect()
}

/// Modes in the basis.
pub(super) fn n_modes(evidence: &Evidence<'_>) -> usize {
    evidence.basis.coordinates.iter().filter(|coordinate| is_mode(coordinate)).count()
}

/// The error of the reduced model cut down to its first `n_modes` modes.
///
/// # Errors
/// A reduced pencil that is not definite.
pub(super) fn size_error(
    evidence: &Evidence<'_>,
    references: &[Reference],
    response: Option<&Full<'_>>,
    (n_modes, band_hz): (usize, [f64; 2]),
) -> Result<SizeError> {
    let n = evidence.partition.n_interface() + n_columns(evidence, n_modes);
    let (k, m) = leading(evidence, n)?;
    let (k, m) = (k.as_ref(), m.as_ref());
    let mut frequency_error = 0.0;
    for reference in references {
        let reduced = quotients(evidence, reference, k, m)?;
        let error = reference.worst_difference(evidence, &reduced, band_hz);
        if dense::worse(error, frequency_error) {
            frequency_error = error;
        }
    }
    let response_error_db = response.map(|full| full.worst_decibel((evidence, n), (k, m))).transpose()?;
    let loads = response.and_then(|full| full.loads.as_ref());
    let internal_load_error = loads.map(|loads| loads.worst(n)).transpose()?;
    let n_reduced = n - n_left_out(evidence, n);
    Ok(SizeError { n_modes, n_reduced, frequency_error, response_error_db, internal_load_error })
}

fn is_mode(coordinate: &DynamicCoordinate) -> bool {
    use DynamicCoordinate::{InertiaRelief, ResidualVector, RigidBody};
    !matches!(coordinate, InertiaRelief(_) | ResidualVector(_) | RigidBody(_))
}

/// Dynamic columns up to and without the mode after the first `n_modes`.
fn n_columns(evidence: &Evidence<'_>, n_modes: usize) -> usize {
    let coordinates = &evidence.basis.coordinates;
    let modes = coordinates.iter().enumerate().filter(|(_, coordinate)| is_mode(coordinate));
    modes.map(|(at, _)| at).nth(n_modes).unwrap_or(coordinates.len())
}

/// The highest frequency of the superelement with its interface free; none where a motion has no mass, which no step follows.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn highest(evidence: &Evidence<'_>) -> Result<Option<HighestFrequency>> {
    let n = evidence.reduction.n_reduced();
    let kept: Vec<usize> = (0..n).filter(|at| is_kept(evidence, *at)).collect();
    let of_file = |a: &Mat<f64>| dense::part(a.as_ref(), &kept);
    let [k, m] = [&evidence.reduction.stiffness, &evidence.reduction.mass].map(of_file);
    let rank = evidence.reduction.mass_rank().map(|rank| rank - n_left_out(evidence, n));
    let reduced = Spectral::of(k.as_ref(), m.as_ref(), shift(evidence)?)?.of_rank(rank);
    let all = reduced.eigenvalues();
    // A mass of rigid-body motion alone has zero eigenvalues and no others.
    let n_zero = evidence.rigid.count() - evidence.rigid.n_massless;
    let elastic = all.get(n_zero..).and_then(<[f64]>::last);
    let Some(lambda) = elastic.copied().filter(|lambda| *lambda > 0.0 && all.len() == reduced.n()) else {
        return Ok(None);
    };
    let frequency_hz = evidence.partition.scaling.hertz(lambda);
    let undamped = 1.0 / (std::f64::consts::PI * frequency_hz);
    let damped = match evidence.damping {
        Some(damping) => {
            let own = evidence.reduction.in_user_units(evidence.partition);
            let [k, m, c] = [&own.stiffness, &own.mass, &damping.matrix].map(of_file);
            explicit_step([&k, &m, &c].map(Mat::as_ref))?
        }
        None => None,
    };
    Ok(Some(HighestFrequency {
        frequency_hz,
        // Damping never makes a larger step stable.
        explicit_step_s: damped.map_or(undamped, |damped| damped.min(undamped)),
        is_damped: evidence.damping.is_some(),
        resolving_step_s: 1.0 / (STEPS_PER_PERIOD * frequency_hz),
    }))
}
