//! The answers of the full model at its samples, and how far those of a reduced model are from them.

use rayon::prelude::*;

use super::super::evidence::Evidence;
use super::interfaces::interface_lengths;
use super::observed::{Observed, Response};
use super::outcome::ResponseSample;
use super::pair_error::{PairError, magnitude, worst_pair};
use crate::cache::{Kind, Reader, Recorded, Writer};
use crate::dense;

/// The response of the full model at its samples.
pub(super) struct FullResponse {
    pub(super) samples_hz: Vec<f64>,
    pub(super) answers: Vec<Response>,
    pub(super) eta: f64,
    /// Numbers of the outputs whose rows the answers have behind those of the interface.
    pub(super) outputs: Vec<usize>,
}

impl FullResponse {
    /// The worst pair of a reduced model and the sample it is worst at.
    pub(super) fn worst(&self, evidence: &Evidence<'_>, reduced: &Observed<'_>) -> (PairError, usize) {
        let start = (PairError { pair: (0, 0), decibel: 0.0 }, 0);
        self.errors(evidence, reduced).into_iter().enumerate().fold(start, |worst, (at, error)| {
            if dense::worse(error.decibel, worst.0.decibel) { (error, at) } else { worst }
        })
    }

    /// The worst pair of every sample.
    fn errors(&self, evidence: &Evidence<'_>, reduced: &Observed<'_>) -> Vec<PairError> {
        let samples = self.samples_hz.par_iter().zip(&self.answers);
        samples.map(|(hz, full)| worst_pair(full, &Response::of(reduced, evidence, *hz, self.eta))).collect()
    }

    /// Magnitudes of one pair, and the largest error of all pairs; rotations count as displacements at the length.
    pub(super) fn shown(
        &self,
        evidence: &Evidence<'_>,
        reduced: &Observed<'_>,
        pair: (usize, usize),
    ) -> Vec<ResponseSample> {
        let partition = evidence.partition;
        let lengths = interface_lengths(partition);
        let scale = |row: usize| lengths.get(row).copied().unwrap_or(1.0);
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

    /// Largest bound on the error of an entry of the full response over that entry, at one sample, of pairs of interface dofs and of one
    /// output; `bound` as [`super::space::FullModel::bound`] has it, the output with what stands for its residual.
    pub(super) fn uncertainty(&self, (bound, output): (&[f64], Option<(usize, f64)>), at: usize) -> f64 {
        let answer = &self.answers[at];
        let n = answer.n();
        let mut largest = 0.0;
        for j in 0..n {
            let of_output = output.map(|(row, flexibility)| (n + row, flexibility));
            for (i, own) in (0..=j).map(|i| (i, bound[i])).chain(of_output) {
                let relative = own * bound[j] / magnitude(answer, i, j);
                if dense::worse(relative, largest) {
                    largest = relative;
                }
            }
        }
        largest
    }
}

/// The response of the full model and what the comparison with it found.
pub(super) struct Measured {
    pub(super) full: FullResponse,
    /// The worst pair, and the sample it is worst at.
    pub(super) worst: PairError,
    pub(super) at: usize,
    /// The largest relative residual of the full response.
    pub(super) residual: f64,
    /// Of the last scan.
    pub(super) step: f64,
    pub(super) peak_shift: f64,
    /// Bound on the relative error of the full response at its worst sample, and that sample.
    pub(super) uncertainty: (f64, f64),
}

impl Recorded for Measured {
    const KIND: Kind = Kind::Response;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { full, worst, at, residual, step, peak_shift, uncertainty } = self;
        to.array(&full.samples_hz)?;
        for answer in &full.answers {
            answer.write(to)?;
        }
        to.counts(&full.outputs)?;
        to.counts(&[worst.pair.0, worst.pair.1, *at])?;
        to.array(&[worst.decibel, *residual, *step, *peak_shift, uncertainty.0, uncertainty.1, full.eta])
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let samples_hz: Vec<f64> = from.array()?;
        let answers = samples_hz.iter().map(|_| Response::read(from)).collect::<Option<Vec<_>>>()?;
        let outputs = from.counts()?;
        let [row, column, at] = from.counts()?[..] else { return None };
        let [decibel, residual, step, peak_shift, bound, bound_at, eta] = from.array()?[..] else { return None };
        let (worst, uncertainty) = (PairError { pair: (row, column), decibel }, (bound, bound_at));
        (at < samples_hz.len()).then_some(Self {
            full: FullResponse { samples_hz, answers, eta, outputs },
            worst,
            at,
            residual,
            step,
            peak_shift,
            uncertainty,
        })
    }
}
