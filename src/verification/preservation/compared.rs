//! The whole comparison of the reduced with the full model, as far as the plan asks for it.

use rayon::prelude::*;

use crate::error::{Error, Result};
use crate::factor::Analysis;
use crate::job::{Certify, Job};
use crate::memory_forecast::TOGETHER_UP_TO;
use crate::random::SEED;
use crate::verification::check::Check;
use crate::verification::evidence::Evidence;
use crate::verification::named_loads;

use super::boundaries;
use super::boundary::Boundary;
use super::counts::Condensed;
use super::interfaces::Interface;
use super::internal_loads::FullLoads;
use super::reference::Reference;

use super::accuracy::Accuracy;
use super::asked::Asked;
use super::outcome::Preservation;
use super::policy::{Motion, Plan, ResponseExtent};
use super::unmade::{Unmade, unmade_check};
use super::{counts, interfaces, mac, response, sizes, statics};

/// The comparison for the report, and the checks that follow from it.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    /// The reduced model compared with the full one.
    pub report: Preservation,
    /// M-06, M-15, M-17, M-20, M-21, M-24, M-29 to M-31 and M-34, as far as they were made, and M-33 where one could not be.
    pub checks: Vec<Check>,
    /// Comparisons that could not be made.
    pub unmade: Vec<Unmade>,
}

/// Compares the reduced with the full model; `analysis` is the structure of K_II.
///
/// # Errors
/// No memory. A comparison that the arithmetic cannot make is left out, the report names it, and M-33 counts it.
pub fn preservation(evidence: &Evidence<'_>, analysis: &Analysis, job: &Job) -> Result<Compared> {
    preservation_of_file((evidence, evidence), analysis, job)
}

/// Compares the reduced matrices of a file with the full model. `evidence` has those of the file and is otherwise `own`, the results of
/// the stages for the same job, whose basis answers the loads.
///
/// # Errors
/// As [`preservation`] has them.
pub fn preservation_of_file(
    (evidence, own): (&Evidence<'_>, &Evidence<'_>),
    analysis: &Analysis,
    job: &Job,
) -> Result<Compared> {
    let plan = Plan::new(evidence, analysis, job);
    let mut compared = measured((evidence, own), analysis, &plan)?;
    compared.checks.extend(unmade_check(&compared.unmade));
    let report = &compared.report;
    let lacking = job.accepted().statics.and_then(|_| named_loads::lacking(own));
    let accuracy = Asked { evidence, job, plan: &plan, report, lacking }.measures();
    compared.checks.extend(accuracy.iter().filter_map(Accuracy::check));
    compared.report.accuracy = accuracy;
    Ok(compared)
}

fn measured((evidence, own): (&Evidence<'_>, &Evidence<'_>), analysis: &Analysis, plan: &Plan) -> Result<Compared> {
    let interfaces = interfaces::interfaces(evidence.partition);
    let mut compared = Compared::default();
    compared.report.not_compared = plan.not_compared.clone();
    compared.report.band_hz = plan.band_hz;
    if evidence.reduction.n_reduced() == 0 {
        return Ok(compared);
    }
    if plan.motion == Motion::Compared {
        compared.modes((evidence, own))?;
    }
    let notes = &mut compared.report.not_compared;
    compared.report.statics = statics::statics(evidence, &interfaces, plan.shown, notes);
    compared.checks.extend(statics::check(evidence, &compared.report.statics));
    if let Some(band_hz) = plan.band_hz.filter(|_| plan.motion == Motion::Compared) {
        let references = compared.references(evidence, analysis, &interfaces, plan)?;
        compared.dynamics((evidence, own), (plan, band_hz), &references)?;
    }
    Ok(compared)
}

impl Compared {
    /// Keeps a result, or notes what could not be compared; only a lack of memory ends the run.
    pub(super) fn kept<T>(&mut self, what: &str, result: Result<T>) -> Result<Option<T>> {
        match result {
            Ok(value) => Ok(Some(value)),
            Err(error @ Error::OutOfMemory { .. }) => Err(error),
            Err(error) => {
                self.report.not_compared.push(format!("{what}: {error}"));
                self.unmade.push(Unmade::of(what, &error));
                Ok(None)
            }
        }
    }

    fn modes(&mut self, (evidence, own): (&Evidence<'_>, &Evidence<'_>)) -> Result<()> {
        if evidence.retained.modes.count() > 0
            && let Some(preserved) = self.kept("shapes of the retained modes", mac::preserved(evidence))?
        {
            self.checks.push(mac::check(&preserved.modes));
            (self.report.modes, self.report.mac) = (preserved.modes, preserved.mac);
        }
        // Damping is that of the same coordinates.
        self.report.highest = self.kept("highest reduced frequency", sizes::highest(own))?.flatten();
        Ok(())
    }

    /// The full model under each boundary of the plan, counted where counts are made.
    pub(super) fn references(
        &mut self,
        evidence: &Evidence<'_>,
        analysis: &Analysis,
        interfaces: &[Interface],
        plan: &Plan,
    ) -> Result<Vec<Reference>> {
        let mut references = Vec::new();
        let limit = plan.band_hz.map_or(0.0, |[_, high]| evidence.partition.scaling.eigenvalue(high));
        let solved = |support| Reference::new(evidence, Boundary::new(evidence, interfaces, support), limit, SEED);
        let solved: Vec<Result<Reference>> = if evidence.partition.n_dofs() <= TOGETHER_UP_TO {
            plan.supports.par_iter().map(solved).collect()
        } else {
            plan.supports.iter().map(solved).collect()
        };
        for (support, solved) in plan.supports.iter().zip(solved) {
            let what = format!("frequencies with boundary {support}");
            let Some(reference) = self.kept(&what, solved)? else { continue };
            match reference.unsound(evidence) {
                Some(why) => self.report.not_compared.push(format!("{what}: {why}")),
                None => references.push(reference),
            }
        }
        if plan.certify != Certify::None && !references.is_empty() {
            self.count(evidence, analysis, &mut references, limit)?;
        }
        Ok(references)
    }

    /// Counts the modes of every reference; where one is missing it is looked for from another start.
    fn count(
        &mut self,
        evidence: &Evidence<'_>,
        analysis: &Analysis,
        references: &mut [Reference],
        limit: f64,
    ) -> Result<()> {
        const WHAT: &str = "number of modes under other boundaries";
        /// Other starts from which a missing mode is looked for.
        const STARTS: u64 = 3;
        if references.iter().all(|reference| reference.count.is_some()) {
            return Ok(());
        }
        let condensed = Condensed::new(evidence, analysis, references, limit);
        let Some(condensed) = self.kept(WHAT, condensed)? else { return Ok(()) };
        let Some(condensed) = condensed else {
            self.report.not_compared.push(format!("{WHAT}: every shift above the band lies on an eigenvalue"));
            return Ok(());
        };
        for reference in references.iter_mut().filter(|reference| reference.count.is_none()) {
            let count = condensed.count(evidence, reference)?;
            reference.counted(evidence, count);
            for start in 1..=STARTS {
                if reference.count.is_none_or(|count| count.n_counted == count.n_found) {
                    break;
                }
                let again = Reference::new(evidence, reference.boundary.clone(), limit, SEED + start);
                if let Some(again) = self.kept(&format!("modes with boundary {}", reference.boundary.name), again)? {
                    *reference = again;
                    let count = condensed.count(evidence, reference)?;
                    reference.counted(evidence, count);
                }
            }
            if reference.count.is_none() {
                let name = &reference.boundary.name;
                self.report.not_compared.push(format!("number of modes with boundary {name}: rounding decides it"));
            }
        }
        Ok(())
    }

    fn dynamics(
        &mut self,
        (evidence, own): (&Evidence<'_>, &Evidence<'_>),
        (plan, band_hz): (&Plan, [f64; 2]),
        references: &[Reference],
    ) -> Result<()> {
        for reference in references {
            let what = format!("frequencies with boundary {}", reference.boundary.name);
            let comparison = self.kept(&what, reference.comparison(evidence, band_hz))?;
            self.report.boundaries.extend(comparison);
        }
        let response = if plan.response != ResponseExtent::NotCompared {
            let response = response::compared((evidence, own), plan.response, (band_hz, plan.eta));
            self.kept("frequency response", response)?
        } else {
            None
        };
        if let Some(response) = &response {
            self.checks.extend(response::checks(response));
            self.report.response = Some(response.report.clone());
            self.report.internal_loads = response.full.loads.as_ref().map(FullLoads::compared);
        }
        let monotonicity = boundaries::monotonicity(evidence, references);
        let monotonicity = self.kept("monotonicity of the frequencies", monotonicity)?.flatten();
        self.checks.extend(counts::check(references));
        self.checks.extend(monotonicity);
        let full = response.as_ref().map(|response| &response.full);
        let sizes = sizes::size_errors(evidence, references, full, band_hz);
        self.report.size_errors = self.kept("errors of smaller bases", sizes)?.unwrap_or_default();
        Ok(())
    }
}
