//! The frequencies at which the response is compared: the ends of the band, found frequencies, antiresonances, peaks of the
//! error and a grid.

use faer::Mat;

use super::super::evidence::Evidence;
use super::shift::shift;
use crate::eigen::Spectral;
use crate::error::Result;

/// Points of the logarithmic grid.
const GRID: usize = 24;
/// Resonances, and antiresonances of one driving point, that are sampled; of more, evenly spread ones.
const MAX_RESONANCES: usize = 24;
/// A band that starts at zero is sampled from this share of the first elastic frequency on: below it the response is
/// the rigid-body or the static line to (1/10)² = 1 %, and both are compared elsewhere.
const NEAR_ZERO: f64 = 0.1;
/// Samples nearer than this, relatively, are one.
const SAME: f64 = 1e-9;

/// The first samples: ends, elastic frequencies of the reduced model, grid; ascending.
pub(super) fn first(evidence: &Evidence<'_>, reduced: &Spectral, band_hz: [f64; 2]) -> Vec<f64> {
    let elastic = elastic_hz(evidence, reduced);
    let [low, high] = band_hz;
    // Motions that cost no energy although no rigid-body motion is like them are at zero, or below it by a rounding.
    let first = elastic.iter().copied().find(|hz| *hz > 0.0).unwrap_or(high);
    let start = if low > 0.0 { low } else { NEAR_ZERO * first.min(high) };
    let step = |i: usize| start * (high / start).powf(i as f64 / (GRID - 1) as f64);
    let grid = (0..GRID).map(|i| if i == GRID - 1 { high } else { step(i) });
    let resonances = spread(elastic.into_iter().filter(|hz| (start..=high).contains(hz)).collect());
    merged(grid.chain(resonances).collect())
}

/// `samples` with every resonance of the reduced model between the first and the last.
pub(super) fn with_resonances(evidence: &Evidence<'_>, reduced: &Spectral, samples: &[f64]) -> Vec<f64> {
    let band = samples[0]..=samples[samples.len() - 1];
    let resonances = elastic_hz(evidence, reduced).into_iter().filter(|hz| band.contains(hz));
    merged(samples.iter().copied().chain(resonances).collect())
}

/// `samples` with peaks of the error, the elastic frequencies of the full model and the antiresonances at driving points, which
/// are the frequencies of the reduced model with the dof held.
///
/// # Errors
/// A reduced pencil that is not definite.
pub(super) fn with_peaks_and_zeros(
    evidence: &Evidence<'_>,
    full: &Spectral,
    (samples, peaks): (&[f64], &[f64]),
    driving_points: &[usize],
) -> Result<Vec<f64>> {
    let (start, high) = (samples[0], samples[samples.len() - 1]);
    let within = |all: Vec<f64>| spread(all.into_iter().filter(|hz| (start..=high).contains(hz)).collect());
    let mut all = [samples, peaks].concat();
    all.extend(within(elastic_hz(evidence, full)));
    for dof in driving_points.iter().copied() {
        let (k, m) = (&evidence.reduction.stiffness, &evidence.reduction.mass);
        let past = |i: usize| if i < dof { i } else { i + 1 };
        let held = |a: &Mat<f64>| Mat::from_fn(a.nrows() - 1, a.nrows() - 1, |i, j| a[(past(i), past(j))]);
        let spectral = Spectral::of(held(k).as_ref(), held(m).as_ref(), shift(evidence)?)?;
        let spectral = spectral.of_rank(evidence.reduction.mass_rank());
        let zeros = spectral.eigenvalues().into_iter().filter(|lambda| *lambda > 0.0);
        all.extend(within(zeros.map(|lambda| evidence.partition.scaling.hertz(lambda)).collect()));
    }
    Ok(merged(all))
}

/// Elastic frequencies with the interface free, ascending.
pub(super) fn elastic_hz(evidence: &Evidence<'_>, spectral: &Spectral) -> Vec<f64> {
    let elastic = spectral.eigenvalues().into_iter().skip(evidence.rigid.count());
    elastic.map(|lambda| evidence.partition.scaling.hertz(lambda)).collect()
}

/// At most [`MAX_RESONANCES`] of them, evenly spread, the last among them.
fn spread(all: Vec<f64>) -> Vec<f64> {
    let n = all.len();
    if n <= MAX_RESONANCES {
        return all;
    }
    (0..MAX_RESONANCES).map(|i| all[i * (n - 1) / (MAX_RESONANCES - 1)]).collect()
}

/// Ascending, with one of those that are nearly the same.
pub(super) fn merged(mut all: Vec<f64>) -> Vec<f64> {
    all.sort_by(f64::total_cmp);
    all.dedup_by(|b, a| *b - *a <= SAME * *b);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_spread_evenly_and_keep_their_ends() {
        let all: Vec<f64> = (0..100).map(f64::from).collect();
        let some = spread(all);
        assert_eq!((some.len(), some[0], some[MAX_RESONANCES - 1]), (MAX_RESONANCES, 0.0, 99.0));
    }

    #[test]
    fn equal_samples_are_one() {
        assert_eq!(merged(vec![2.0, 1.0, 2.0 + 1e-10, 3.0]), [1.0, 2.0, 3.0]);
    }
}
