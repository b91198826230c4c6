//! Everything the output is made from.

use crate::constraint::LooseMotions;
use crate::factor::Analysis;
use crate::input::InputFacts;
use crate::job::Job;
use crate::plan::{Plan, Statics};
use crate::report::WorkCounters;
use crate::verification::check::Check;
use crate::verification::{Compared, Evidence, Findings};

/// Everything the output is made from.
#[derive(Clone, Copy, Debug)]
pub struct Results<'a> {
    /// What was done, and what was left out.
    pub plan: &'a Plan,
    /// What was read.
    pub input: &'a InputFacts,
    /// Mechanisms and what comes near them.
    pub loose: &'a LooseMotions,
    /// The results of the stages.
    pub evidence: Evidence<'a>,
    /// What verification found.
    pub findings: &'a Findings,
    /// The reduced model compared with the full one.
    pub preserved: &'a Compared,
    /// The symbolic factorisation of K_II.
    pub analysis: &'a Analysis,
    /// Factorisations in addition to that of K_II: those of the modes, the certificate and the enclosures.
    pub n_other_factors: usize,
}

impl<'a> Results<'a> {
    /// The job as the stages have done it.
    pub(super) fn job(&self) -> &'a Job {
        self.plan.job()
    }

    /// All checks in the order of their identifiers.
    pub(super) fn checks(&self) -> Vec<Check> {
        let mut checks = [&self.findings.checks[..], &self.preserved.checks].concat();
        checks.sort_by_key(|check| check.id);
        checks
    }

    /// λ of the retained modes as they are printed. A Rayleigh quotient has a rounding of its own and may lie outside an interval
    /// that is proved to hold the eigenvalue: the middle of the interval then is the better answer.
    pub(super) fn eigenvalues(&self) -> Vec<f64> {
        let Evidence { retained, enclosures, .. } = self.evidence;
        let interval =
            |mode: usize| enclosures.and_then(|enclosures| enclosures.intervals.get(mode).copied().flatten());
        let printed = |(mode, lambda): (usize, &f64)| match interval(mode) {
            Some([low, high]) if !(low..=high).contains(lambda) => 0.5 * (low + high),
            _ => *lambda,
        };
        retained.modes.lambda.iter().enumerate().map(printed).collect()
    }

    /// Numbers of the reduced coordinates that the superelement has: all but those of modes that nothing starts and nothing sees.
    pub(super) fn kept(&self) -> Vec<usize> {
        let is_left_out = |at: usize| self.evidence.unseen.iter().any(|mode| mode.coordinate == at);
        (0..self.evidence.basis.n_reduced()).filter(|at| !is_left_out(*at)).collect()
    }

    /// What was done, counted.
    pub(super) fn work(&self) -> WorkCounters {
        let Evidence { retained, certificate, enclosures, .. } = self.evidence;
        let work = &retained.modes.work;
        WorkCounters {
            n_factorisations: 1
                + self.n_other_factors
                + work.factorisations
                + certificate.map_or(0, |certificate| certificate.n_factorisations)
                + enclosures.map_or(0, |enclosures| enclosures.n_factorisations),
            n_solves: work.solves + self.n_solves_of_the_basis(),
            n_restarts: work.restarts,
            factor_flops: self.analysis.flops,
            factor_nonzeros: self.analysis.nnz_factor as u64,
        }
    }

    /// Right-hand sides of constraint modes, inertia relief, the modes of a file and residual vectors. What is followed and gathered by the
    /// factor takes half a solve each way.
    fn n_solves_of_the_basis(&self) -> usize {
        let Evidence { partition, rigid, basis, .. } = self.evidence;
        if partition.n_interface() == 0 && rigid.count() > 0 {
            // Its modes are the model.
            return 0;
        }
        let of_statics = match self.plan.statics() {
            Statics::Stored => partition.n_interface(),
            Statics::ByFactor => partition.n_interface() + basis.n_reduced(),
            Statics::Condensed | Statics::Carried => 0,
        };
        let n_relieved = rigid.relieved(partition, self.plan.relief()).len();
        let n_inside = (0..partition.loads.count()).filter(|load| partition.loads.acts_inside(*load)).count();
        of_statics + n_relieved + partition.expansion.count() + n_inside
    }
}
