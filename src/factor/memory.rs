//! The memory a run will need, known before any number is computed.

use super::{Analysis, Storage};
use crate::error::{Error, Result};
use crate::job::{Certify, Job, ModeSelection, Precision};
use crate::modes::SLICED_FROM;
use crate::outcome::Resources;
use crate::partition::Partition;

/// Bytes of an entry of a sparse matrix: value and column.
const ENTRY: u64 = 12;
/// Bytes of a double.
const DOUBLE: u64 = 8;
/// Modes assumed for a band whose number of modes is not known yet.
const MODES_IN_A_BAND: u64 = 50;
/// Vectors beside the right-hand sides of a solve by a factor in single precision.
const REFINEMENT: u64 = 72;
/// Recovered rows of the basis as numbers, as bytes of their own and as bytes of the file.
const COPIES: u64 = 3;

/// What a run needs, in bytes.
#[derive(Clone, Copy, Debug)]
struct Forecast {
    factors: u64,
    matrices: u64,
    vectors: u64,
}

/// How the factor is to be kept so that a run fits into the memory allowed by the job, or else what the machine offers: as the
/// job says, or as its `auto` finds.
///
/// # Errors
/// [`Error::MemoryForecast`].
pub fn storage_within_memory(
    analysis: &Analysis,
    partition: &Partition,
    job: &Job,
    resources: Resources,
) -> Result<Storage> {
    let fits = |storage| refuse_beyond_memory(analysis, partition, job, resources, (storage, None)).map(|()| storage);
    match job.run.precision {
        Precision::Double => fits(Storage::Double),
        Precision::Mixed => fits(Storage::Single),
        Precision::Auto => fits(Storage::Double).or_else(|_| fits(Storage::Single)),
    }
}

/// Refuses a run whose forecast exceeds the memory allowed by the job, or else what the machine offers.
///
/// Counted are the matrices, the factors that are kept, what waits for its parent while one is made, the largest front, the
/// constraint modes, the basis of the eigensolver (three vectors for each mode and eight blocks of eight) and the rows that are recovered. The number
/// of modes is what a count in the band has found, once there is one.
///
/// # Errors
/// [`Error::MemoryForecast`].
pub fn refuse_beyond_memory(
    analysis: &Analysis,
    partition: &Partition,
    job: &Job,
    resources: Resources,
    (storage, n_modes): (Storage, Option<usize>),
) -> Result<()> {
    let allowed = job.run.memory_gib.map(|gib| (gib * f64::from(1 << 30)) as u64);
    let Some(available) = allowed.or(resources.memory_bytes) else {
        return Ok(());
    };
    let n_modes = match (n_modes, job.reduction.modes) {
        (Some(count), _) | (None, ModeSelection::Count { count }) => (count as u64).min(partition.n_dofs() as u64),
        (None, ModeSelection::UpTo { .. }) => MODES_IN_A_BAND,
    };
    let forecast = |storage| Forecast::of(analysis, partition, (job.run.certify, n_modes), storage);
    let Forecast { factors, matrices, vectors } = forecast(storage);
    if forecast(storage).total() <= available {
        return Ok(());
    }
    let in_single = Some(forecast(Storage::Single).total()).filter(|needed| *needed <= available);
    Err(Error::MemoryForecast { available, factors, matrices, vectors, in_single })
}

impl Forecast {
    fn of(analysis: &Analysis, partition: &Partition, (certify, n_modes): (Certify, u64), storage: Storage) -> Self {
        let n = partition.n_dofs() as u64;
        // The partitioned matrices, their internal blocks, and the triangle with wide indices that the analysis makes.
        let entries = (partition.stiffness.nnz() + partition.mass.nnz()) as u64;
        // A count keeps the pivots alone; a slice keeps the factor of its shift.
        let n_beside = match certify {
            // Those of K − σM and of the proof that it is definite.
            Certify::Full => 2,
            Certify::None | Certify::Count if n_modes >= SLICED_FROM as u64 => 1,
            Certify::None | Certify::Count => 0,
        };
        let (n_beside, refinement) = match storage {
            Storage::Double => (n_beside, 0),
            // All but the factor of K_II are in double precision; without an interface its modes come from one of those.
            Storage::Single => (n_beside + u64::from(partition.n_interface() == 0), REFINEMENT),
        };
        let beside = analysis.factor_bytes(Storage::Double).saturating_mul(n_beside);
        let factors = analysis.factor_bytes(storage).saturating_add(beside).saturating_add(analysis.stack_bytes());
        let vectors = 2 * partition.n_interface() as u64 + 5 * n_modes + 64 + refinement;
        let recovery = COPIES * partition.recovered.len() as u64 * (partition.n_interface() as u64 + n_modes);
        Self { factors, matrices: 3 * ENTRY * entries, vectors: DOUBLE * (n * vectors + recovery) }
    }

    fn total(self) -> u64 {
        self.matrices.saturating_add(self.factors).saturating_add(self.vectors)
    }
}
