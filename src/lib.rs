//! supel turns finite element models into superelements that multibody simulations can trust.
//!
//! It reads the sparse stiffness and mass matrices of a component, reduces them by the mode-acceleration method of
//! Sonneville, Brüls and Bauchau, *Modal Reduction Procedures for Flexible Multibody Dynamics* (equation numbers are
//! theirs), proves what the reduction preserves, and writes a compact superelement file.
//!
//! # The straight line
//!
//! ```text
//! input → model → coordinates → partition → rigid → factor → constraint → modes → basis → reduction → verification → output
//! ```
//!
//! One file or folder for each word, one type handed from each to the next. [`reduce`] is this line, which stands in `line.rs`;
//! [`verify`], [`forecast`], [`certify`] and [`examine`] begin with it. Nothing else composes stages. What a run leaves out of it, because
//! the scene of the job never asks for it, is decided in [`plan`], and there alone.
//!
//! | stage | takes | gives |
//! |---|---|---|
//! | [`input`] | files | K, M, dof map, nodes as they were read |
//! | [`model`] | those | symmetric, scaled, checked matrices |
//! | [`coordinates`] | the model | the model, its coordinates and dof map compared with K |
//! | [`partition`] | the interfaces | K, M on internal and interface dofs, held dofs out, rigid patches applied, in order of elimination |
//! | [`rigid`] | the partition | U, verified against K; the rank of U_B |
//! | [`factor`] | K, the interface last | L Lᵀ of K_II, solves, counts of eigenvalues |
//! | [`constraint`] | the factor | constraint modes, mechanisms; K̂_BB |
//! | [`modes`] | the factor and those | elastic modes with error bars, certified complete |
//! | [`basis`] | the modes | Ψ = \[I 0; Ψ_S Ψ_D\] |
//! | [`reduction`] | Ψ | K̂, M̂, Û, M_F |
//! | [`verification`] | all of it | checks: value, limit, verdict |
//! | [`output`] | all of it | the superelement and the report |
//!
//! # Example
//!
//! Read a job, reduce, look at the checks, write the superelement and read it back as a simulation does:
//!
//! ```
//! use supel::job::Job;
//! use supel::memory_forecast::Resources;
//! use supel::verification::check::Verdict;
//! use supel_runtime::Superelement;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let (job_path, output) = (folder.path().join("job.toml"), folder.path().join("chain.supel"));
//! # let banner = "%%MatrixMarket matrix coordinate real symmetric\n";
//! # let springs: String = (1..5).map(|i| format!("{i} {i} {}\n{} {i} -1\n", if i == 1 { 1 } else { 2 }, i + 1)).collect();
//! # let masses: String = (1..=5).map(|i| format!("{i} {i} 1\n")).collect();
//! # std::fs::write(folder.path().join("K.mtx"), format!("{banner}5 5 9\n{springs}5 5 1\n"))?;
//! # std::fs::write(folder.path().join("M.mtx"), format!("{banner}5 5 5\n{masses}"))?;
//! # std::fs::write(&job_path, r#"
//! #     model = { stiffness = "K.mtx", mass = "M.mtx" }
//! #     interface = [{ name = "ends", nodes = { rows = [0, 4] } }]
//! #     reduction = { method = "craig-bampton", modes = { count = 2 } }
//! #     write = { superelement = "chain.supel" }
//! # "#)?;
//! let job = Job::read(&job_path)?;
//! let outcome = supel::reduce(&job, Resources::default(), &mut ())?;
//! for check in &outcome.report.body.checks {
//!     println!("{} {}: {:.1e}, limit {:.1e}", check.id, check.name, check.value, check.limits.value());
//!     assert_ne!(check.verdict(), Verdict::Fail);
//! }
//! outcome.superelement.write(&output)?;
//! let chain = Superelement::open(&output)?;
//! assert_eq!(chain.n_coordinates(), 2 + 2);
//! // Three equal masses between the held ends, on unit springs: the lowest λ is 2 − √2.
//! let lambda = chain.tensors().frequencies[0].powi(2);
//! assert!((lambda - (2.0 - 2f64.sqrt())).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```
//!
//! # Layers
//!
//! Each word is a folder or a file of `src`; none imports one that comes later, and no two files import each other. `tests/architecture`
//! reads this list and the imports. The line above is the order in which the stages run; [`coordinates`] runs early and stands late
//! here, because it looks at the raw matrices with the tools of the stages after it.
//!
//! ```text
//! number · dofs · error · unfinished · heap · tally · foreign_exit · regular_file · linked · random · twofold · dense · sparse
//! cache · factor · eigen
//! job · plan · input · model · partition · rigid · coordinates · constraint · modes · basis · modal_mass · reduction · rubin · damping · unseen
//! memory_forecast · size_forecast · cost_forecast · verification · audit · certification · assembly
//! report · output · outcome · examination · line · looks · conversion · export · recovery · cli
//! ```
//!
//! # Invariants
//!
//! 1. Of the stages only [`input`] and [`output`] touch files. Around them [`job`] reads its document, [`cache`] keeps results for
//!    later runs and changes none, [`report`] reads the clock, [`cli`] and the program have the terminal, and [`heap`] writes the
//!    last line of a run that finds no memory.
//! 2. [`job::Method`] alone decides what a reduction method means: the boundary under which its modes are sought or the file that
//!    has them, whether it has inertia relief, what its mass sees, and what is proved of it. No later stage asks which method it is:
//!    modes, basis and verification know the boundary, basis and audit whether there is inertia relief, reduction and audit what its
//!    mass sees, output and report the name.
//! 3. A matrix is factored once per shift and solved many times; no inverse is ever formed.
//! 4. The superelement format has one owner, the crate `supel-runtime`, used by the writer and by every reader.
//! 5. `supel-runtime` depends on nothing of this crate.
//! 6. Verification never changes a result. It measures, names the equation and compares with a limit.
//! 7. The same input gives the same bytes, whatever the number of threads (held by `tests/end_to_end/same_bytes.rs`).

pub mod assembly;
pub mod audit;
pub mod basis;
pub mod cache;
pub mod certification;
pub mod cli;
pub mod constraint;
pub mod conversion;
pub mod coordinates;
pub mod cost_forecast;
pub mod damping;
pub mod dense;
pub mod dofs;
pub mod eigen;
pub mod error;
pub mod examination;
pub mod export;
pub mod factor;
pub mod foreign_exit;
pub mod heap;
pub mod input;
pub mod job;
mod line;
mod linked;
mod looks;
pub mod memory_forecast;
pub mod modal_mass;
pub mod model;
pub mod modes;
mod number;
pub mod outcome;
pub mod output;
pub mod partition;
pub mod plan;
pub mod random;
pub mod recovery;
pub mod reduction;
mod regular_file;
pub mod report;
pub mod rigid;
pub mod rubin;
pub mod size_forecast;
pub mod sparse;
pub mod tally;
mod twofold;
mod unfinished;
pub mod unseen;
pub mod verification;

use audit::{Audit, Reference};
use cost_forecast::{Counting, ExpectedModes, Forecast};
use error::{Error, Result};
use job::{AcceptJob, Job};
use line::{Stages, foreknown, prepared, reduced, with_component, with_stages};
use memory_forecast::Resources;
use outcome::Outcome;
use partition::Partition;
use plan::Plan;
use report::Observer;
use supel_runtime::Superelement;
use verification::Evidence;

pub use looks::{certify, examine};

/// What the command line runs.
pub const PIPELINE: cli::Pipeline = cli::Pipeline { reduce, verify, certify, examine, forecast, rates: cli::rates };

/// Reduces a component: the whole method, step by step.
///
/// What `resources` cannot hold is refused before the first factorisation; nothing of it reaches the outcome.
///
/// # Errors
/// The errors of the stages; each says what is wrong, where, what was found, what was expected and what to do.
pub fn reduce(job: &Job, resources: Resources, observer: &mut dyn Observer) -> Result<Outcome> {
    let plan = Plan::of(job);
    // read → check → coordinates → partition
    let (facts, partition) = prepared(&plan, resources, observer)?;
    input::refuse_unsaid(&job.model)?;
    // rigid-body modes → factor → constraint modes
    with_component(&plan, &partition, (resources, observer), |conditioned, observer| {
        // modes → certificate → basis → projection → enclosures → verification → preservation → output
        reduced(conditioned, &facts, (resources, observer))
    })
}

/// Says what [`reduce`] is going to do and what it will cost, before its first factorisation.
///
/// # Errors
/// The errors of [`reduce`] up to its first factorisation; [`Error::NothingLeft`]; no memory for a count of modes.
pub fn forecast(job: &Job, resources: Resources, counting: Counting, observer: &mut dyn Observer) -> Result<Forecast> {
    let plan = Plan::of(job);
    let (_, partition) = prepared(&plan, resources, observer)?;
    observer.stage("rigid-body modes");
    let (rigid, analysis) = rayon::join(|| rigid::rigid_body_modes(&partition), || partition.analysis());
    let ((rigid, _), analysis) = (rigid?, analysis?);
    let (plan, rigid) = foreknown(&plan, &partition, rigid)?;
    observer.stage("count of modes");
    let modes = ExpectedModes::of(&plan, (&partition, &rigid), &analysis, counting)?;
    let text_bytes = input::bytes_of_matrices(plan.job());
    let forecast = Forecast::new(plan, (&partition, &analysis), modes, resources, text_bytes);
    if forecast.n_coordinates == 0 { Err(Error::NothingLeft) } else { Ok(forecast) }
}

/// Checks a superelement that was made earlier: by its own content, and with a job against the full matrices.
///
/// # Errors
/// The errors of reading the model of the job; a dense eigenproblem or an iteration that does not converge.
pub fn verify(
    superelement: &Superelement,
    job: Option<&Job>,
    resources: Resources,
    observer: &mut dyn Observer,
) -> Result<Audit> {
    faer::set_global_parallelism(faer::Par::Seq);
    let Some(job) = job else {
        observer.stage("verification");
        return audit::of_file(superelement);
    };
    let n_modes = superelement.tensors().frequencies.len();
    let plan = Plan::of(job).with_modes_of_file(n_modes);
    let (facts, partition) = prepared(&plan, resources, observer)?;

    observer.stage("reference");
    memory_forecast::comparison_within_memory(&partition, plan.job(), resources, n_modes)?;
    let reference = Reference::new(&plan, &facts, &partition)?;

    observer.stage("comparison");
    let mut audit = audit::against(superelement, &reference)?;
    drop(reference);
    if job.accepted() != AcceptJob::default() {
        audit = audit.joined(accepted(superelement, &plan, &partition, (resources, observer))?);
    }
    Ok(audit)
}

/// What the scene accepts, measured on the matrices of a file by the stages of a reduction of the same job.
fn accepted(
    superelement: &Superelement,
    plan: &Plan,
    partition: &Partition,
    (resources, observer): (Resources, &mut dyn Observer),
) -> Result<Audit> {
    with_stages(plan, partition, (resources, observer), |Stages { evidence: own, analysis, .. }, observer| {
        observer.stage("preservation");
        let Some(reduction) = audit::reduction_of(superelement, &own) else {
            let why = "what the scene accepts was not measured: its coordinates are not those of the job";
            return Ok(Audit::unlike(why));
        };
        let evidence = Evidence { reduction: &reduction, ..own };
        let compared = verification::preservation_of_file((&evidence, &own), analysis, plan.job())?;
        Ok(Audit::of_accuracy(&compared))
    })
}
