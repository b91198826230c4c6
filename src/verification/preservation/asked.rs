//! How far the reduced model answers what the scene asks, and what would answer it: M-29 to M-31, M-34.
//!
//! Limits come from the scene, where a value past one fails, or from practice, where it warns. A value that could not be measured
//! meets no limit of the scene.

use crate::dense;
use crate::job::{AcceptJob, Boundary, Job, Support, boundary_in_words};
use crate::number::quantity;
use crate::verification::evidence::Evidence;

use super::accuracy::{Accuracy, AccuracyMeasure, LimitSource};
use super::advice::{Advice, STEEPEST_FREE, STEEPEST_HELD, band_met, modes_needed};
use super::outcome::{Preservation, SizeError};
use super::policy::{Plan, ResponseExtent};

/// Relative error of a frequency from which on practice asks for a reason. Tests of structures are accepted where frequencies agree
/// with the analysis within 3 % (SMC-S-004) or 5 % (NASA-STD-5002); the reduction may take a third of the smaller one.
const FREQUENCY: f64 = 1e-2;
/// Error of the frequency response, in dB, from which on practice asks for a reason: a factor of three in the worst pair of dofs, at an
/// antiresonance as a rule. Sound reductions stay below it: free modes to 1.5 times the band reach 1 to 3 dB between patches and 7 dB on
/// coarse models with many interface dofs, to twice the band 0.2 to 0.8 dB, held modes to four times the band 2 to 5 dB. Held modes to once
/// or twice the band reach 9 to 24 dB.
const RESPONSE_DB: f64 = 10.0;

/// What is looked at: the results of the stages, what the job asks, and what of it was compared.
pub(super) struct Asked<'a> {
    pub(super) evidence: &'a Evidence<'a>,
    pub(super) job: &'a Job,
    pub(super) plan: &'a Plan,
    pub(super) report: &'a Preservation,
    /// What the basis lacks of the static answer to each load of the job, where that is known.
    pub(super) lacking: Option<Vec<f64>>,
}

impl Asked<'_> {
    /// Every measure of the scene or of practice, in the order of the keys of `accept`.
    pub(super) fn measures(&self) -> Vec<Accuracy> {
        let accept = self.job.accepted();
        if self.plan.supports.is_empty()
            && self.plan.response == ResponseExtent::NotCompared
            && accept == AcceptJob::default()
        {
            return Vec::new();
        }
        let statics = accept.statics.map(|limit| self.statics(limit));
        let loads = accept.internal_load.map(|limit| self.internal_loads(limit));
        let [frequencies, response] = [self.frequencies(accept.frequency), self.response(accept.response_db)];
        [frequencies, response].into_iter().chain(loads).chain(statics).collect()
    }

    fn frequencies(&self, accepted: Option<f64>) -> Accuracy {
        let all = self.report.boundaries.iter().flat_map(|line| {
            let in_band = line.frequencies.iter().enumerate().filter(|(_, pair)| pair.in_band);
            in_band.map(|(mode, pair)| (line.boundary.as_str(), mode + 1, pair))
        });
        let found: Vec<_> = all.collect();
        let size = |at: usize| found[at].2.relative_difference.abs();
        let worst = (0..found.len()).reduce(|a, b| if dense::worse(size(b), size(a)) { b } else { a });
        let (limit, set_by) = limit(accepted, FREQUENCY);
        let mut accuracy = Accuracy::unmeasured(AccuracyMeasure::Frequency, (limit, set_by), self.no_frequencies());
        if self.plan.supports.is_empty() {
            return accuracy;
        }
        let Some(worst) = worst else {
            if self.lacks_no_boundary() {
                accuracy.error = Some(0.0);
                accuracy.at = Some("no elastic frequency lies in the band under any boundary compared".to_owned());
            }
            return accuracy;
        };
        let (boundary, mode, pair) = found[worst];
        // What is missing cannot be better than what is found too bad already.
        if !self.lacks_no_boundary() && size(worst) <= limit.unwrap_or(f64::INFINITY) {
            return accuracy;
        }
        accuracy.error = Some(size(worst));
        let reduced = match pair.reduced_hz.is_finite() {
            true => format!("{} Hz in the reduced model", quantity(pair.reduced_hz, 6)),
            false => "missing in the reduced model".to_owned(),
        };
        let boundary = boundary_in_words(boundary);
        accuracy.at = Some(format!("{boundary}, mode {mode} at {} Hz, {reduced}", quantity(pair.full_hz, 6)));
        if let Some(limit) = limit.filter(|_| !accuracy.is_met()) {
            let errors = found.iter().map(|(.., pair)| (pair.full_hz, pair.relative_difference.abs()));
            let met = band_met("frequencies", errors, limit);
            accuracy.advice = Some(self.advice(met, limit, |size| Some(size.frequency_error)));
        }
        accuracy
    }

    fn response(&self, accepted: Option<f64>) -> Accuracy {
        let (mut limit, set_by) = limit(accepted, RESPONSE_DB);
        // Practice judges the response of the free component where the simulation leaves it free.
        let stated = self.job.scene.as_ref().and_then(|scene| scene.boundaries.as_ref());
        if accepted.is_none() && stated.is_some_and(|boundaries| !boundaries.contains(&Support::Free)) {
            limit = None;
        }
        let Some(response) = &self.report.response else {
            let why = self.why(&["frequency response"]);
            return Accuracy::unmeasured(AccuracyMeasure::Response, (limit, set_by), why);
        };
        let [driven, observed] = &response.worst_pair;
        let place = format!("{driven} to {observed} at {} Hz", quantity(response.worst_at_hz, 6));
        let mut accuracy = Accuracy {
            error: Some(response.worst_db),
            at: Some(place),
            ..Accuracy::unmeasured(AccuracyMeasure::Response, (limit, set_by), None)
        };
        if let Some(limit) = limit.filter(|_| !accuracy.is_met()) {
            let errors = response.samples.iter().map(|sample| (sample.frequency_hz, sample.error_db));
            let met = band_met("the response", errors, limit);
            accuracy.advice = Some(self.advice(met, limit, |size| size.response_error_db));
        }
        accuracy
    }

    fn internal_loads(&self, accepted: f64) -> Accuracy {
        let limits = (Some(accepted), LimitSource::Scene);
        let Some(loads) = &self.report.internal_loads else {
            let why = self.why(&["frequency response"]);
            return Accuracy::unmeasured(AccuracyMeasure::InternalLoad, limits, why);
        };
        let place = format!("a force on {} at {} Hz", loads.driven, quantity(loads.worst_at_hz, 6));
        let mut accuracy = Accuracy {
            error: Some(loads.worst),
            at: Some(place),
            ..Accuracy::unmeasured(AccuracyMeasure::InternalLoad, limits, None)
        };
        if !accuracy.is_met() {
            let errors = loads.samples.iter().map(|sample| (sample.frequency_hz, sample.error));
            let met = band_met("internal loads", errors, accepted);
            accuracy.advice = Some(self.advice(met, accepted, |size| size.internal_load_error));
        }
        accuracy
    }

    /// Statics at the interfaces and under the loads of the job, whichever is worse.
    fn statics(&self, accepted: f64) -> Accuracy {
        let interfaces = self.report.statics.iter().map(|statics| {
            (
                statics.relative_difference,
                format!("interface {}", statics.interface),
                "the static solutions are poor, see M-10",
            )
        });
        let loads =
            self.evidence.partition.loads.facts.iter().zip(self.lacking.iter().flatten()).map(|(load, lacking)| {
                let advice = "leave `residual = true` of the load, which makes its answer exact";
                (*lacking, format!("load {}", load.name), advice)
            });
        let found: Vec<(f64, String, &str)> = interfaces.chain(loads).collect();
        let names: Vec<&str> = self.evidence.partition.interface.iter().map(|node| node.name.as_str()).collect();
        let is_compared = |name: &&str| self.report.statics.iter().any(|statics| statics.interface == **name);
        let is_answered = self.evidence.partition.loads.facts.is_empty() || self.lacking.is_some();
        let unmeasured = names
            .iter()
            .find(|name| !is_compared(name))
            .map(|name| format!("static stiffness of {name} was not compared"));
        let unmeasured =
            unmeasured.or_else(|| (!is_answered).then(|| "nothing answers the loads statically".to_owned()));
        let worst = found.into_iter().reduce(|worst, next| if dense::worse(next.0, worst.0) { next } else { worst });
        let limits = (Some(accepted), LimitSource::Scene);
        match (worst, unmeasured) {
            (Some((error, at, advice)), unmeasured) if unmeasured.is_none() || dense::worse(error, accepted) => {
                let advice = dense::worse(error, accepted).then(|| advice.to_owned());
                let (error, at) = (Some(error), Some(at));
                Accuracy { error, at, advice, ..Accuracy::unmeasured(AccuracyMeasure::Static, limits, None) }
            }
            (_, unmeasured) => {
                let why = unmeasured.or_else(|| Some("the component has neither interfaces nor loads".to_owned()));
                Accuracy::unmeasured(AccuracyMeasure::Static, limits, why)
            }
        }
    }

    fn lacks_no_boundary(&self) -> bool {
        self.plan.supports.len() == self.report.boundaries.len()
    }

    /// Why frequencies were not compared, under one boundary or under all.
    fn no_frequencies(&self) -> Option<String> {
        let asked = self.job.scene.as_ref().and_then(|scene| scene.boundaries.as_ref());
        if asked.is_some_and(Vec::is_empty) {
            return Some("`scene.boundaries` compares none".to_owned());
        }
        self.why(&["frequencies with", "frequencies under", "modes with"])
    }

    /// The first note of what was not compared that begins so, or has it.
    fn why(&self, words: &[&str]) -> Option<String> {
        let notes = &self.report.not_compared;
        notes.iter().find(|note| words.iter().any(|word| note.contains(word))).cloned()
    }

    fn advice(&self, met: String, limit: f64, error: impl Fn(&SizeError) -> Option<f64>) -> String {
        let modes = &self.evidence.retained.modes;
        let hertz =
            |count: usize| Some(self.evidence.partition.scaling.hertz(*modes.lambda.get(count.checked_sub(1)?)?));
        let points = self.report.size_errors.iter().filter_map(|size| Some((hertz(size.n_modes)?, error(size)?)));
        let points: Vec<(f64, f64)> = points.collect();
        let are_free = self.evidence.retained.boundary == Boundary::FreeInterface;
        let advice = Advice {
            met,
            modes_to_hz: modes_needed(&points, limit, if are_free { STEEPEST_FREE } else { STEEPEST_HELD }),
            kept_to_hz: hertz(modes.count()),
            band_end_hz: self.plan.band_hz.map_or(0.0, |[_, high]| high),
            are_free,
        };
        advice.to_string()
    }
}

fn limit(accepted: Option<f64>, practice: f64) -> (Option<f64>, LimitSource) {
    match accepted {
        Some(limit) => (Some(limit), LimitSource::Scene),
        None => (Some(practice), LimitSource::Practice),
    }
}
