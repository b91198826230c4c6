//! Frequency response of the reduced against the full model, pair by pair of interface dofs and at the outputs of the scene: M-20, M-21.
//!
//! Of many outputs those that err most are followed between the samples, by a scan of all that shows antiresonances by their chords.

use faer::MatRef;
use rayon::prelude::*;

use super::super::check::{Check, Limits};
use super::super::evidence::Evidence;
use super::extended::Extended;
use super::full_response::{FullResponse, Measured};
use super::interfaces::rotation_length;
use super::internal_loads::FullLoads;
use super::leading::leading;
use super::observed::{Observed, Outputs, Response};
use super::outcome::ResponseComparison;
use super::pair_error::PairError;
use super::policy::ResponseExtent;
use super::samples;
use super::scan::{Scan, highest};
use super::shift::shift;
use super::space::{FullModel, Known, Space};
use crate::cache::{Cache, Key, Kind, recalled};
use crate::cost_forecast::FOLLOWED;
use crate::dense;
use crate::eigen::Spectral;
use crate::error::Result;
use crate::factor::{SolveOperator, Storage};
use crate::number::quantity;
use crate::reduction::panel_of;

/// How often the band is scanned: samples that were added may have taught the full model something.
const PASSES: usize = 3;
/// Share of the largest error by which what a scan foresaw may miss what its samples then show.
const SETTLED: f64 = 1e-3;

/// The answers of the full model, for further reduced models to be compared with.
pub(super) struct Full<'a> {
    response: FullResponse,
    /// The reduction whose basis it is.
    own: &'a Evidence<'a>,
    /// The rows of its outputs on that basis.
    outputs: Outputs<'a>,
    /// Of its interior, where its internal loads are compared.
    pub(super) loads: Option<FullLoads<'a>>,
}

impl Full<'_> {
    /// Largest error of the reduced model that has the leading `n` coordinates, with these matrices, in dB.
    ///
    /// # Errors
    /// A reduced pencil that is not definite.
    pub(super) fn worst_decibel(
        &self,
        (evidence, n): (&Evidence<'_>, usize),
        (k, m): (MatRef<'_, f64>, MatRef<'_, f64>),
    ) -> Result<f64> {
        let reduced = Spectral::of(k, m, shift(evidence)?)?;
        let (k, m) = leading(self.own, n)?;
        let of_outputs = Spectral::of(k.as_ref(), m.as_ref(), shift(self.own)?)?;
        let reduced = Observed::new(&reduced, &of_outputs, &self.outputs);
        Ok(self.response.worst(evidence, &reduced).0.decibel)
    }
}

/// The comparison and the values it rests on.
pub(super) struct Compared<'a> {
    pub(super) report: ResponseComparison,
    pub(super) full: Full<'a>,
    /// Bound on the relative error of the full response at its worst sample, and that sample.
    uncertainty: (f64, f64),
}

/// Compares the response of all pairs of interface dofs, and of outputs, over the band. Where internal loads will be compared, samples lie at
/// all resonances. What is inside is that of `own`, the reduction with its basis.
///
/// # Errors
/// A pencil that is not definite.
pub(super) fn compared<'a>(
    (evidence, own): (&Evidence<'_>, &'a Evidence<'a>),
    extent: ResponseExtent,
    (band_hz, eta): ([f64; 2], f64),
) -> Result<Compared<'a>> {
    let spectral =
        |of: &Evidence<'_>| Spectral::of(of.reduction.stiffness.as_ref(), of.reduction.mass.as_ref(), shift(of)?);
    let (reduced, of_outputs) = (spectral(evidence)?, spectral(own)?);
    let outputs = Outputs::of_reduction(own);
    let task = Task { evidence, own, reduced: &reduced, of_outputs: &of_outputs, outputs: &outputs, band_hz, eta };
    let (measured, loads) = match extent {
        // Internal loads are those of the space that the response was found in.
        ResponseExtent::WithInternalLoads => {
            let mut extended = Extended::new(evidence, evidence.factor, eta)?;
            let measured = task.measured_by_solves(First::AllResonances, &mut extended)?.0;
            let loads = FullLoads::new(own, extended, &measured.full.samples_hz, eta)?;
            (measured, Some(loads))
        }
        ResponseExtent::AtInterfaces | ResponseExtent::NotCompared => {
            let cache = evidence.partition.cache().filter(|_| evidence.factor.storage() == Storage::Double);
            (task.recalled_or_known(cache)?, None)
        }
    };
    let report = task.report(&measured);
    let Measured { full, uncertainty, .. } = measured;
    let outputs = outputs.only(&full.outputs);
    Ok(Compared { report, full: Full { response: full, own, outputs, loads }, uncertainty })
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
    own: &'t Evidence<'t>,
    reduced: &'t Spectral,
    /// The reduced model whose coordinates the basis has columns for.
    of_outputs: &'t Spectral,
    /// All outputs on that basis.
    outputs: &'t Outputs<'t>,
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
        let Self { evidence, reduced, band_hz, eta, .. } = *self;
        let mut samples_hz = samples::first(evidence, reduced, band_hz);
        if first == First::AllResonances {
            samples_hz = samples::with_resonances(evidence, reduced, &samples_hz);
        }
        let Some(mut residuals) = full.settle(&samples_hz)? else { return Ok(None) };
        let (mut response, (mut worst, mut at)) = self.answered(full, &samples_hz);
        let mut step = 0.0;
        for _ in 0..PASSES {
            let [known, cut_down] = [self.known_model(full, &response.outputs), self.reduced_model(&response.outputs)];
            let scan = Scan { evidence, full: &known, reduced: &cut_down, eta };
            let found = scan.peaks([samples_hz[0], samples_hz[samples_hz.len() - 1]]);
            step = found.step;
            let driven = [worst.pair.0, worst.pair.1].into_iter().filter(|dof| *dof < evidence.partition.n_interface());
            let (known, driven) = ((&samples_hz[..], &found.peaks_hz[..]), driven.collect::<Vec<_>>());
            samples_hz = samples::with_peaks_and_zeros(evidence, full.spectral(), known, &driven)?;
            let Some(settled) = full.settle(&samples_hz)? else { return Ok(None) };
            residuals = settled;
            (response, (worst, at)) = self.answered(full, &samples_hz);
            if !dense::worse(found.largest_db, (1.0 + SETTLED) * worst.decibel) {
                break;
            }
        }
        let residual = residuals.iter().fold(0.0, |a, b| if dense::worse(*b, a) { *b } else { a });
        let least_known =
            (0..residuals.len()).fold(0, |a, b| if dense::worse(residuals[b], residuals[a]) { b } else { a });
        let peak_shift = peak_shift(evidence, full.spectral(), reduced, band_hz);
        let bound = full.bound(response.samples_hz[least_known]);
        let looked_at = worst.pair.0.checked_sub(bound.len()).map(|row| (row, self.flexibility(response.outputs[row])));
        let uncertainty = (response.uncertainty((&bound, looked_at), least_known), response.samples_hz[least_known]);
        let measured = Measured { full: response, worst, at, residual, step, peak_shift, uncertainty };
        Ok(Some((measured, residuals)))
    }

    /// The answers of the full model at samples, with the rows of outputs that are followed, and where the reduced model errs most.
    fn answered(&self, full: &dyn FullModel, samples_hz: &[f64]) -> (FullResponse, (PairError, usize)) {
        let outputs = self.followed(full, samples_hz);
        let known = self.known_model(full, &outputs);
        let answer = |hz: &f64| Response::of(&known, self.evidence, *hz, self.eta);
        let answers = samples_hz.par_iter().map(answer).collect();
        let response = FullResponse { samples_hz: samples_hz.to_vec(), answers, eta: self.eta, outputs };
        let worst = response.worst(self.evidence, &self.reduced_model(&response.outputs));
        (response, worst)
    }

    /// The outputs that err most, by their numbers.
    fn followed(&self, full: &dyn FullModel, samples_hz: &[f64]) -> Vec<usize> {
        let all: Vec<usize> = (0..self.own.partition.outputs.len()).collect();
        if all.len() <= FOLLOWED {
            return all;
        }
        let [known, cut_down] = [self.known_model(full, &all), self.reduced_model(&all)];
        let scan = Scan { evidence: self.evidence, full: &known, reduced: &cut_down, eta: self.eta };
        let worst = scan.of_outputs(samples_hz);
        let mut most = highest(all.into_iter(), &|at| worst[at], FOLLOWED);
        most.sort_unstable();
        most
    }

    /// The full model as far as it is known, seen at the interface and at outputs.
    fn known_model<'m>(&self, full: &'m dyn FullModel, outputs: &[usize]) -> Observed<'m> {
        let rows = Outputs::on(self.own.partition, outputs, full.basis());
        Observed::new(full.spectral(), full.spectral(), &rows)
    }

    /// The reduced model, seen there.
    fn reduced_model(&self, outputs: &[usize]) -> Observed<'t> {
        Observed::new(self.reduced, self.of_outputs, &self.outputs.only(outputs))
    }

    /// √(T_o K_II⁻¹ T_oᵀ / η) of an output. No solve has made the residual of a force on it small, which is the second number of the bound.
    fn flexibility(&self, output: usize) -> f64 {
        let load = Outputs::on_dofs(self.own.partition, output);
        let mut answer = load.clone();
        self.evidence.factor.solve_in_place(answer.as_mut());
        (dense::dots(load.as_ref(), answer.as_ref())[0] / self.eta).max(0.0).sqrt()
    }

    /// The key of all that [`Task::measured`] takes, from the samples of the reduced model alone.
    fn key(&self) -> Key {
        let Self { evidence, band_hz, eta, .. } = self;
        let Evidence { partition, reduction, retained, basis, .. } = evidence;
        let columns = panel_of(basis, 0..basis.n_reduced());
        let key = evidence.constraint.key(evidence.rigid.key(partition.key("frequency response")));
        let key = key.columns(columns.as_ref()).columns(reduction.stiffness.as_ref()).columns(reduction.mass.as_ref());
        let key = key.numbers(&retained.modes.lambda).shown(&reduction.mass_rank()).shown(&partition.scaling);
        let key = key.numbers(&[rotation_length(partition)]).numbers(band_hz).numbers(&[*eta]);
        let Self { own, .. } = self;
        if own.partition.outputs.is_empty() {
            return key;
        }
        let key = key.shown(&own.partition.outputs);
        key.columns(own.reduction.stiffness.as_ref()).columns(own.reduction.mass.as_ref())
    }

    fn report(&self, measured: &Measured) -> ResponseComparison {
        let (evidence, Measured { full, worst, at, .. }) = (self.evidence, measured);
        let (partition, n_b) = (evidence.partition, evidence.partition.n_interface());
        let name = |row: usize| match row.checked_sub(n_b) {
            Some(output) => partition.outputs[full.outputs[output]].dof.to_string(),
            None => partition.name_of(partition.n_internal + row),
        };
        ResponseComparison {
            boundary: "free".to_owned(),
            damping: self.eta,
            rotation_length: rotation_length(partition),
            n_outputs: partition.outputs.len(),
            residual: measured.residual,
            worst_pair: [name(worst.pair.1), name(worst.pair.0)],
            worst_db: worst.decibel,
            worst_at_hz: full.samples_hz[*at],
            peak_shift: measured.peak_shift,
            scan_step: measured.step,
            samples: full.shown(evidence, &self.reduced_model(&full.outputs), worst.pair),
        }
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
            equation: "max |20 log₁₀ |Ĥ/H||, 20 log₁₀(1 + |Ĥ − H|/|H|) in dB over pairs of dofs, outputs and the band",
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
