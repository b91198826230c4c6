//! What the cost of a run depends on.

use super::work::Work;
use crate::factor::Analysis;
use crate::job::{Boundary, Certify, Job, ModeSelection, Precision};
use crate::partition::Partition;
use crate::plan::{Mass, Modes, Plan, Statics};

/// Bytes of a double.
const DOUBLE: f64 = 8.0;
/// Bytes of an entry of a sparse matrix.
const ENTRY: f64 = 12.0;
/// Right-hand sides that a solve and a product take at once.
const BLOCK: f64 = 8.0;

/// How often a solve reads both triangles of a factor in single precision until its answer is right, in bytes of one in double precision: four
/// sweeps of half of them.
const REFINED_SWEEPS: f64 = 2.0;

/// Shifts below the spectrum that a search tries without an interface to hold the component: near zero, where the motions of the body tell how
/// far the first elastic mode is, and by that.
const SHIFTS: f64 = 3.0;

/// How far modes are proved complete.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Proofs {
    /// Not at all.
    None,
    /// By a count.
    Count,
    /// By a count and intervals.
    Intervals,
}

/// What the cost of a run depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// n'.
    pub n_dofs: f64,
    /// n_B.
    pub n_interface: f64,
    /// Stored entries of K and M.
    pub entries: f64,
    /// Entries of L.
    pub factor_entries: f64,
    /// Operations of a factorisation.
    pub factor_flops: f64,
    /// Modes that are kept.
    pub n_modes: f64,
    /// Other columns of Ψ_D: inertia relief, residual vectors, modes of a file.
    pub n_answers: f64,
    /// Interfaces by name.
    pub n_interfaces: f64,
    /// Output dofs of the scene.
    pub n_outputs: f64,
    /// Bytes of the files of K and M.
    pub text_bytes: f64,
    /// The form of the constraint modes.
    pub statics: Statics,
    /// How much more of the factor each solve reads than both triangles once: steps of refinement where it is kept in single precision.
    pub sweeps: f64,
    /// Factorisations of K − σM in the search for modes. There are some where K is singular: nothing holds the component, and it has no
    /// interface.
    pub n_shifts: f64,
    /// Whether an eigensolver runs.
    pub modes: Modes,
    /// Whether the mass is reduced.
    pub mass: Mass,
    /// Whether modes are asked for up to a frequency, which are counted before they are looked for.
    pub is_band: bool,
    /// The boundary of the modes.
    pub boundary: Boundary,
    /// How modes are proved.
    pub proofs: Proofs,
}

impl Sizes {
    /// The sizes of a planned run with so many modes; `text_bytes` are those of its files.
    pub fn of(plan: &Plan, partition: &Partition, analysis: &Analysis, (n_modes, text_bytes): (usize, u64)) -> Self {
        let job = plan.job();
        // Without an interface the motions of a free body are coordinates by themselves.
        let n_relief = plan.facts().map_or(0, |facts| match partition.n_interface() {
            0 => facts.n_rigid,
            _ => plan.relief().motions(facts.n_rigid, facts.modes_in_file).len(),
        });
        let n_residual = partition.loads.n_residual_vectors();
        Self {
            n_answers: (n_relief + n_residual + partition.expansion.count()) as f64,
            text_bytes: text_bytes as f64,
            statics: plan.statics(),
            n_shifts: if plan.is_free_without_interface() { SHIFTS } else { 0.0 },
            modes: plan.modes(),
            mass: plan.mass(),
            ..Self::of_model(job, partition, analysis, n_modes)
        }
    }

    /// The sizes of a model with so many modes.
    pub fn of_model(job: &Job, partition: &Partition, analysis: &Analysis, n_modes: usize) -> Self {
        let mut names: Vec<&str> = partition.interface.iter().map(|node| node.name.as_str()).collect();
        names.dedup();
        Self {
            n_dofs: partition.n_dofs() as f64,
            n_interface: partition.n_interface() as f64,
            entries: (partition.stiffness.nnz() + partition.mass.nnz()) as f64,
            factor_entries: analysis.nnz_factor,
            factor_flops: analysis.flops,
            n_modes: n_modes as f64,
            n_answers: 0.0,
            n_interfaces: names.len() as f64,
            n_outputs: partition.outputs.len() as f64,
            text_bytes: 0.0,
            statics: Statics::Stored,
            sweeps: match job.run.precision {
                Precision::Mixed => REFINED_SWEEPS,
                Precision::Double | Precision::Auto => 1.0,
            },
            n_shifts: 0.0,
            modes: Modes::Computed,
            mass: Mass::Reduced,
            is_band: matches!(job.reduction.wanted(), ModeSelection::UpTo { .. }),
            boundary: job.reduction.method.boundary(),
            proofs: match job.certified() {
                Certify::None => Proofs::None,
                Certify::Count => Proofs::Count,
                Certify::Full => Proofs::Intervals,
            },
        }
    }

    /// r.
    pub fn n_reduced(&self) -> f64 {
        self.n_interface + self.n_modes + self.n_answers
    }

    /// A factorisation.
    pub(super) fn factor(&self) -> Work {
        Work { factor_flops: self.factor_flops, ..Work::default() }
    }

    /// A counting factorisation.
    pub(super) fn count(&self) -> Work {
        Work { count_flops: self.factor_flops, ..Work::default() }
    }

    /// Solves with so many right-hand sides, in blocks: L is read forward and backward for each.
    pub fn solves(&self, columns: f64) -> Work {
        let solve_bytes = 2.0 * DOUBLE * self.factor_entries * self.sweeps * (columns / BLOCK).ceil();
        // Rows of the block are packed, unpacked and handed on.
        let product_bytes = 6.0 * DOUBLE * self.n_dofs * columns;
        Work { solve_bytes, product_bytes, ..Work::default() }
    }

    /// Products of one of K and M, on average, with so many columns.
    pub fn products(&self, columns: f64) -> Work {
        let matrix = ENTRY * 0.5 * self.entries * (columns / BLOCK).ceil();
        Work { product_bytes: matrix + 2.0 * DOUBLE * self.n_dofs * columns, ..Work::default() }
    }

    /// XᵀY, or X C, of tall columns.
    pub fn dense(&self, a: f64, b: f64) -> Work {
        Work { dense_flops: 2.0 * self.n_dofs * a * b, ..Work::default() }
    }

    /// Passes over all entries of K and M.
    pub(super) fn passes(&self, times: f64) -> Work {
        Work { product_bytes: times * ENTRY * self.entries, ..Work::default() }
    }

    /// Columns of an eigensolution with so many modes: the iteration, with what it deflates. Solves of 32 searches for 5, 20 and 60 modes on
    /// six parts of 3,000 to 120,000 dofs: 41 to 93, 104 to 148 and 268 to 328.
    pub(super) fn iterated(modes: f64) -> f64 {
        const OF_A_MODE: f64 = 4.3;
        const BESIDE: f64 = 45.0;
        OF_A_MODE * modes + BESIDE
    }

    /// An eigensolution by solves with a factor that is there.
    pub(super) fn eigensolution(&self, modes: f64) -> Work {
        let columns = Self::iterated(modes);
        // Orthogonalisation in the mass against all columns before, twice.
        self.solves(columns) + self.products(2.0 * columns) + self.dense(columns, 2.0 * columns)
    }
}
