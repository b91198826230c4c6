//! The memory a run will need, known before any number is computed.

use super::Analysis;
use crate::error::{Error, Result};
use crate::job::{Certify, Job, ModeSelection};
use crate::modes::SLICED_FROM;
use crate::outcome::Resources;
use crate::partition::Partition;

/// Bytes of an entry of a sparse matrix: value and column.
const ENTRY: u64 = 12;
/// Bytes of a double.
const DOUBLE: u64 = 8;
/// Modes assumed for a band whose number of modes is not known yet.
const MODES_IN_A_BAND: u64 = 50;

/// Refuses a run whose forecast exceeds the memory allowed by the job, or else what the machine offers.
///
/// Counted are the matrices, the factors that are kept, what waits for its parent while one is made, the constraint modes and
/// the basis of the eigensolver: three vectors for each mode and eight blocks of eight. `n_modes` is what a count in the band has found,
/// once there is one.
///
/// # Errors
/// [`Error::MemoryForecast`].
pub fn refuse_beyond_memory(
    analysis: &Analysis,
    partition: &Partition,
    job: &Job,
    resources: Resources,
    n_modes: Option<usize>,
) -> Result<()> {
    let allowed = job.run.memory_gib.map(|gib| (gib * f64::from(1 << 30)) as u64);
    let Some(available) = allowed.or(resources.memory_bytes) else {
        return Ok(());
    };
    let n = partition.n_dofs() as u64;
    let n_modes = match (n_modes, job.reduction.modes) {
        (Some(count), _) | (None, ModeSelection::Count { count }) => (count as u64).min(n),
        (None, ModeSelection::UpTo { .. }) => MODES_IN_A_BAND,
    };
    // The partitioned matrices, their internal blocks, and the triangle with wide indices that the analysis makes.
    let entries = (partition.stiffness.nnz() + partition.mass.nnz()) as u64;
    let matrices = 3 * ENTRY * entries;
    // A count keeps the pivots alone; a slice keeps the factor of its shift.
    let n_factors = match job.run.certify {
        // Beside the factor of K_II, those of K − σM and of the proof that it is definite.
        Certify::Full => 3,
        Certify::None | Certify::Count if n_modes >= SLICED_FROM as u64 => 2,
        Certify::None | Certify::Count => 1,
    };
    let factors = analysis.factor_bytes().saturating_mul(n_factors).saturating_add(analysis.stack_bytes());
    let vectors = DOUBLE * n * (2 * partition.n_interface() as u64 + 5 * n_modes + 64);
    let needed = matrices.saturating_add(factors).saturating_add(vectors);
    if needed <= available {
        return Ok(());
    }
    Err(Error::MemoryForecast { available, factors, matrices, vectors })
}
