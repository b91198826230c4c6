//! supel turns finite element models into superelements that multibody simulations can trust.
//!
//! It reads the sparse stiffness and mass matrices of a component, reduces them by the mode-acceleration method of
//! Sonneville, Brüls and Bauchau, *Modal Reduction Procedures for Flexible Multibody Dynamics* (equation numbers are
//! theirs), proves what the reduction preserves, and writes a compact superelement file.
//!
//! # The straight line
//!
//! ```text
//! input → model → coordinates → partition → rigid → factor → modes → basis → reduction → verification → output
//! ```
//!
//! One file or folder for each word, one type handed from each to the next. [`reduce`] is this line; nothing else
//! composes stages.
//!
//! | stage | takes | gives |
//! |---|---|---|
//! | [`input`] | files | K, M, dof map, nodes as they were read |
//! | [`model`] | those | symmetric, scaled, checked matrices |
//! | [`coordinates`] | the model | the model, its coordinates and dof map compared with K |
//! | [`partition`] | the interfaces | K, M on internal and interface dofs, rigid patches applied, in order of elimination |
//! | [`rigid`] | the partition | U, verified against K; the rank of U_B |
//! | [`factor`] | K, the interface last | L Lᵀ of K_II, solves, counts of eigenvalues |
//! | [`modes`] | the factor | elastic modes with error bars, certified complete |
//! | [`basis`] | the modes | Ψ = \[I 0; Ψ_S Ψ_D\] |
//! | [`reduction`] | Ψ | K̂, M̂, Û, M_F |
//! | [`verification`] | all of it | checks: value, limit, verdict |
//! | [`output`] | all of it | the superelement and the report |
//!
//! # Invariants
//!
//! 1. Only `input`, `output`, `report`, `job`, `cli` and `main` touch files, the clock or the terminal.
//! 2. The reduction method is matched once, where the modes are chosen. After the basis is built no stage knows it.
//! 3. A matrix is factored once per shift and solved many times; no inverse is ever formed.
//! 4. The superelement format has one owner, the crate `supel-runtime`, used by the writer and by every reader.
//! 5. `supel-runtime` depends on nothing of this crate.
//! 6. Verification never changes a result. It measures, names the equation and compares with a limit.
//! 7. The same input gives the same bytes, whatever the number of threads.

pub mod audit;
pub mod basis;
pub mod cli;
pub mod coordinates;
pub mod dense;
pub mod error;
pub mod factor;
pub mod heap;
pub mod input;
pub mod job;
pub mod model;
pub mod modes;
pub mod outcome;
pub mod output;
pub mod partition;
pub mod reduction;
pub mod report;
pub mod rigid;
pub mod sparse;
pub mod verification;

use audit::{Audit, Reference};
use basis::Basis;
use coordinates::Levers;
use error::{Error, Result};
use factor::{Analysis, Cholesky};
use input::{Allowance, Cells, PatchFaces, Patches};
use job::{Coupling, Job};
use model::Model;
use modes::{Component, ModeSource, Retained};
use outcome::{Outcome, Resources};
use output::{InputFacts, Results};
use partition::Partition;
use reduction::Reduction;
use report::Observer;
use rigid::RigidBodyModes;
use supel_runtime::Superelement;
use verification::Evidence;

/// Reduces a component: the whole method, step by step.
///
/// What `resources` cannot hold is refused before the first factorisation; nothing of it reaches the outcome.
///
/// # Errors
/// Those of the stages; each says what, where, what was found, what was expected and what to do.
pub fn reduce(job: &Job, resources: Resources, observer: &mut dyn Observer) -> Result<Outcome> {
    let (facts, partition, faces) = prepared(job, (resources, Faces::Wanted), observer)?;

    observer.stage("rigid-body modes");
    // The analysis asks for the pattern of the matrices alone: it is made beside, and is the first of what a factor needs.
    let (rigid, analysis) = rayon::join(|| rigid::rigid_body_modes(&partition), || Analysis::of(&partition));
    let ((rigid, n_extra), analysis) = (rigid?, analysis?);
    let rank = rigid::interface_rank(&partition, &rigid)?;

    observer.stage("factor");
    let storage = factor::storage_within_memory(&analysis, &partition, job, resources)?;
    let sigma = modes::shift_of_factor(&partition, &rigid);
    let factor = Cholesky::kept(&analysis, (partition.pencil(), sigma), storage, &|dof| partition.name_of(dof));
    let factor = factor.map_err(|error| refused(error, &analysis, &partition, &rigid))?;
    let rank = rigid::confirmed_rank(&partition, &rigid, rank, &factor)?;

    observer.stage("constraint modes");
    let constraint = basis::constraint_modes(&partition, &factor, &rigid);
    factor.refinement()?;
    let (rigid, loose) = rigid::with_mechanisms(&partition, &constraint, rigid)?;

    observer.stage("modes");
    let component = Component::new(&partition, &analysis, &factor, &rigid, &constraint);
    let search = modes::Search::new(component, &job.reduction)?;
    let size = (storage, search.n_expected());
    let at_once = factor::slices_within_memory(&analysis, &partition, job, resources, size)?;
    let found = factor.vouched(search.with_slices_at_once(at_once).lowest(modes::SEED))?;

    observer.stage("certificate");
    let (found, certificate) = modes::certified(&search, &search.problem, found, search.edge(), job.run.certify)?;
    let retained = Retained { modes: found, boundary: search.problem.boundary };

    observer.stage("enclosures");
    let enclosures = verification::enclosures_where_asked(component, &retained, job.run.certify)?;

    observer.stage("basis");
    let basis = Basis::new(&constraint, retained.columns(component), partition.internal().mass);

    observer.stage("projection");
    let reduction = Reduction::new(&partition, &basis, &rigid);

    observer.stage("verification");
    let evidence = Evidence {
        partition: &partition,
        factor: &factor,
        rigid: &rigid,
        rank,
        constraint: &constraint,
        retained: &retained,
        basis: &basis,
        reduction: &reduction,
        certificate: certificate.as_ref(),
        enclosures: enclosures.as_ref(),
        expect: job.model.expect.as_ref(),
    };
    let findings = verification::verify(&evidence)?;

    observer.stage("preservation");
    let preserved = verification::preservation(&evidence, &analysis, job)?;

    let n_beside = n_extra + usize::from(search.edge().is_some());
    let (superelement, report) = output::output(&Results {
        job,
        input: &facts,
        faces: &faces,
        loose: &loose,
        evidence,
        findings: &findings,
        preserved: &preserved,
        analysis: &analysis,
        n_beside,
    })?;
    Ok(Outcome { superelement, report })
}

/// Why K_II could not be factored, the true reason first.
fn refused(error: Error, analysis: &Analysis, partition: &Partition, rigid: &RigidBodyModes) -> Error {
    let error = factor::few_digits(error, analysis, (&partition.stiffness).into(), partition.precision.stiffness);
    rigid::or_lack_of_rank(error, partition, rigid)
}

/// Whether the faces of patches are looked for.
enum Faces {
    Wanted,
    Unwanted,
}

/// The first four stages, which every look at the full model begins with, and the faces of patches.
fn prepared(
    job: &Job,
    (resources, wanted): (Resources, Faces),
    observer: &mut dyn Observer,
) -> Result<(InputFacts, Partition, Vec<PatchFaces>)> {
    // Small dense decompositions use faer's global setting; sequential ones give the same bits on every machine.
    faer::set_global_parallelism(faer::Par::Seq);

    observer.stage("read");
    let allowance = Allowance::of(resources.allowed(job));
    let read = input::read_within(&job.model, &allowance)?;
    let facts = InputFacts::of(&read);

    observer.stage("check");
    let model = Model::new(read)?;

    observer.stage("coordinates");
    let is_tied = job.interfaces.iter().any(|interface| interface.coupling == Coupling::Rigid);
    let levers = if is_tied { Levers::Used } else { Levers::Unused };
    let model = coordinates::compared(model, &job.model.held_rotations, levers)?;

    observer.stage("partition");
    let recovered = partition::recovered_rows(&model, job.write.recovery.as_ref())?;
    let patches = match (wanted, Cells::of(job)) {
        (Faces::Wanted, Cells::Wanted) => partition::patches(&model, &job.interfaces),
        _ => Patches::default(),
    };
    let weight = job.model.expect.as_ref().and_then(|_| model.weight());
    let mut partition = Partition::new(model, &job.interfaces)?;
    partition.recovered = recovered;
    partition.model.weight = weight;
    let faces = input::patch_faces(&job.model, &patches, &allowance)?;
    Ok((facts, partition, faces))
}

/// Checks a superelement that was made earlier: by its own content, and with a job against the full matrices.
///
/// # Errors
/// Those of reading the model of the job; a dense eigenproblem or an iteration that does not converge.
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
    let (facts, partition, _) = prepared(job, (resources, Faces::Unwanted), observer)?;

    observer.stage("reference");
    factor::comparison_within_memory(&partition, job, resources, superelement.tensors().frequencies.len())?;
    let reference = Reference::new(job, &facts, &partition)?;

    observer.stage("comparison");
    audit::against(superelement, &reference)
}
