//! All that is known of a run before its first factorisation.

use super::comparison::{Band, Comparisons};
use super::expected::{ExpectedModes, Known};
use super::sizes::Sizes;
use super::stage::{MODES, Stage, choice_of_modes, stages};
use crate::error::Warning;
use crate::factor::Analysis;
use crate::job::Boundary;
use crate::memory_forecast::{self, Memory, Resources};
use crate::partition::Partition;
use crate::plan::{Mass, Plan};
use crate::size_forecast;

/// Bytes of a double.
const DOUBLE: u64 = 8;
/// What a file has beside its matrices: names, the job and the checks, and what each coordinate has of them.
const DOCUMENT: u64 = 4_000;
/// Bytes of a coordinate in the document.
const OF_A_COORDINATE: u64 = 110;

/// All that is known of a run before its first factorisation.
#[derive(Clone, Debug)]
pub struct Forecast {
    /// What every rule decides.
    pub plan: Plan,
    /// What the cost depends on.
    pub sizes: Sizes,
    /// How many modes will be kept.
    pub modes: ExpectedModes,
    /// The stages with what each costs, the comparisons at their end.
    pub stages: Vec<Stage>,
    /// What the run will hold at once.
    pub memory: Memory,
    /// Memory that the run may use, in bytes, where there is a limit.
    pub allowed_bytes: Option<u64>,
    /// r.
    pub n_coordinates: usize,
    /// Bytes of the superelement file.
    pub file_bytes: u64,
    /// What is large for what was asked.
    pub warnings: Vec<Warning>,
}

impl Forecast {
    /// What is known of a planned run on a partitioned model, whose files have so many bytes.
    pub fn new(
        plan: Plan,
        (partition, analysis): (&Partition, &Analysis),
        modes: ExpectedModes,
        resources: Resources,
        text_bytes: u64,
    ) -> Self {
        let sizes = Sizes::of(&plan, partition, analysis, (modes.count, text_bytes));
        let comparisons = Comparisons::of(plan.job(), &sizes, Band::of(&plan, Some(modes.count)));
        let mut stages = stages(&sizes);
        if plan.searched_hz().is_some() {
            let accept = plan.job().accepted();
            let compared = [
                (accept.frequency.is_some(), &comparisons.frequencies),
                (accept.accepts_response(), &comparisons.response),
            ];
            let compared = compared.into_iter().filter(|(is_asked, _)| *is_asked).map(|(_, stage)| stage.work).sum();
            let modes = stages.iter().position(|stage| stage.name == MODES);
            stages.insert(modes.map_or(0, |at| at + 1), choice_of_modes(&sizes, compared));
        }
        stages.extend([comparisons.frequencies, comparisons.response]);
        let compared = Comparisons::in_memory(&plan, (partition, analysis), Some(modes.count));
        let memory = memory_forecast::expected(analysis, partition, (&plan, compared), modes.count);
        let mut warnings = size_forecast::of_interfaces(partition);
        if modes.known != Known::Assumed {
            warnings.extend(size_forecast::of_modes(modes.count, plan.job()));
        }
        // Columns beyond that depend on others.
        let n_coordinates = (sizes.n_reduced() as usize).min(partition.n_dofs());
        Self {
            allowed_bytes: resources.allowed(plan.job()),
            file_bytes: file_bytes(&plan, partition, &sizes),
            n_coordinates,
            memory,
            stages,
            warnings,
            modes,
            sizes,
            plan,
        }
    }

    /// Whether the memory that the run may use can hold it.
    pub fn fits(&self) -> bool {
        self.allowed_bytes.is_none_or(|allowed| self.memory.total() <= allowed)
    }
}

/// Bytes of the superelement file: full matrices, rows of recovery, and a document.
fn file_bytes(plan: &Plan, partition: &Partition, sizes: &Sizes) -> u64 {
    let (r, job) = (sizes.n_reduced() as u64, plan.job());
    let n_matrices = match plan.mass() {
        Mass::Reduced => 2,
        Mass::NotAsked => 1,
    } + u64::from(job.has_damping())
        + partition.matrices.len() as u64;
    let of_a_row = match job.write.recovery.as_ref().map(|recovery| recovery.precision) {
        Some(supel_runtime::Precision::Single) => DOUBLE / 2,
        Some(supel_runtime::Precision::Double) | None => DOUBLE,
    };
    let n_rigid = plan.facts().map_or(0, |facts| facts.n_rigid) as u64;
    // Û, its mass, gravity, and the loads have a row for each coordinate.
    let narrow = 2 * n_rigid + 3 + partition.loads.count() as u64;
    // A row, its node and direction, and the position of its node.
    let rows = partition.recovered.rows.len() as u64;
    // What stored modes are of the named ones, unless all are those of the held interface or of a held component without one.
    let are_others = sizes.n_answers > 0.0 || sizes.boundary != Boundary::FixedInterface;
    let is_mixed = are_others && (partition.n_interface() > 0 || n_rigid > 0);
    let n_named = if is_mixed { (sizes.n_modes + sizes.n_answers) as u64 } else { 0 };
    DOUBLE * (n_matrices * r * r + n_named * n_named + narrow * r + partition.quantities.rows.len() as u64 * r)
        + rows * (of_a_row * r + 3 * DOUBLE)
        + DOCUMENT
        + OF_A_COORDINATE * r
}
