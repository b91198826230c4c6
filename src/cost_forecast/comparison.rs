//! What is compared of a component that moves, and what is left out because it would take longer than the reduction.

use super::scan::scans;
use super::sizes::{Proofs, Sizes};
use super::stage::{Need, Stage, stages};
use super::work::{NOMINAL, Work};
use crate::factor::Analysis;
use crate::job::{AnalysisJob, Certify, Job, ModeSelection};
use crate::memory_forecast::{Compared, MODES_IN_A_BAND, RESPONSE_BLOCKS, Response, n_looked_for};
use crate::number::quantity;
use crate::partition::Partition;
use crate::plan::Plan;

/// Work that a comparison which the job does not ask for may take on any job: half a second of the nominal machine.
const SMALL: f64 = 0.5;

/// Whether there is a band to compare in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Band {
    /// The scene states one, or modes that are kept do.
    Known,
    /// Nothing gives one.
    None,
}

impl Band {
    /// Of a plan that keeps so many modes, where that is known.
    pub fn of(plan: &Plan, n_modes: Option<usize>) -> Self {
        let job = plan.job();
        let is_stated = job.scene.as_ref().is_some_and(|scene| scene.band_hz.is_some());
        let of_modes = match job.reduction.wanted() {
            ModeSelection::UpTo { up_to_hz } => up_to_hz > 0.0,
            ModeSelection::Count { count } => n_modes.unwrap_or(count) > 0,
        };
        if is_stated || of_modes { Self::Known } else { Self::None }
    }
}

/// The two comparisons of what moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparisons {
    /// Frequencies under other boundaries.
    pub frequencies: Stage,
    /// The frequency response.
    pub response: Stage,
}

impl Comparisons {
    /// Whatever the scene states is compared at any cost, the rest while it costs no more than the reduction itself, by estimates on a nominal
    /// machine: another machine compares what this one does.
    pub fn of(job: &Job, sizes: &Sizes, band: Band) -> Self {
        let default = Default::default();
        let scene = job.scene.as_ref().unwrap_or(&default);
        let accept = job.accepted();
        let never = match (scene.analysis, band) {
            (Some(AnalysisJob::Static), _) => Some("the scene asks for statics alone"),
            (_, Band::None) => Some("no elastic mode is computed and the scene gives no band_hz"),
            (_, Band::Known) => None,
        };
        let no_interface = (sizes.n_interface == 0.0).then_some("the component has no interface");
        let own: Work = stages(sizes).iter().map(|stage| stage.work).sum();
        // A job that asks for more than a count asks for the whole comparison.
        let is_full = !matches!(job.run.certify, Certify::None | Certify::Count);
        let is_stated = is_full || scene.boundaries.is_some() || accept.frequency.is_some();
        let weigh = |name, none: Option<&'static str>, work: Work, is_stated: bool| {
            let dear = if is_stated { None } else { dearer(work, own) };
            match none.map(str::to_owned).or(dear) {
                Some(why) => Stage { name, need: Need::LeftOut(why), work: Work::default() },
                None => Stage { name, need: Need::By("the verdict"), work },
            }
        };
        let of_others = others(sizes, n_supports(job, sizes));
        // Without an interface there is one boundary, whose frequencies are those of the modes themselves.
        let none = never.or(no_interface.filter(|_| accept.frequency.is_none()));
        let frequencies = weigh("frequencies under other boundaries", none, of_others, is_stated);
        let is_stated = is_full || scene.band_hz.is_some() || scene.damping.is_some() || accept.accepts_response();
        let mut response = weigh("frequency response", never.or(no_interface), response(sizes), is_stated);
        // Scans are part of the comparison, and of no decision about it.
        if matches!(response.need, Need::By(_)) {
            response.work = response.work + scans(job, sizes, extended(sizes));
        }
        Self { frequencies, response }
    }

    /// What is compared, as far as it takes memory, of a planned run that looks for so many modes; where nobody knows how many, of as many as
    /// are assumed.
    pub fn in_memory(plan: &Plan, (partition, analysis): (&Partition, &Analysis), n_modes: Option<usize>) -> Compared {
        let band = Band::of(plan, n_modes);
        let n_modes = n_looked_for(plan.job(), n_modes).unwrap_or(MODES_IN_A_BAND);
        let sizes = Sizes::of(plan, partition, analysis, (n_modes, 0));
        let Self { frequencies, response } = Self::of(plan.job(), &sizes, band);
        let is_compared = |stage: &Stage| matches!(stage.need, Need::By(_));
        let n_supports = n_supports(plan.job(), &sizes) as usize;
        Compared {
            n_supports: if is_compared(&frequencies) { n_supports } else { 0 },
            response: if is_compared(&response) { Response::Compared } else { Response::LeftOut },
        }
    }

    /// What is not compared, and why; one line where both are left out for one reason.
    pub fn left_out(&self) -> Vec<String> {
        match (&self.frequencies.need, &self.response.need) {
            (Need::LeftOut(a), Need::LeftOut(b)) if a == b => {
                vec![format!("frequencies under other boundaries and the frequency response: {a}")]
            }
            _ => [&self.frequencies, &self.response].into_iter().filter_map(Stage::left_out).collect(),
        }
    }
}

/// Supports under which frequencies are compared.
fn n_supports(job: &Job, sizes: &Sizes) -> f64 {
    let stated = job.scene.as_ref().and_then(|scene| scene.boundaries.as_ref());
    stated.map_or((2.0 * sizes.n_interfaces).max(1.0), |stated| stated.len() as f64)
}

/// Frequencies under so many boundaries: the rows that each leaves of K and M, an eigensolution with the factor that is there, and one count
/// for all.
fn others(sizes: &Sizes, n_supports: f64) -> Work {
    let counted = if sizes.proofs == Proofs::None { Work::default() } else { sizes.count() };
    (sizes.passes(2.0) + sizes.eigensolution(sizes.n_modes)) * n_supports + counted
}

/// Columns of the space in which the response converges.
fn extended(sizes: &Sizes) -> f64 {
    sizes.n_reduced() + RESPONSE_BLOCKS * sizes.n_interface
}

/// The frequency response: blocks of solves until the answer converges, and the residuals of all samples, with the extended basis.
fn response(sizes: &Sizes) -> Work {
    let n_b = sizes.n_interface;
    let extended = extended(sizes);
    sizes.solves(RESPONSE_BLOCKS * n_b)
        + sizes.products(RESPONSE_BLOCKS * 4.0 * n_b)
        + sizes.dense(12.0 * RESPONSE_BLOCKS * extended, n_b)
        + sizes.dense(2.0 * extended + n_b, 2.0 * extended + n_b)
}

/// Why a comparison is left out, with its estimate, where it costs more than the reduction itself.
fn dearer(comparison: Work, own: Work) -> Option<String> {
    let (cost, reduction) = (comparison.seconds(&NOMINAL), own.seconds(&NOMINAL));
    (cost > SMALL.max(reduction)).then(|| {
        format!(
            "it would take an estimated {} operations, {} times the work of the reduction itself; state it in [scene] to have it",
            quantity(comparison.flops(), 2),
            quantity(cost / reduction, 2)
        )
    })
}
