//! The memory a run will need, known before any number is computed.

use crate::cache::Cache;
use crate::error::{Error, Result};
use crate::factor::{Analysis, Storage};
use crate::job::{Boundary, Certify, Job, ModeSelection, Precision};
use crate::modes::{LARGEST_SEARCH, SLICED_FROM};
use crate::partition::Partition;
use crate::plan::{Plan, Statics};
use crate::sparse::ENTRY_BYTES;

/// Bytes of a double.
const DOUBLE: u64 = 8;
/// Modes assumed for a band whose number of modes is not known yet.
pub(crate) const MODES_IN_A_BAND: usize = 50;
/// Columns of the constraint modes that are there at once where they are not stored.
const PANEL: u64 = 64;
/// Vectors in addition to the right-hand sides of a solve by a factor in single precision.
const REFINEMENT: u64 = 72;
/// Blocks of all modes that basis, projection, verification and comparison hold together: 5.9 with 800 fixed-interface modes of a
/// slender solid of 30,000 dofs, 5.0 with Herting's.
const BLOCKS_OF_MODES: u64 = 6;
/// Bytes of an entry of a quantity: as it is read, in a row of the model and in one of the partition, with room to grow.
const QUANTITY_ENTRY_BYTES: u64 = 40;
/// Recovered rows of the basis as numbers, as bytes of their own and as bytes of the file.
const COPIES: u64 = 3;

/// Dofs up to which the boundaries of a scene are solved at the same time: one search then has too little work for several threads, and its
/// vectors take less than 100 MB.
pub(crate) const TOGETHER_UP_TO: usize = 50_000;
/// Blocks of all columns of the space in which the frequency response is found: the columns, what K and M make of them, a copy while columns
/// are added, and the panels of rows that the residuals are found from.
const BLOCKS_OF_RESPONSE: u64 = 5;
/// Square matrices with a row and a column for each column of that space: K, M and their spectral form; and while the next form is made the
/// shifted sum of K and M, its factor, the matrix that is decomposed, its scaled copy, and the vectors twice.
const SQUARES_OF_RESPONSE: u64 = 9;
/// Blocks of n_B columns that such a space takes on, where the interface has few dofs.
pub(crate) const RESPONSE_BLOCKS: f64 = 6.0;
/// Columns for each root of n_B that it takes on where there are some: unlike forces share their answers.
const COLUMNS_OF_A_ROOT: f64 = 46.0;
/// Blocks of n_B columns that it takes on where there are many. It depends on the band: measured are 560 and 677 columns of 150 and 162
/// dofs, 790 of 294, 1,540 of 306, 1,750 of 426, and 2,930 of 600.
const BLOCKS_OF_MANY: f64 = 4.2;
/// Blocks of constraint modes that basis, projection and verification hold together where they are stored: 4.2 to 4.3 with 180 to 600
/// interface dofs.
const BLOCKS_OF_STATICS: u64 = 5;
/// The program itself, its threads and what it holds of its files. It is nearly all that a run of a few hundred dofs takes.
const PROGRAM: u64 = 28 << 20;

/// Loads on the interface that a comparison solves at most.
const MAX_LOADS: usize = 48;
/// Columns that conjugate gradients hold for each load: answer, residual, direction and what a step makes of them.
const COLUMNS_OF_A_LOAD: u64 = 8;
/// Columns for each mode found again: two of the basis, its shape and a product of it.
const COLUMNS_OF_A_MODE: u64 = 4;
/// Columns of any search.
const COLUMNS_OF_A_SEARCH: u64 = 64;

/// What a run may use. It decides whether a run starts and how long it takes, and changes no result.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resources<'a> {
    /// Memory the run may use, in bytes; `None` sets no limit. `run.memory_gib` of the job takes precedence.
    pub memory_bytes: Option<u64>,
    /// Results of earlier runs, which change no result of this one.
    pub cache: Option<&'a Cache>,
}

impl Resources<'_> {
    /// Memory that a job may use, in bytes: as it says itself, or what there is.
    pub fn allowed(self, job: &Job) -> Option<u64> {
        job.run.memory_gib.map(bytes_of_gib).or(self.memory_bytes)
    }
}

/// Bytes of so many GiB.
pub(crate) fn bytes_of_gib(gib: f64) -> u64 {
    (gib * f64::from(1 << 30)) as u64
}

/// What a run needs, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Factors, and what waits for its parent while one is made.
    pub factors: u64,
    /// K, M and their copies.
    pub matrices: u64,
    /// Constraint modes, modes, the bases of the eigensolver, recovered rows.
    pub vectors: u64,
    /// The program itself, its threads and what it keeps of its files.
    pub program: u64,
}

/// What of the full model is compared with the reduced one, as far as it takes memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Compared {
    /// Supports under which frequencies are compared; none where they are not.
    pub n_supports: usize,
    /// The frequency response.
    pub response: Response,
}

/// Whether the frequency response is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Response {
    /// It is.
    Compared,
    /// It is not.
    #[default]
    LeftOut,
}

/// How the factor is to be kept so that a run fits into the memory allowed by the job, or else what the machine offers: as the
/// job says, or as its `auto` finds.
///
/// # Errors
/// [`Error::MemoryForecast`].
pub fn storage_within_memory(
    analysis: &Analysis,
    partition: &Partition,
    (plan, compared): (&Plan, Compared),
    resources: Resources,
) -> Result<Storage> {
    let planned = (plan, compared);
    let fits = |storage, n_modes| {
        slices_within_memory(analysis, partition, planned, resources, (storage, n_modes)).map(|_| storage)
    };
    // Nothing is refused for modes that are assumed; a count in the band, once there is one, is held against the memory again.
    let least = Some(n_looked_for(plan.job(), None).unwrap_or(0));
    match plan.job().run.precision {
        Precision::Double => fits(Storage::Double, least),
        Precision::Mixed => fits(Storage::Single, least),
        Precision::Auto => fits(Storage::Double, None).or_else(|_| fits(Storage::Single, least)),
    }
}

/// How many slices of a band can be searched at the same time: as many as there are threads, or as the memory allowed by the job,
/// or else what the machine offers, can hold.
///
/// Counted are the matrices, the factors that are kept, what waits for its parent while one is made, the largest front, the
/// constraint modes, the modes, the basis of the eigensolver (five vectors for each mode and eight blocks of eight) or what is
/// held after it, what the comparison with the full model holds, and the rows that are recovered. The number of modes is what a
/// count in the band has found, once there is one.
///
/// # Errors
/// [`Error::MemoryForecast`] where there is no room for a single search.
pub fn slices_within_memory(
    analysis: &Analysis,
    partition: &Partition,
    (plan, compared): (&Plan, Compared),
    resources: Resources,
    (storage, n_modes): (Storage, Option<usize>),
) -> Result<usize> {
    let job = plan.job();
    let n_threads = rayon::current_num_threads();
    let Some(available) = resources.allowed(job) else {
        return Ok(n_threads);
    };
    let n_modes = n_looked_for(job, n_modes).map_or(MODES_IN_A_BAND, |count| count.min(partition.n_dofs())) as u64;
    let forecast = |storage, at_once: usize| {
        let search = SearchSize::of((plan, compared), n_modes, at_once as u64);
        Memory::of(analysis, partition, search, storage)
    };
    if let Some(at_once) = (1..=n_threads).rev().find(|at_once| forecast(storage, *at_once).total() <= available) {
        return Ok(at_once);
    }
    let Memory { factors, matrices, vectors, program } = forecast(storage, 1);
    let in_single = Some(forecast(Storage::Single, 1).total()).filter(|needed| *needed <= available);
    Err(Error::MemoryForecast { available, factors, matrices, vectors, program, in_single })
}

/// How many modes a run looks for: what a count in the band has found, or what the job says; none where nobody knows.
pub(crate) fn n_looked_for(job: &Job, counted: Option<usize>) -> Option<usize> {
    counted.or(match job.reduction.wanted() {
        ModeSelection::Count { count } => Some(count),
        ModeSelection::UpTo { .. } => None,
    })
}

/// What a planned run with so many modes will hold at once, with its factor in double precision unless the job says otherwise.
pub fn expected(
    analysis: &Analysis,
    partition: &Partition,
    (plan, compared): (&Plan, Compared),
    n_modes: usize,
) -> Memory {
    let storage = match plan.job().run.precision {
        Precision::Mixed => Storage::Single,
        Precision::Double | Precision::Auto => Storage::Double,
    };
    let at_once = rayon::current_num_threads() as u64;
    Memory::of(analysis, partition, SearchSize::of((plan, compared), n_modes as u64, at_once), storage)
}

/// Makes sure that a superelement with this many modes can be compared with its full model in the memory allowed by the job, or else
/// what the machine offers.
///
/// Counted are the matrices, the factor of K − σM on all dofs and of another one for modes with the interface held, what waits for its
/// parent while one is made, the basis of the eigensolver with its modes, and the columns of the static loads.
///
/// # Errors
/// [`Error::MemoryComparison`].
pub fn comparison_within_memory(partition: &Partition, job: &Job, resources: Resources, n_modes: usize) -> Result<()> {
    let Some(available) = resources.allowed(job) else { return Ok(()) };
    let analysis = Analysis::new(partition.pencil())?;
    let n = partition.n_dofs() as u64;
    let further: usize = partition.matrices.iter().map(|carried| carried.matrix.nnz()).sum();
    let entries = (partition.stiffness.nnz() + partition.mass.nnz() + further) as u64;
    let factors = analysis.factor_bytes(Storage::Double).saturating_mul(2).saturating_add(analysis.stack_bytes());
    let loads = partition.n_interface().min(MAX_LOADS) as u64;
    let vectors = COLUMNS_OF_A_LOAD * loads + COLUMNS_OF_A_MODE * n_modes as u64 + COLUMNS_OF_A_SEARCH;
    let needed = factors.saturating_add(2 * ENTRY_BYTES * entries).saturating_add(DOUBLE * n * vectors);
    if needed > available {
        return Err(Error::MemoryComparison { needed, available });
    }
    Ok(())
}

/// What is looked for, and how much of it at the same time.
#[derive(Clone, Copy)]
struct SearchSize {
    certify: Certify,
    statics: Statics,
    n_modes: u64,
    at_once: u64,
    /// Further factors, of K − σM, that the search for modes holds. It needs one where nothing holds a component without an interface.
    n_shifted: u64,
    compared: Compared,
}

impl SearchSize {
    fn of((plan, compared): (&Plan, Compared), n_modes: u64, at_once: u64) -> Self {
        let n_shifted = u64::from(plan.is_free_without_interface());
        Self { certify: plan.job().run.certify, statics: plan.statics(), n_modes, at_once, n_shifted, compared }
    }

    /// Bytes that the comparison with the full model holds of a model with so many entries in K and M: the searches under other boundaries,
    /// with their own matrices, or the space of the response after them.
    fn of_comparison(&self, partition: &Partition, entries: u64) -> u64 {
        let (n, n_b) = (partition.n_dofs() as u64, partition.n_interface() as u64);
        let together = if n as usize <= TOGETHER_UP_TO { rayon::current_num_threads() } else { 1 };
        let at_once = self.compared.n_supports.min(together) as u64;
        let of_supports = at_once * (ENTRY_BYTES * entries + DOUBLE * n * (5 * self.n_modes + 64));
        let columns = match self.compared.response {
            Response::Compared => {
                let many = BLOCKS_OF_MANY * n_b as f64;
                let taken_on = (RESPONSE_BLOCKS * n_b as f64).min(many.max(COLUMNS_OF_A_ROOT * (n_b as f64).sqrt()));
                n_b + self.n_modes + n_answers(partition) + taken_on as u64
            }
            Response::LeftOut => 0,
        };
        of_supports.max(DOUBLE * columns * (BLOCKS_OF_RESPONSE * n + SQUARES_OF_RESPONSE * columns))
    }
}

/// Loads, and modes of a file: each has a static answer.
fn n_answers(partition: &Partition) -> u64 {
    (partition.loads.count() + partition.expansion.count()) as u64
}

impl Memory {
    fn of(analysis: &Analysis, partition: &Partition, search: SearchSize, storage: Storage) -> Self {
        let SearchSize { certify, statics, n_modes, at_once, .. } = search;
        let n = partition.n_dofs() as u64;
        // The partitioned matrices and the triangle with wide indices that the analysis makes; a proof lowers K in a copy.
        let entries = (partition.stiffness.nnz() + partition.mass.nnz()) as u64;
        // A slice keeps the factor of its shift and a basis of its own, in addition to all modes and the copy that puts them in order.
        let (in_slices, of_solver) = match n_modes > SLICED_FROM as u64 {
            true => (at_once, 2 * n_modes + at_once * (5 * LARGEST_SEARCH as u64 + 64)),
            false => (0, 5 * n_modes + 64),
        };
        // A count keeps the pivots alone.
        let (n_other, n_copies) = match certify {
            // Those of K − σM and of the proof that it is definite.
            Certify::Full => (in_slices.max(2), 3),
            Certify::None | Certify::Count => (in_slices.max(search.n_shifted), 2),
        };
        let (n_other, refinement) = match storage {
            Storage::Double => (n_other, 0),
            // All but the factor of K_II are in double precision; without an interface its modes come from one of those.
            Storage::Single => (n_other + u64::from(partition.n_interface() == 0), REFINEMENT),
        };
        let others = analysis.factor_bytes(Storage::Double).saturating_mul(n_other);
        let stacks = analysis.stack_bytes().saturating_mul(in_slices.max(1));
        let factors = analysis.factor_bytes(storage).saturating_add(others).saturating_add(stacks);
        // Mixed boundaries have matrices of their own, and answers to the interface dofs that are free.
        let free = partition.free_under(Boundary::MixedInterface);
        let (n_copies, n_free) = free.map_or((n_copies, 0), |free| (n_copies + 1, free.len() as u64));
        // The loads and the inertia forces of the modes of a file, their static answers and their columns of the basis.
        let of_loads = 3 * n_answers(partition);
        let n_b = partition.n_interface() as u64;
        let (of_statics, of_their_blocks) = match statics {
            Statics::Stored => (2 * n_b, (BLOCKS_OF_STATICS - 2) * n_b),
            Statics::ByFactor | Statics::Condensed | Statics::Carried => (n_b.min(PANEL), 0),
        };
        // What a search holds is gone before the reduced model is compared.
        let of_blocks = BLOCKS_OF_MODES * (n_modes + n_answers(partition)) + of_their_blocks;
        let after = DOUBLE * n * of_blocks + search.of_comparison(partition, entries);
        let vectors = of_loads + n_free + of_statics + refinement;
        let recovery = COPIES
            * (partition.recovered.rows.len() + partition.quantities.rows.len()) as u64
            * (partition.n_interface() as u64 + n_modes);
        let further: u64 = partition.matrices.iter().map(|carried| carried.matrix.nnz() as u64).sum();
        let of_quantities: u64 = partition.quantities.rows.iter().map(|row| row.len() as u64).sum();
        Self {
            factors,
            matrices: ENTRY_BYTES * (n_copies * entries + further) + QUANTITY_ENTRY_BYTES * of_quantities,
            vectors: DOUBLE * (n * vectors + recovery) + after.max(DOUBLE * n * of_solver),
            program: PROGRAM,
        }
    }

    /// All of it.
    pub fn total(self) -> u64 {
        [self.factors, self.matrices, self.vectors, self.program].into_iter().fold(0, u64::saturating_add)
    }
}
