//! What was found of a result.

use super::angles::AmongKnown;
use super::band::{Band, Completed, completed};
use super::checks;
use super::claims::Claims;
use super::independence::independent;
use super::judgement::{Judged, judged_pairs};
use super::measured::Measured;
use super::pair::{JudgedPair, MissingMode, PairKind};
use super::unit;
use crate::error::Result;
use crate::job::{ModeSelection, ModesJob, ReductionJob};
use crate::modes::{Certificate, Component, ModeSource, Search};
use crate::random::SEED;
use crate::verification::check::{Check, Verdict};

/// What was found of eigenpairs that another program computed.
#[derive(Clone, Debug)]
pub struct Certification {
    /// The band in which the result is to be complete, in Hz.
    pub band_hz: [f64; 2],
    /// Rigid-body modes of the model.
    pub n_rigid: usize,
    /// Every pair of the result, in its order.
    pub pairs: Vec<JudgedPair>,
    /// Modes of the model in the band that the result has not, ascending.
    pub missing: Vec<MissingMode>,
    /// Modes that a count finds missing in the band beyond those, too many to be looked for.
    pub n_not_sought: usize,
    /// The count; none where the band ends at zero.
    pub count: Option<BandCount>,
    /// The measures, in the order of their identifiers.
    pub checks: Vec<Check>,
    /// What is to be known of the result besides, one sentence each.
    pub notes: Vec<String>,
}

impl Certification {
    /// The worst verdict of the checks.
    pub fn verdict(&self) -> Verdict {
        self.checks.iter().map(Check::verdict).fold(Verdict::Pass, Verdict::max)
    }

    /// How many pairs are of a kind.
    pub fn n_of(&self, kind: PairKind) -> usize {
        self.pairs.iter().filter(|pair| pair.kind == kind).count()
    }
}

/// A count of the modes of the band, rigid-body modes included where the band begins at zero.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct BandCount {
    /// The frequency up to which was counted.
    pub below_hz: f64,
    /// Eigenvalues counted.
    pub n_counted: usize,
    /// Of those, how many the result has.
    pub n_given: usize,
    /// Pivot growth over the growth up to which the signs of the pivots are certain.
    pub doubt: f64,
}

/// Holds the pairs of a result against the matrices of a component.
///
/// # Errors
/// [`Error::ValuesUnit`](crate::error::Error::ValuesUnit); the stiffness is not definite; a count or a search fails.
pub fn certified_pairs(
    component: Component<'_>,
    job: &ReductionJob,
    claims: &Claims,
    band: Option<Band>,
) -> Result<Certification> {
    let search = Search::new(component, job)?;
    let (problem, partition) = (search.problem, component.partition);
    let (measured, independent) = problem.with_definite_operator(|operator| {
        let measured = Measured::of(problem.modal(), operator, claims);
        unit::refuse_other(partition, claims, &measured)?;
        let independent = independent(problem.modal(), operator, (claims, &measured))?;
        Ok((measured, independent))
    })?;
    let standing = independent.standing;
    let n_of_result = independent.modes.count();
    let completed = completed((&search, partition), independent.modes, (claims, &measured), band)?;
    let completed = match completed.modes.count() > n_of_result {
        true => problem.with_definite_operator(|operator| completed.turned(problem.modal(), operator))?,
        false => completed.with_neighbours(measured.sigma),
    };
    let completed = completed.with_first_elastic((claims, &standing), || first_elastic(component, job))?;
    let known = AmongKnown::of(problem.modal(), (claims, &measured), &completed)?;
    let judged = judged_pairs(&problem, (claims, &measured), &standing, (&completed, known.as_ref()));
    let completed = completed.ending_with(judged.highest);
    let judged = judged_pairs(&problem, (claims, &measured), &standing, (&completed, known.as_ref()));
    let checks = checks::checks(component, (claims, &measured), (&judged, &completed));
    let scaling = partition.scaling;
    Ok(Certification {
        band_hz: completed.ends.map(|lambda| scaling.hertz(lambda)),
        n_rigid: problem.n_rigid(),
        count: count_of(&completed, &judged, |sigma| scaling.hertz(sigma)),
        n_not_sought: completed.n_not_sought,
        notes: checks::notes(component, claims, &judged, &checks),
        checks,
        pairs: judged.pairs,
        missing: judged.lacking.missing,
    })
}

/// λ of the first elastic mode of a free component, which tells what is no frequency; none of one that is held.
fn first_elastic(component: Component<'_>, job: &ReductionJob) -> Result<Option<f64>> {
    if component.rigid.count() == 0 { Ok(None) } else { lowest_elastic(component, job) }
}

/// λ of the lowest elastic mode of a component, wherever the band of the job ends; none where it moves as a rigid body only.
///
/// # Errors
/// What the search refuses.
pub(super) fn lowest_elastic(component: Component<'_>, job: &ReductionJob) -> Result<Option<f64>> {
    if component.rigid.count() >= component.partition.n_dofs() {
        return Ok(None);
    }
    let modes = Some(ModesJob::Computed(ModeSelection::Count { count: 1 }));
    let search = Search::new(component, &ReductionJob { modes, ..job.clone() })?;
    let found = component.factor.vouched(search.lowest(SEED))?;
    Ok(found.lambda.first().copied())
}

/// The count of the band, without what was found outside of it.
fn count_of(completed: &Completed, judged: &Judged, hertz: impl Fn(f64) -> f64) -> Option<BandCount> {
    let certificate: &Certificate = completed.certificate.as_ref()?;
    let lacking = &judged.lacking;
    let n_counted = certificate.n_counted - lacking.n_outside;
    Some(BandCount {
        below_hz: hertz(completed.known_to.max(lacking.counted_to)),
        n_counted,
        n_given: n_counted.saturating_sub(lacking.missing.len() + lacking.n_cut + judged.n_rigid_missing),
        doubt: certificate.doubt(),
    })
}
