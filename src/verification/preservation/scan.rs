//! Where between its samples the response errs most.
//!
//! An error peaks at resonances, which damping makes η f wide, so that steps of a quarter of that pass over none, and at antiresonances.
//! Those of two dofs may be narrower: the response passes by zero in the complex plane, and is small only while it is near. Between two points
//! of the scan it moves almost straight, so that its chord shows where it passes by, and the place is followed.
//!
//! A sample costs solves with the full model. A point of the scan costs two small products, because the full model as it is
//! known so far is a dense pencil in spectral form. The peaks become samples, so that what the scan finds is an answer of the full
//! model before it is told.

use rayon::prelude::*;

use super::super::evidence::Evidence;
use super::observed::{Observed, Response};
use super::pair_error::{Dip, output_dips, output_errors, worst_dip, worst_pair};
use crate::cost_forecast::{flops_of_a_point, points};
use crate::dense;

/// Peaks that become samples.
const MAX_PEAKS: usize = 12;
/// Intervals whose chords pass by zero that are followed at most.
const MAX_DIPS: usize = 16;
/// Share of the largest error at the points below which a chord shows nothing that would be the largest: it is off by what the response
/// bends, a sixteenth of a resonance.
const HIDDEN: f64 = 0.8;
/// Steps after which a place that chords show is known: each chord is shorter than the one before by half or more.
const CHORDS: usize = 10;
/// How near the end of an interval its next point may lie.
const NEAREST: f64 = 0.05;
/// Intervals that share their ends, and are worked off by one thread.
const RUN: usize = 32;
/// Steps of the golden section, each of which leaves 0.62 of the interval: 1e-3 of two steps of the scan.
const SECTIONS: usize = 15;

/// Both models between two frequencies.
pub(super) struct Scan<'a> {
    pub(super) evidence: &'a Evidence<'a>,
    /// The full model as far as it is known.
    pub(super) full: &'a Observed<'a>,
    pub(super) reduced: &'a Observed<'a>,
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
        let (n_steps, step) = self.steps([low, high]);
        let at = |i: usize| at_step([low, high], (n_steps, step), i);
        let (errors, dips) = self.walked(n_steps, &at);
        let error = |i: Option<usize>| i.and_then(|i| errors.get(i)).copied().unwrap_or(f64::NEG_INFINITY);
        let is_peak = |i: &usize| error(Some(*i)) >= error(i.checked_sub(1)) && error(Some(*i)) > error(Some(i + 1));
        let tops = highest((0..=n_steps).filter(is_peak), &|i| errors[i], MAX_PEAKS);
        let least = HIDDEN * errors.iter().copied().fold(0.0, f64::max);
        let is_dip = |i: &usize| dips[*i].decibel > errors[*i].max(errors[i + 1]).max(least);
        let hidden = highest((0..n_steps).filter(is_dip), &|i| dips[i].decibel, MAX_DIPS);
        let sharpened = tops.par_iter().map(|i| self.top([at(i.saturating_sub(1)), at((i + 1).min(n_steps))]));
        let mut found: Vec<(f64, f64)> = sharpened.collect();
        found.par_extend(hidden.par_iter().map(|i| self.followed([at(*i), at(i + 1)])));
        found.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.total_cmp(&b.0)));
        found.truncate(MAX_PEAKS);
        let largest_db = found.iter().fold(0.0, |worst, top| if dense::worse(top.1, worst) { top.1 } else { worst });
        Scanned { peaks_hz: found.into_iter().map(|top| top.0).collect(), largest_db, step }
    }

    /// By how much each output differs at most, at samples, at points between the first and the last, and where chords between these pass by
    /// zero.
    pub(super) fn of_outputs(&self, samples_hz: &[f64]) -> Vec<f64> {
        let band = [samples_hz[0], samples_hz[samples_hz.len() - 1]];
        let (n_steps, step) = self.steps(band);
        let at = |i: usize| at_step(band, (n_steps, step), i);
        let starts: Vec<usize> = (0..n_steps).step_by(RUN).collect();
        let run = |start: &usize| {
            let mut before = self.point(at(*start));
            let mut worst = output_errors(&before.full, &before.reduced);
            for i in start + 1..=(start + RUN).min(n_steps) {
                let next = self.point(at(i));
                worst = larger(worst, output_errors(&next.full, &next.reduced));
                worst = larger(worst, output_dips([[&before.full, &next.full], [&before.reduced, &next.reduced]]));
                before = next;
            }
            worst
        };
        let at_sample = |hz: &f64| {
            let point = self.point(*hz);
            output_errors(&point.full, &point.reduced)
        };
        starts.par_iter().map(run).chain(samples_hz.par_iter().map(at_sample)).reduce(Vec::new, larger)
    }

    /// The error at every point, and the worst dip of every interval between two.
    fn walked(&self, n_steps: usize, at: &(dyn Fn(usize) -> f64 + Sync)) -> (Vec<f64>, Vec<Dip>) {
        let starts: Vec<usize> = (0..n_steps).step_by(RUN).collect();
        let run = |start: &usize| {
            let end = (start + RUN).min(n_steps);
            let mut before = self.point(at(*start));
            let (mut errors, mut dips) = (vec![before.decibel()], Vec::new());
            for i in start + 1..=end {
                let next = self.point(at(i));
                dips.push(before.dip_to(&next));
                errors.push(next.decibel());
                before = next;
            }
            // The last point is the first of the run that follows.
            if end < n_steps {
                errors.pop();
            }
            (errors, dips)
        };
        let runs: Vec<(Vec<f64>, Vec<Dip>)> = starts.par_iter().map(run).collect();
        let (errors, dips): (Vec<Vec<f64>>, Vec<Vec<Dip>>) = runs.into_iter().unzip();
        (errors.concat(), dips.concat())
    }

    /// The largest error next to where chords pass by zero, and its frequency. It need not lie where the response is smallest: between the
    /// points that were passed it is looked for as any top is.
    fn followed(&self, [low, high]: [f64; 2]) -> (f64, f64) {
        let [mut low, mut high] = [low, high].map(|hz| self.point(hz));
        let mut passed = vec![(low.hz, low.decibel()), (high.hz, high.decibel())];
        for _ in 0..CHORDS {
            let place = low.dip_to(&high).place.clamp(NEAREST, 1.0 - NEAREST);
            let next = self.point(low.hz + place * (high.hz - low.hz));
            passed.push((next.hz, next.decibel()));
            if low.dip_to(&next).decibel > next.dip_to(&high).decibel {
                high = next;
            } else {
                low = next;
            }
        }
        passed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let error = |at: usize| passed[at].1;
        let at = (0..passed.len()).fold(0, |a, b| if dense::worse(error(b), error(a)) { b } else { a });
        let top = self.top([passed[at.saturating_sub(1)].0, passed[(at + 1).min(passed.len() - 1)].0]);
        if dense::worse(top.1, error(at)) { top } else { passed[at] }
    }

    /// How many steps a scan between two frequencies takes, and the logarithm of each.
    fn steps(&self, [low, high]: [f64; 2]) -> (usize, f64) {
        let width = (high / low).ln();
        let (full, reduced) = (self.full, self.reduced);
        let n_both = (full.n() + reduced.n()) as f64;
        let n_b = self.evidence.partition.n_interface() as f64;
        let n_steps = points(width, self.eta, flops_of_a_point(n_b, n_both, full.n_seen() + reduced.n_seen()));
        (n_steps, width / n_steps as f64)
    }

    fn point(&self, hz: f64) -> Point {
        let [full, reduced] = [self.full, self.reduced].map(|model| Response::of(model, self.evidence, hz, self.eta));
        Point { hz, full, reduced }
    }

    /// The error of the worst pair at a frequency, in dB.
    fn decibel(&self, frequency_hz: f64) -> f64 {
        self.point(frequency_hz).decibel()
    }

    /// The frequency in an interval at which the error is largest, by golden section, and the error there.
    fn top(&self, [low, high]: [f64; 2]) -> (f64, f64) {
        top([low, high], &|hz| self.decibel(hz))
    }
}

/// The frequency after so many steps from the first to the last.
fn at_step([low, high]: [f64; 2], (n_steps, step): (usize, f64), i: usize) -> f64 {
    if i == n_steps { high } else { low * (step * i as f64).exp() }
}

/// Where in an interval a value is largest, and the value, by golden section.
pub(super) fn top([mut low, mut high]: [f64; 2], value: &dyn Fn(f64) -> f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let inner = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let mut points = inner(low, high).map(|hz| (hz, value(hz)));
    for _ in 0..SECTIONS {
        if points[0].1 > points[1].1 {
            high = points[1].0;
            let left = inner(low, high)[0];
            points = [(left, value(left)), points[0]];
        } else {
            low = points[0].0;
            let right = inner(low, high)[1];
            points = [points[1], (right, value(right))];
        }
    }
    if points[0].1 > points[1].1 { points[0] } else { points[1] }
}

/// Both responses at a frequency.
struct Point {
    hz: f64,
    full: Response,
    reduced: Response,
}

impl Point {
    /// The error of the worst pair, in dB.
    fn decibel(&self) -> f64 {
        worst_pair(&self.full, &self.reduced).decibel
    }

    fn dip_to(&self, next: &Self) -> Dip {
        worst_dip([[&self.full, &next.full], [&self.reduced, &next.reduced]])
    }
}

/// The larger of two numbers each, or those of the one list that there is.
fn larger(a: Vec<f64>, b: Vec<f64>) -> Vec<f64> {
    match (a.is_empty(), b.is_empty()) {
        (true, _) => b,
        (_, true) => a,
        (false, false) => a.into_iter().zip(b).map(|(a, b)| if dense::worse(b, a) { b } else { a }).collect(),
    }
}

/// The intervals or points of the highest values, at most so many, in descending order.
pub(super) fn highest(all: impl Iterator<Item = usize>, value: &dyn Fn(usize) -> f64, at_most: usize) -> Vec<usize> {
    let mut all: Vec<usize> = all.collect();
    all.sort_by(|a, b| value(*b).total_cmp(&value(*a)).then(a.cmp(b)));
    all.truncate(at_most);
    all
}
