//! Frequency response of the reduced against the full model, pair by pair of interface dofs: M-20, M-21.

use rayon::prelude::*;

use super::super::check::{Check, Limits};
use super::super::evidence::Evidence;
use super::extended::{Extended, Response};
use super::interfaces::rotation_length;
use super::internal_loads::FullLoads;
use super::outcome::{ResponseComparison, ResponseSample};
use super::pair_error::{PairError, magnitude, worst_pair};
use super::samples;
use super::scan::Scan;
use super::shift::shift;
use super::space::{FullModel, Known, Space};
use crate::cache::{Cache, Key, Kind, Reader, Recorded, Writer, recalled};
use crate::dense;
use crate::eigen::Spectral;
use crate::error::Result;
use crate::factor::Storage;
use crate::number::quantity;
use crate::reduction::panel_of;

/// How often the band is scanned: samples that were added may have taught the full model something.
const PASSES: usize = 3;
/// Share of the largest error by which what a scan foresaw may miss what its samples then show.
const SETTLED: f64 = 1e-3;

/// The response of the full model at its samples.
pub(super) struct FullResponse {
    samples_hz: Vec<f64>,
    answers: Vec<Response>,
    eta: f64,
}

/// The response of the full model and what the comparison with it found.
struct Measured {
    full: FullResponse,
    /// The worst pair, and the sample it is worst at.
    worst: PairError,
    at: usize,
    /// The largest relative residual of the full response.
    residual: f64,
    /// Of the last scan.
    step: f64,
    peak_shift: f64,
    /// Bound on the relative error of the full response at its worst sample, and that sample.
    uncertainty: (f64, f64),
}

impl Recorded for Measured {
    const KIND: Kind = Kind::Response;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { full, worst, at, residual, step, peak_shift, uncertainty } = self;
        to.array(&full.samples_hz)?;
        for answer in &full.answers {
            answer.write(to)?;
        }
        to.counts(&[worst.pair.0, worst.pair.1, *at])?;
        to.array(&[worst.decibel, *residual, *step, *peak_shift, uncertainty.0, uncertainty.1, full.eta])
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let samples_hz: Vec<f64> = from.array()?;
        let answers = samples_hz.iter().map(|_| Response::read(from)).collect::<Option<Vec<_>>>()?;
        let [row, column, at] = from.counts()?[..] else { return None };
        let [decibel, residual, step, peak_shift, bound, bound_at, eta] = from.array()?[..] else { return None };
        let (worst, uncertainty) = (PairError { pair: (row, column), decibel }, (bound, bound_at));
        (at < samples_hz.len()).then_some(Self {
            full: FullResponse { samples_hz, answers, eta },
            worst,
            at,
            residual,
            step,
            peak_shift,
            uncertainty,
        })
    }
}

/// The answers of the full model, for further reduced models to be compared with.
pub(super) struct Full<'a> {
    pub(super) response: FullResponse,
    /// Of its interior, where its internal loads are compared.
    pub(super) loads: Option<FullLoads<'a>>,
}

/// The comparison and the values it rests on.
pub(super) struct Compared<'a> {
    pub(super) report: ResponseComparison,
    pub(super) full: Full<'a>,
    /// Bound on the relative error of the full response at its worst sample, and that sample.
    uncertainty: (f64, f64),
}

/// Compares the response of all pairs of interface dofs over the band. With a reduction whose internal loads will be compared, samples lie
/// at all of its resonances.
///
/// # Errors
/// A pencil that is not definite.
pub(super) fn compared<'a>(
    evidence: &Evidence<'_>,
    loaded: Option<&'a Evidence<'a>>,
    band_hz: [f64; 2],
    eta: f64,
) -> Result<Compared<'a>> {
    let reduction = evidence.reduction;
    let reduced = Spectral::of(reduction.stiffness.as_ref(), reduction.mass.as_ref(), shift(evidence)?)?;
    let task = Task { evidence, reduced: &reduced, band_hz, eta };
    let (measured, loads) = match loaded {
        // Internal loads are those of the space that the response was found in.
        Some(own) => {
            let mut extended = Extended::new(evidence, evidence.factor, eta)?;
            let measured = task.measured_by_solves(First::AllResonances, &mut extended)?.0;
            let loads = FullLoads::new(own, extended, &measured.full.samples_hz, eta)?;
            (measured, Some(loads))
        }
        None => {
            let cache = evidence.partition.cache().filter(|_| evidence.factor.storage() == Storage::Double);
            (task.recalled_or_known(cache)?, None)
        }
    };
    let report = task.report(&measured);
    let Measured { full, uncertainty, .. } = measured;
    Ok(Compared { report, full: Full { response: full, loads }, uncertainty })
}

/// Resonances among the samples that a comparison starts from.
#[derive(Clone, Copy, PartialEq, Eq)]
enum First {
    /// Evenly spread ones, where there are many.
    SpreadResonances,
    /// All of the reduced model, for its internal loads.
    AllResonances,
}

/// What is compared.
struct Task<'t> {
    evidence: &'t Evidence<'t>,
    reduced: &'t Spectral,
    band_hz: [f64; 2],
    eta: f64,
}

impl<'t> Task<'t> {
    /// The response of the full model: what an earlier run has found by solves, or in the space of another response where that answers all
    /// samples, otherwise by solves. Only what solves have found is kept, with its space: a response in the space of another one has other
    /// last bits.
    ///
    /// # Errors
    /// A pencil that is not definite.
    fn recalled_or_known(&self, cache: Option<&Cache>) -> Result<Measured> {
        let Some(cache) = cache else { return self.found_by_solves(None) };
        let key = self.key();
        if !cache.has(Kind::Response, &key.digest())
            && let Some(measured) = self.known(cache)?
        {
            cache.part_was_taken();
            return Ok(measured);
        }
        recalled(Some(cache), || key, || self.found_by_solves(Some(cache)))
    }

    /// The response in the space of an earlier run, where that answers all samples.
    ///
    /// # Errors
    /// A pencil that is not definite.
    fn known(&self, cache: &Cache) -> Result<Option<Measured>> {
        let space = cache.of_earlier_run(&Space::key(self.evidence).digest());
        let Some(mut known) = space.and_then(|space| Known::of(self.evidence, space, self.eta)) else {
            return Ok(None);
        };
        Ok(self.measured(First::SpreadResonances, &mut known)?.map(|(measured, _)| measured))
    }

    /// The response by solves, whose space is kept for others.
    ///
    /// # Errors
    /// A pencil that is not definite.
    fn found_by_solves(&self, cache: Option<&Cache>) -> Result<Measured> {
        let mut extended = Extended::new(self.evidence, self.evidence.factor, self.eta)?;
        let (measured, residuals) = self.measured_by_solves(First::SpreadResonances, &mut extended)?;
        if let (Some(cache), Some(space)) = (cache, extended.space(&residuals)) {
            cache.replace(&Space::key(self.evidence), &space);
        }
        Ok(measured)
    }

    /// The response of the full model by solves, which answer every sample, with the residual of each.
    ///
    /// # Errors
    /// A pencil that is not definite.
    fn measured_by_solves(&self, first: First, extended: &mut Extended<'_>) -> Result<(Measured, Vec<f64>)> {
        Ok(self.measured(first, extended)?.expect("solves answer every sample"))
    }

    /// The response of the full model at samples where the reduced one errs most, with the residual of each; none where the model has no
    /// answer to one.
    ///
    /// # Errors
    /// A pencil that is not definite.
    fn measured(&self, first: First, full: &mut dyn FullModel) -> Result<Option<(Measured, Vec<f64>)>> {
        let Self { evidence, reduced, band_hz, eta } = *self;
        let mut samples_hz = samples::first(evidence, reduced, band_hz);
        if first == First::AllResonances {
            samples_hz = samples::with_resonances(evidence, reduced, &samples_hz);
        }
        let Some(mut residuals) = full.settle(&samples_hz)? else { return Ok(None) };
        let mut response = FullResponse::new(evidence, full.spectral(), (&samples_hz, eta));
        let (mut worst, mut at) = response.worst(evidence, reduced);
        let mut step = 0.0;
        for _ in 0..PASSES {
            let scan = Scan { evidence, full: full.spectral(), reduced, eta };
            let found = scan.peaks([samples_hz[0], samples_hz[samples_hz.len() - 1]]);
            step = found.step;
            let (known, driven) = ((&samples_hz[..], &found.peaks_hz[..]), [worst.pair.0, worst.pair.1]);
            samples_hz = samples::with_peaks_and_zeros(evidence, full.spectral(), known, driven)?;
            let Some(settled) = full.settle(&samples_hz)? else { return Ok(None) };
            residuals = settled;
            response = FullResponse::new(evidence, full.spectral(), (&samples_hz, eta));
            (worst, at) = response.worst(evidence, reduced);
            if !dense::worse(found.largest_db, (1.0 + SETTLED) * worst.decibel) {
                break;
            }
        }
        let residual = residuals.iter().fold(0.0, |a, b| if dense::worse(*b, a) { *b } else { a });
        let least_known =
            (0..residuals.len()).fold(0, |a, b| if dense::worse(residuals[b], residuals[a]) { b } else { a });
        let peak_shift = peak_shift(evidence, full.spectral(), reduced, band_hz);
        let bound = full.bound(response.samples_hz[least_known]);
        let uncertainty = (response.uncertainty(&bound, least_known), response.samples_hz[least_known]);
        let measured = Measured { full: response, worst, at, residual, step, peak_shift, uncertainty };
        Ok(Some((measured, residuals)))
    }

    /// The key of all that [`Task::measured`] takes, from the samples of the reduced model alone.
    fn key(&self) -> Key {
        let Self { evidence, band_hz, eta, .. } = self;
        let Evidence { partition, reduction, retained, basis, .. } = evidence;
        let columns = panel_of(basis, 0..basis.n_reduced());
        let key = evidence.constraint.key(evidence.rigid.key(partition.key("frequency response")));
        let key = key.columns(columns.as_ref()).columns(reduction.stiffness.as_ref()).columns(reduction.mass.as_ref());
        let key = key.numbers(&retained.modes.lambda).shown(&reduction.mass_rank()).shown(&partition.scaling);
        key.numbers(&[rotation_length(partition)]).numbers(band_hz).numbers(&[*eta])
    }

    fn report(&self, measured: &Measured) -> ResponseComparison {
        let (evidence, Measured { full, worst, at, .. }) = (self.evidence, measured);
        let name = |dof: usize| evidence.partition.name_of(evidence.partition.n_internal + dof);
        ResponseComparison {
            boundary: "free".to_owned(),
            damping: self.eta,
            rotation_length: rotation_length(evidence.partition),
            residual: measured.residual,
            worst_pair: [name(worst.pair.1), name(worst.pair.0)],
            worst_db: worst.decibel,
            worst_at_hz: full.samples_hz[*at],
            peak_shift: measured.peak_shift,
            scan_step: measured.step,
            samples: full.shown(evidence, self.reduced, worst.pair),
        }
    }
}

impl FullResponse {
    /// The response at samples, by the full model in spectral form.
    fn new(evidence: &Evidence<'_>, spectral: &Spectral, (samples_hz, eta): (&[f64], f64)) -> Self {
        let answers = samples_hz.par_iter().map(|hz| Response::of(spectral, evidence, *hz, eta)).collect();
        Self { samples_hz: samples_hz.to_vec(), answers, eta }
    }

    /// The worst pair of a reduced model and the sample it is worst at.
    pub(super) fn worst(&self, evidence: &Evidence<'_>, reduced: &Spectral) -> (PairError, usize) {
        let start = (PairError { pair: (0, 0), decibel: 0.0 }, 0);
        self.errors(evidence, reduced).into_iter().enumerate().fold(start, |worst, (at, error)| {
            if dense::worse(error.decibel, worst.0.decibel) { (error, at) } else { worst }
        })
    }

    /// Largest error over all pairs and samples, in dB.
    pub(super) fn worst_decibel(&self, evidence: &Evidence<'_>, reduced: &Spectral) -> f64 {
        self.worst(evidence, reduced).0.decibel
    }

    /// The worst pair of every sample.
    fn errors(&self, evidence: &Evidence<'_>, reduced: &Spectral) -> Vec<PairError> {
        let samples = self.samples_hz.par_iter().zip(&self.answers);
        samples.map(|(hz, full)| worst_pair(full, &Response::of(reduced, evidence, *hz, self.eta))).collect()
    }

    /// Magnitudes of one pair, and the largest error of all pairs; rotations count as displacements at the length.
    fn shown(&self, evidence: &Evidence<'_>, reduced: &Spectral, pair: (usize, usize)) -> Vec<ResponseSample> {
        let partition = evidence.partition;
        let length = rotation_length(partition);
        let scale = |dof: usize| match partition.dofs[partition.n_internal + dof].site {
            Some(site) if site.direction.is_rotation() => length,
            _ => 1.0,
        };
        let unit = scale(pair.0) * scale(pair.1) / partition.scaling.stiffness_unit();
        let errors = self.errors(evidence, reduced);
        let sample = |(at, hz): (usize, &f64)| ResponseSample {
            frequency_hz: *hz,
            full: unit * self.answers[at].get(pair.0, pair.1).norm(),
            reduced: unit * Response::of(reduced, evidence, *hz, self.eta).get(pair.0, pair.1).norm(),
            error_db: errors[at].decibel,
        };
        self.samples_hz.iter().enumerate().map(sample).collect()
    }

    /// Largest bound on the error of an entry of the full response over that entry, at one sample; `bound` as [`FullModel::bound`] has it.
    fn uncertainty(&self, bound: &[f64], at: usize) -> f64 {
        let answer = &self.answers[at];
        let mut largest = 0.0;
        for j in 0..answer.n() {
            for i in 0..=j {
                let relative = bound[i] * bound[j] / magnitude(answer, i, j);
                if dense::worse(relative, largest) {
                    largest = relative;
                }
            }
        }
        largest
    }
}

/// Largest relative distance of a resonance that lies in the band in either model: with light damping the peaks lie at the
/// eigenvalues.
fn peak_shift(evidence: &Evidence<'_>, full: &Spectral, reduced: &Spectral, band_hz: [f64; 2]) -> f64 {
    let [full, reduced] = [full, reduced].map(|spectral| samples::elastic_hz(evidence, spectral));
    let partner = |j: usize| reduced.get(j).copied().unwrap_or(f64::INFINITY);
    let is_inside = |hertz: f64| (band_hz[0]..=band_hz[1]).contains(&hertz);
    let in_band = full.iter().enumerate().filter(|(j, hz)| is_inside(**hz) || is_inside(partner(*j)));
    let shift = |(j, hz): (usize, &f64)| (partner(j) / hz - 1.0).abs();
    in_band.map(shift).fold(0.0, |worst, shift| if dense::worse(shift, worst) { shift } else { worst })
}

/// M-20 and M-21.
pub(super) fn checks(compared: &Compared<'_>) -> [Check; 2] {
    let report = &compared.report;
    let [driven, observed] = &report.worst_pair;
    [
        Check {
            id: "M-20",
            name: "frequency response of the interfaces",
            equation: "max |20 log₁₀ |Ĥ/H||, 20 log₁₀(1 + |Ĥ − H|/|H|) in dB over pairs of dofs and the band",
            value: report.worst_db,
            // How much is tolerable is for the scene to say, and it says nothing.
            limits: Limits::NONE,
            fail_above: f64::INFINITY,
            worst: Some(format!("{driven} to {observed} at {} Hz", quantity(report.worst_at_hz, 6))),
        },
        Check {
            id: "M-21",
            name: "full response is known well enough",
            equation: "max ρ_i ρ_j / (η |H_ij|), ρ the residual in the norm of K_II⁻¹, at the worst sample",
            value: compared.uncertainty.0,
            // A hundredth is a tenth of a dB.
            limits: Limits { engineering: 1e-2, ..Limits::default() },
            // Past it the comparison says nothing. That does not make a reduction wrong.
            fail_above: Check::NEVER,
            worst: Some(format!("{} Hz", quantity(compared.uncertainty.1, 6))),
        },
    ]
}
