//! Where between its samples the response errs most.
//!
//! An error peaks at resonances and antiresonances, which damping makes η f wide: steps of a quarter of that pass over none.
//! A sample costs solves with the full model. A point of the scan costs two small products, because the full model as it is
//! known so far is a dense pencil in spectral form. The peaks become samples, so that what the scan finds is an answer of the full
//! model before it is told.

use rayon::prelude::*;

use super::super::evidence::Evidence;
use super::extended::Response;
use super::pair_error::worst_pair;
use crate::dense;
use crate::eigen::Spectral;

/// Steps in the width η f of a resonance or antiresonance. Half a step from its top the response is 1/√(1 + 1/16) of the peak: 0.3 dB.
const STEPS_IN_A_PEAK: f64 = 4.0;
/// Points of a scan at most; η below 1/200 needs more over two decades.
const MAX_POINTS: usize = 4096;
/// Points of a scan where its products are large.
const MIN_POINTS: usize = 256;
/// Floating-point operations that a scan may cost: a second of one core.
const MAX_FLOPS: f64 = 1e10;
/// Peaks that become samples.
const MAX_PEAKS: usize = 12;
/// Steps of the golden section, each of which leaves 0.62 of the interval: 1e-3 of two steps of the scan.
const SECTIONS: usize = 15;

/// Both models between two frequencies.
pub(super) struct Scan<'a> {
    pub(super) evidence: &'a Evidence<'a>,
    /// The full model as far as it is known.
    pub(super) full: &'a Spectral,
    pub(super) reduced: &'a Spectral,
    /// Structural damping factor.
    pub(super) eta: f64,
}

/// What a scan found.
pub(super) struct Scanned {
    /// The highest peaks of the error, in Hz.
    pub(super) peaks_hz: Vec<f64>,
    /// The error at the highest, in dB.
    pub(super) largest_db: f64,
    /// Relative distance of neighbouring points.
    pub(super) step: f64,
}

impl Scan<'_> {
    /// The highest peaks of the error between two frequencies.
    pub(super) fn peaks(&self, [low, high]: [f64; 2]) -> Scanned {
        let decades = (high / low).ln();
        let n_steps = self.n_steps(decades);
        let step = decades / n_steps as f64;
        let at = |i: usize| if i == n_steps { high } else { low * (step * i as f64).exp() };
        let errors: Vec<f64> = (0..=n_steps).into_par_iter().map(|i| self.decibel(at(i))).collect();
        let error = |i: Option<usize>| i.and_then(|i| errors.get(i)).copied().unwrap_or(f64::NEG_INFINITY);
        let is_peak = |i: &usize| error(Some(*i)) >= error(i.checked_sub(1)) && error(Some(*i)) > error(Some(i + 1));
        let mut tops: Vec<usize> = (0..=n_steps).filter(is_peak).collect();
        tops.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]).then(a.cmp(b)));
        tops.truncate(MAX_PEAKS);
        let sharpened = tops.par_iter().map(|i| self.top([at(i.saturating_sub(1)), at((i + 1).min(n_steps))]));
        let sharpened: Vec<(f64, f64)> = sharpened.collect();
        let largest_db =
            sharpened.iter().fold(0.0, |worst, top| if dense::worse(top.1, worst) { top.1 } else { worst });
        Scanned { peaks_hz: sharpened.into_iter().map(|top| top.0).collect(), largest_db, step }
    }

    fn n_steps(&self, decades: f64) -> usize {
        let n_b = self.evidence.partition.n_interface() as f64;
        // Real and imaginary part of n_B × r times r × n_B, for both models.
        let flops = 4.0 * n_b * n_b * (self.full.n() + self.reduced.n()) as f64;
        let dear = ((MAX_FLOPS / flops) as usize).max(MIN_POINTS);
        ((STEPS_IN_A_PEAK * decades / self.eta).ceil() as usize).clamp(1, MAX_POINTS.min(dear))
    }

    /// The error of the worst pair at a frequency, in dB.
    fn decibel(&self, frequency_hz: f64) -> f64 {
        let [full, reduced] =
            [self.full, self.reduced].map(|spectral| Response::of(spectral, self.evidence, frequency_hz, self.eta));
        worst_pair(&full, &reduced).decibel
    }

    /// The frequency in an interval at which the error is largest, by golden section, and the error there.
    fn top(&self, [mut low, mut high]: [f64; 2]) -> (f64, f64) {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let inner = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let mut points = inner(low, high).map(|hz| (hz, self.decibel(hz)));
        for _ in 0..SECTIONS {
            if points[0].1 > points[1].1 {
                high = points[1].0;
                let left = inner(low, high)[0];
                points = [(left, self.decibel(left)), points[0]];
            } else {
                low = points[0].0;
                let right = inner(low, high)[1];
                points = [points[1], (right, self.decibel(right))];
            }
        }
        if points[0].1 > points[1].1 { points[0] } else { points[1] }
    }
}
