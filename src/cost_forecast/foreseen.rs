//! What is foreseen of a run that goes on, for its progress to be shown.

use super::comparison::{Band, Comparisons};
use super::sizes::Sizes;
use super::stage::stages;
use super::work::NOMINAL;
use crate::factor::Analysis;
use crate::partition::Partition;
use crate::plan::Plan;

/// Modes assumed where nothing tells how many there will be.
const ASSUMED: usize = 50;
/// The stage in which the reduced model is compared with the full one.
const COMPARISON: &str = "preservation";

/// What is foreseen of a run that goes on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Foreseen {
    /// Seconds of each stage on the nominal machine, in their order; only their ratios mean something on another one.
    pub seconds: Vec<(&'static str, f64)>,
    /// Operations of a factorisation.
    pub factor_flops: f64,
    /// n_B.
    pub n_interface: usize,
    /// Modes that are looked for, where that is known.
    pub n_modes: Option<usize>,
}

impl Foreseen {
    /// What is foreseen once the structure of the factor is known.
    pub fn of(plan: &Plan, (partition, analysis): (&Partition, &Analysis), n_modes: Option<usize>) -> Self {
        let sizes = Sizes::of(plan, partition, analysis, (n_modes.unwrap_or(ASSUMED), 0));
        let stages = stages(&sizes);
        let Comparisons { frequencies, response } = Comparisons::of(plan.job(), &sizes, Band::of(plan, n_modes));
        let is_last = |name: &str| name.starts_with(COMPARISON);
        let of_comparison: f64 = stages
            .iter()
            .filter(|stage| is_last(stage.name))
            .map(|stage| &stage.work)
            .chain([&frequencies.work, &response.work])
            .map(|work| work.seconds(&NOMINAL))
            .sum();
        let before = stages.iter().filter(|stage| !is_last(stage.name));
        let seconds = before.map(|stage| (stage.name, stage.work.seconds(&NOMINAL)));
        Self {
            seconds: seconds.chain([(COMPARISON, of_comparison)]).collect(),
            factor_flops: analysis.flops,
            n_interface: partition.n_interface(),
            n_modes,
        }
    }
}
