//! How many modes a run is going to keep, as far as that is known before it.

use serde::Serialize;

use crate::error::{Error, Result};
use crate::factor::{Analysis, count_below_freeing};
use crate::job::{Boundary, ModeSelection};
use crate::memory_forecast::MODES_IN_A_BAND;
use crate::partition::Partition;
use crate::plan::{Modes, Plan};
use crate::rigid::{RigidBodyModes, with_passing};

/// Operations of a factorisation that nobody waits for: two seconds of the nominal machine.
const SMALL: f64 = 2e10;

/// When the modes of a band are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counting {
    /// Where it takes a moment.
    WhereQuick,
    /// Whatever it takes.
    Always,
}

/// How a number of modes is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Known {
    /// The job says it.
    Asked,
    /// A factorisation at the end of the band counts them.
    Counted,
    /// It is a guess.
    Assumed,
}

/// How many modes a run is going to keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ExpectedModes {
    /// The number.
    pub count: usize,
    /// How it is known.
    pub known: Known,
}

impl ExpectedModes {
    /// The modes that a plan keeps; those of a band are counted where `counting` allows it. `rigid` is all motions without energy.
    ///
    /// # Errors
    /// No memory for the factorisation.
    pub fn of(
        plan: &Plan,
        (partition, rigid): (&Partition, &RigidBodyModes),
        analysis: &Analysis,
        counting: Counting,
    ) -> Result<Self> {
        let up_to_hz = match (plan.modes(), plan.job().reduction.wanted()) {
            (Modes::NotAsked, _) => return Ok(Self { count: 0, known: Known::Asked }),
            (Modes::Computed, ModeSelection::Count { count }) => {
                return Ok(Self { count: count.min(most_modes(plan, partition)), known: Known::Asked });
            }
            (Modes::Computed, ModeSelection::UpTo { up_to_hz }) => up_to_hz,
        };
        let is_counted = counting == Counting::Always || analysis.flops <= SMALL;
        let counted = if is_counted { counted(plan, (partition, rigid), analysis, up_to_hz)? } else { None };
        Ok(match counted {
            Some(count) => Self { count, known: Known::Counted },
            None => Self { count: MODES_IN_A_BAND, known: Known::Assumed },
        })
    }
}

/// As many modes as a model has under the boundary of the job, at most.
fn most_modes(plan: &Plan, partition: &Partition) -> usize {
    match (plan.job().reduction.method.boundary(), partition.n_interface()) {
        (Boundary::FixedInterface, 1..) => partition.n_internal,
        _ => partition.n_dofs().saturating_sub(plan.facts().map_or(0, |facts| facts.n_rigid)),
    }
}

/// Elastic modes up to a frequency under the boundary of the job; none where the shift hits an eigenvalue.
fn counted(
    plan: &Plan,
    (partition, rigid): (&Partition, &RigidBodyModes),
    analysis: &Analysis,
    up_to_hz: f64,
) -> Result<Option<usize>> {
    let boundary = partition.boundary(plan.job().reduction.method.boundary());
    let n_rigid = plan.facts().map_or(0, |facts| facts.n_rigid);
    let sigma = partition.scaling.eigenvalue(up_to_hz);
    let is_modal = partition.n_interface() == 0 && n_rigid > 0;
    match count_below_freeing(analysis, partition.pencil(), sigma, partition.free_under(boundary)) {
        Err(Error::SturmPivot) => Ok(None),
        Err(error) => Err(error),
        Ok(count) if boundary == Boundary::FixedInterface && !is_modal => Ok(Some(count.clamped)),
        Ok(count) if boundary == Boundary::MixedInterface => {
            let rigid = with_passing(rigid.clone(), partition)?;
            let n_passing = rigid.under(boundary).map_or(0, RigidBodyModes::count);
            Ok(Some(count.free.saturating_sub(n_passing)))
        }
        Ok(count) => Ok(Some(count.free.saturating_sub(n_rigid))),
    }
}
