//! What leaves the tool: the superelement and the report, in the user's units.
//!
//! The stages work in scaled units; here, and only here, the powers of two are put back. Modal coordinates are scaled so
//! that named modes are mass-normalised in the user's units.

mod recovery;
mod report;
mod rigid_body;
mod superelement;
mod warnings;

use std::collections::BTreeMap;

use supel_runtime::Superelement;

use crate::error::Result;
use crate::factor::Analysis;
use crate::input::{Input, InputNote, PatchFaces};
use crate::job::Job;
use crate::report::{Report, Warning, WorkCounters};
use crate::rigid::LooseMotions;
use crate::verification::check::Check;
use crate::verification::{Compared, Evidence, Findings};

/// What is remembered of the input after its matrices have gone into the model.
#[derive(Clone, Debug)]
pub struct InputFacts {
    /// Digits and digest of K and M.
    pub matrices: [MatrixFacts; 2],
    /// Digests of the other files by their role: `dofs`, `nodes`, and `nodes_data` for what those refer to.
    pub files: BTreeMap<&'static str, String>,
    /// Remarks of the readers that are no warnings.
    pub notes: Vec<String>,
    /// Remarks that are warnings.
    pub warnings: Vec<Warning>,
}

/// What is remembered of one matrix.
#[derive(Clone, Debug)]
pub struct MatrixFacts {
    /// Stored entries, both triangles.
    pub n_nonzeros: usize,
    /// Significant digits.
    pub digits: u32,
    /// BLAKE3 of the file.
    pub digest: String,
}

impl InputFacts {
    /// Records the facts of an input.
    pub fn of(input: &Input) -> Self {
        let facts = |matrix: &crate::input::MatrixInput| MatrixFacts {
            n_nonzeros: matrix.matrix.nnz(),
            digits: matrix.digits,
            digest: matrix.digest.clone(),
        };
        Self {
            matrices: [facts(&input.stiffness), facts(&input.mass)],
            files: input.digests.clone(),
            notes: input.notes.iter().filter(|note| note.warning_code().is_none()).map(ToString::to_string).collect(),
            warnings: input.notes.iter().filter_map(warning).collect(),
        }
    }
}

impl InputFacts {
    /// BLAKE3 of every file by its role, as the superelement keeps them.
    pub fn digests(&self) -> BTreeMap<&'static str, &str> {
        let [stiffness, mass] = &self.matrices;
        let matrices = [("stiffness", stiffness.digest.as_str()), ("mass", mass.digest.as_str())];
        matrices.into_iter().chain(self.files.iter().map(|(role, digest)| (*role, digest.as_str()))).collect()
    }
}

fn warning(note: &InputNote) -> Option<Warning> {
    note.warning_code().map(|code| Warning { code, message: note.to_string() })
}

/// Everything the output is made from.
#[derive(Clone, Copy, Debug)]
pub struct Results<'a> {
    /// The job.
    pub job: &'a Job,
    /// What was read.
    pub input: &'a InputFacts,
    /// Faces of the patches whose origin is the mean of their nodes, as far as the mesh tells.
    pub faces: &'a [PatchFaces],
    /// Mechanisms and what comes near them.
    pub loose: &'a LooseMotions,
    /// The results of the stages.
    pub evidence: Evidence<'a>,
    /// What verification found.
    pub findings: &'a Findings,
    /// The reduced beside the full model.
    pub preserved: &'a Compared,
    /// The symbolic factorisation of K_II.
    pub analysis: &'a Analysis,
    /// Factorisations beside that of K_II, those of the modes, the certificate and the enclosures.
    pub n_beside: usize,
}

impl Results<'_> {
    /// All checks in the order of their identifiers.
    fn checks(&self) -> Vec<Check> {
        let mut checks = [&self.findings.checks[..], &self.preserved.checks].concat();
        checks.sort_by_key(|check| check.id);
        checks
    }

    /// λ of the retained modes as they are printed. A Rayleigh quotient has a rounding of its own and may lie outside an interval
    /// that is proved to hold the eigenvalue: the middle of the interval then is the better answer.
    fn eigenvalues(&self) -> Vec<f64> {
        let Evidence { retained, enclosures, .. } = self.evidence;
        let interval =
            |mode: usize| enclosures.and_then(|enclosures| enclosures.intervals.get(mode).copied().flatten());
        let printed = |(mode, lambda): (usize, &f64)| match interval(mode) {
            Some([low, high]) if !(low..=high).contains(lambda) => 0.5 * (low + high),
            _ => *lambda,
        };
        retained.modes.lambda.iter().enumerate().map(printed).collect()
    }

    /// What was done, counted.
    fn work(&self) -> WorkCounters {
        let Evidence { partition, rigid, retained, certificate, enclosures, .. } = self.evidence;
        let work = &retained.modes.work;
        WorkCounters {
            n_factorisations: 1
                + self.n_beside
                + work.factorisations
                + certificate.map_or(0, |certificate| certificate.n_factorisations)
                + enclosures.map_or(0, |enclosures| enclosures.n_factorisations),
            n_solves: work.solves + partition.n_interface() + rigid.count(),
            n_restarts: work.restarts,
            factor_flops: self.analysis.flops,
            factor_nonzeros: self.analysis.nnz_factor as u64,
        }
    }
}

/// The superelement and its report.
///
/// # Errors
/// A result that the file format refuses, such as a value that is not finite; a solve that did not come down to rounding.
pub fn output(results: &Results<'_>) -> Result<(Superelement, Report)> {
    results.evidence.factor.refinement()?;
    let body = report::body(results);
    let superelement = superelement::superelement(results, body.verdict())?;
    let run = crate::report::RunFacts { work: results.work(), ..Default::default() };
    Ok((superelement, Report { body, run }))
}

/// The frequency of an eigenvalue in scaled units, in rad/s.
fn omega(lambda: f64, unit: f64) -> f64 {
    (lambda * unit).max(0.0).sqrt()
}
