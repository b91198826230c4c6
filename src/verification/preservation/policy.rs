//! What is compared with the full model. Only this module weighs the cost.

use super::super::evidence::Evidence;
use crate::dense;
use crate::factor::Analysis;
use crate::job::{Certify, Job, ModeSelection, SceneJob, Support};

/// Modes are kept up to this multiple of the band that a reduction serves: with less, the response at the end of the
/// band has lost a digit that the modes kept could give (Herting: 5 % against 0.5 %).
const CUT_OFF: f64 = 1.5;
/// Floating-point operations that a comparison which the job does not ask for may cost: a few seconds of one core.
const UNASKED_FLOPS: f64 = 1e10;
/// Dofs up to which an interface without coordinates is shown dof by dof, unless the scene asks for more.
const SHOWN: usize = 24;
/// Right-hand sides an eigensolution takes in addition to three for each mode found.
const SOLVES_BESIDE: f64 = 64.0;
/// Blocks of n_B right-hand sides that the response converges in.
const RESPONSE_BLOCKS: f64 = 6.0;

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
    /// Whether the frequency response is compared.
    pub response: bool,
    /// Dofs up to which the statics of an interface without coordinates are compared dof by dof.
    pub shown: usize,
    /// What is not compared, and why.
    pub not_compared: Vec<String>,
}

impl Plan {
    /// Whatever the scene states is compared at any cost, the defaults only while they are cheap.
    ///
    /// A support costs an eigensolution with the factor that is already there: s = 3k + 64 solves of 4 nnz(L) operations each, and
    /// 4 n s² to keep them orthogonal, which count a quarter. Counting the modes of all of them costs one factorisation.
    /// The response costs six blocks of n_B such solves, 24 n r n_B operations for the residuals in each, and 2 n (2r + n_B)²
    /// for those of all samples, r being the order of the basis it ends with.
    pub fn new(evidence: &Evidence<'_>, analysis: &Analysis, job: &Job) -> Self {
        let default = SceneJob::default();
        let scene = job.scene.as_ref().unwrap_or(&default);
        let accept = job.accepted();
        let mut plan = Self {
            band_hz: scene.band_hz.or_else(|| default_band(evidence, job)),
            eta: 2.0 * scene.damping.unwrap_or_default().ratio,
            supports: scene.boundaries.clone().unwrap_or_else(|| default_supports(evidence)),
            certify: job.run.certify,
            response: true,
            shown: if accept.statics.is_some() { usize::MAX } else { SHOWN },
            not_compared: Vec::new(),
        };
        let mut leave_out = |what: &str, why: &str| plan.not_compared.push(format!("{what}: {why}"));
        const DYNAMICS: &str = "frequencies under other boundaries and the frequency response";
        if evidence.partition.n_interface() == 0 {
            leave_out(DYNAMICS, "the component has no interface");
            (plan.supports, plan.response) = (Vec::new(), false);
        } else if plan.band_hz.is_none() {
            leave_out(DYNAMICS, "no elastic mode is computed and the scene gives no band_hz");
            (plan.supports, plan.response) = (Vec::new(), false);
        }
        let cost = Cost::of(evidence, analysis);
        let dear = "it would take long on a model of this size; state it in [scene] to have it";
        // A job that asks for more than a count asks for the whole comparison.
        let is_full = !matches!(job.run.certify, Certify::None | Certify::Count);
        let is_asked = is_full || scene.boundaries.is_some() || accept.frequency.is_some();
        let of_supports =
            cost.support * cost.n_new_supports + if job.run.certify == Certify::None { 0.0 } else { cost.count };
        if !is_asked && !plan.supports.is_empty() && of_supports > UNASKED_FLOPS {
            plan.not_compared.push(format!("frequencies under other boundaries: {dear}"));
            plan.supports.clear();
        }
        let is_stated = scene.band_hz.is_some() || scene.damping.is_some() || accept.response_db.is_some();
        let is_asked = is_full || is_stated;
        if plan.response && !is_asked && cost.response > UNASKED_FLOPS {
            plan.not_compared.push(format!("frequency response: {dear}"));
            plan.response = false;
        }
        plan
    }
}

/// Predicted floating-point operations.
struct Cost {
    support: f64,
    n_new_supports: f64,
    count: f64,
    response: f64,
}

impl Cost {
    fn of(evidence: &Evidence<'_>, analysis: &Analysis) -> Self {
        let n = evidence.partition.n_dofs() as f64;
        let n_b = evidence.partition.n_interface() as f64;
        let n_modes = evidence.retained.modes.count() as f64;
        let solve = 4.0 * analysis.nnz_factor;
        let n_solves = 3.0 * n_modes + SOLVES_BESIDE;
        let extended = evidence.reduction.n_reduced() as f64 + RESPONSE_BLOCKS * n_b;
        let residuals = n * (RESPONSE_BLOCKS * 24.0 * extended * n_b + 2.0 * (2.0 * extended + n_b).powi(2));
        Self {
            support: n_solves * (solve + 4.0 * n * n_solves / dense::GAIN),
            n_new_supports: default_supports(evidence).len().saturating_sub(1) as f64,
            count: analysis.flops,
            response: RESPONSE_BLOCKS * n_b * solve + residuals,
        }
    }
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
