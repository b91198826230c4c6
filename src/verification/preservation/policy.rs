//! What is compared with the full model.

use super::super::evidence::Evidence;
use crate::cost_forecast::{Band, Comparisons, Need, Sizes, Stage};
use crate::factor::Analysis;
use crate::job::{Certify, Job, ModeSelection, SceneJob, Support};

/// Modes are kept up to this multiple of the band that a reduction serves: with less, the response at the end of the
/// band has lost a digit that the modes kept could give (Herting: 5 % against 0.5 %).
const CUT_OFF: f64 = 1.5;
/// Dofs up to which an interface without coordinates is shown dof by dof, unless the scene asks for more.
const SHOWN: usize = 24;
/// Whether a scene has anything that moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// It has.
    Compared,
    /// Statics is all it asks.
    NotAsked,
}

/// What of the frequency response is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResponseExtent {
    /// Nothing.
    NotCompared,
    /// Displacements of the interfaces.
    AtInterfaces,
    /// These and internal loads.
    WithInternalLoads,
}

/// What will be compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Lowest and highest frequency of interest, in Hz; none where neither the job nor a mode gives one.
    pub band_hz: Option<[f64; 2]>,
    /// Structural damping factor η of K (1 + iη).
    pub eta: f64,
    /// Supports under which frequencies are compared.
    pub supports: Vec<Support>,
    /// How far the modes under these supports are certified.
    pub certify: Certify,
    /// Whether the frequency response is compared, and internal loads with it.
    pub response: ResponseExtent,
    /// Whether anything that moves is compared.
    pub motion: Motion,
    /// Dofs up to which the statics of an interface without coordinates are compared dof by dof.
    pub shown: usize,
    /// What is not compared, and why.
    pub not_compared: Vec<String>,
}

impl Plan {
    /// What is compared of a job; what moves as [`Comparisons`] weighs it.
    pub fn new(evidence: &Evidence<'_>, analysis: &Analysis, job: &Job) -> Self {
        let default = SceneJob::default();
        let scene = job.scene.as_ref().unwrap_or(&default);
        let band_hz = scene.band_hz.or_else(|| default_band(evidence, job));
        let band = if band_hz.is_some() { Band::Known } else { Band::None };
        let weighed = Comparisons::of(job, &sizes(evidence, analysis, job), band);
        let is_compared = |stage: &Stage| matches!(stage.need, Need::By(_));
        let supports = is_compared(&weighed.frequencies)
            .then(|| scene.boundaries.clone().unwrap_or_else(|| default_supports(evidence)));
        Self {
            band_hz,
            eta: 2.0 * scene.damping.unwrap_or_default().ratio,
            supports: supports.unwrap_or_default(),
            certify: job.run.certify,
            response: match (is_compared(&weighed.response), job.accepted().internal_load) {
                (false, _) => ResponseExtent::NotCompared,
                (true, None) => ResponseExtent::AtInterfaces,
                (true, Some(_)) => ResponseExtent::WithInternalLoads,
            },
            motion: if job.model.mass.is_some() { Motion::Compared } else { Motion::NotAsked },
            shown: if job.accepted().statics.is_some() { usize::MAX } else { SHOWN },
            not_compared: weighed.left_out(),
        }
    }
}

/// What the cost of a comparison depends on.
fn sizes(evidence: &Evidence<'_>, analysis: &Analysis, job: &Job) -> Sizes {
    let n_dynamic = evidence.basis.n_dynamic();
    let n_modes = evidence.retained.modes.count();
    let n_answers = n_dynamic.saturating_sub(n_modes) as f64;
    Sizes { n_answers, ..Sizes::of_model(job, evidence.partition, analysis, n_modes) }
}

/// From zero to where the modes that were kept serve.
fn default_band(evidence: &Evidence<'_>, job: &Job) -> Option<[f64; 2]> {
    let highest = match job.reduction.wanted() {
        ModeSelection::UpTo { up_to_hz } => Some(up_to_hz),
        ModeSelection::Count { .. } => {
            evidence.retained.modes.lambda.last().map(|lambda| evidence.partition.scaling.hertz(*lambda))
        }
    };
    highest.filter(|highest| *highest > 0.0).map(|highest| [0.0, highest / CUT_OFF])
}

/// Free, each interface held, each interface loaded.
fn default_supports(evidence: &Evidence<'_>) -> Vec<Support> {
    let mut names: Vec<&str> = evidence.partition.interface.iter().map(|node| node.name.as_str()).collect();
    names.dedup();
    let fixed = names.iter().map(|name| Support::Fixed { interface: (*name).to_owned() });
    let loaded = names.iter().map(|name| Support::Loaded { interface: (*name).to_owned(), mass: None });
    std::iter::once(Support::Free).chain(fixed).chain(loaded).collect()
}
