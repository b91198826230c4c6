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
//! One file or folder for each word, one type handed from each to the next. [`reduce`] is this line; nothing else
//! composes stages.
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
//! number · dofs · error · heap · foreign_exit · regular_file · linked · random · dense · sparse
//! factor · eigen
//! job · input · model · partition · rigid · coordinates · constraint · modes · basis · modal_mass · reduction · rubin · damping
//! memory_forecast · size_forecast · verification · audit · assembly
//! report · output · outcome · export · recovery · cli
//! ```
//!
//! # Invariants
//!
//! 1. Of the stages only [`input`] and [`output`] touch files. Around them [`job`] reads its document, [`report`] reads the
//!    clock, [`cli`] and the program have the terminal, and [`heap`] writes the last line of a run that finds no memory.
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
pub mod cli;
pub mod constraint;
pub mod coordinates;
pub mod damping;
pub mod dense;
pub mod dofs;
pub mod eigen;
pub mod error;
pub mod export;
pub mod factor;
pub mod foreign_exit;
pub mod heap;
pub mod input;
pub mod job;
mod linked;
pub mod memory_forecast;
pub mod modal_mass;
pub mod model;
pub mod modes;
mod number;
pub mod outcome;
pub mod output;
pub mod partition;
pub mod random;
pub mod recovery;
pub mod reduction;
mod regular_file;
pub mod report;
pub mod rigid;
pub mod rubin;
pub mod size_forecast;
pub mod sparse;
pub mod verification;

use audit::{Audit, Reference};
use basis::Basis;
use constraint::{Constrained, LooseMotions, constrained};
use damping::{Damping, refuse_resistance};
use error::Result;
use factor::Analysis;
use input::{Allowance, InputFacts};
use job::{AcceptJob, Job};
use memory_forecast::Resources;
use model::Model;
use modes::{Component, ModeSource, Retained, Search};
use outcome::Outcome;
use output::Results;
use partition::{CarriedMatrix, Expansion, Loads, Partition, Quantities};
use random::SEED;
use reduction::Reduction;
use report::Observer;
use supel_runtime::Superelement;
use verification::Evidence;

/// Reduces a component: the whole method, step by step.
///
/// What `resources` cannot hold is refused before the first factorisation; nothing of it reaches the outcome.
///
/// # Errors
/// The errors of the stages; each says what is wrong, where, what was found, what was expected and what to do.
pub fn reduce(job: &Job, resources: Resources, observer: &mut dyn Observer) -> Result<Outcome> {
    let (facts, partition) = prepared(job, resources, observer)?;
    with_stages(job, &partition, (resources, observer), |stages, observer| {
        let Stages { evidence, analysis, loose, n_other_factors } = stages;
        observer.stage("verification");
        let findings = verification::verify(&evidence)?;

        observer.stage("preservation");
        let preserved = verification::preservation(&evidence, analysis, job)?;

        let (input, findings, preserved) = (&facts, &findings, &preserved);
        let results = Results { job, input, loose, evidence, findings, preserved, analysis, n_other_factors };
        output::output(&results).map(|(superelement, report)| Outcome { superelement, report })
    })
}

/// What the stages up to the projection have made.
struct Stages<'a> {
    evidence: Evidence<'a>,
    analysis: &'a Analysis,
    loose: &'a LooseMotions,
    /// Factorisations in addition to that of K_II.
    n_other_factors: usize,
}

/// The stages from the rigid-body modes to the projection, and what is made of their results.
fn with_stages<T>(
    job: &Job,
    partition: &Partition,
    (resources, observer): (Resources, &mut dyn Observer),
    then: impl FnOnce(Stages<'_>, &mut dyn Observer) -> Result<T>,
) -> Result<T> {
    size_forecast::of_interfaces(partition).iter().for_each(|warning| observer.warned(warning));
    observer.stage("rigid-body modes");
    // The analysis reads the pattern of the matrices alone, so that it runs at the same time.
    let (rigid, analysis) = rayon::join(|| rigid::rigid_body_modes(partition), || partition.analysis());
    let ((rigid, n_extra), analysis) = (rigid?, analysis?);
    let rank = refuse_resistance(job, partition, &rigid).and_then(|()| rigid::interface_rank(partition, &rigid))?;

    observer.stage("factor");
    let storage = memory_forecast::storage_within_memory(&analysis, partition, job, resources)?;
    let factor = constraint::interior_factor(partition, &analysis, &rigid, storage)?;

    observer.stage("constraint modes");
    let Constrained { modes: constraint, rigid, rank, loose } = constrained(partition, &factor, rigid, rank)?;

    observer.stage("modes");
    let component = Component::new(partition, &analysis, &factor, &rigid, &constraint);
    let search = Search::new(component, &job.reduction)?;
    let size = (storage, search.n_expected());
    let forecast = search.n_expected().and_then(|n_modes| size_forecast::of_modes(n_modes, job));
    forecast.iter().for_each(|warning| observer.warned(warning));
    let at_once = memory_forecast::slices_within_memory(&analysis, partition, job, resources, size)?;
    let found = factor.vouched(search.with_slices_at_once(at_once).lowest(SEED))?;

    observer.stage("certificate");
    let (found, certificate) = modes::certified(&search, &search.problem, found, search.edge(), job.certified())?;
    let retained = Retained::new(partition, found, search.problem.boundary);

    observer.stage("basis");
    let answers = basis::static_answers(component);
    let named = basis::retained_columns(component, &job.reduction, &retained).with_answers(component, answers.as_ref());
    let basis = Basis::answering(component, &named).with_coordinates()?;

    observer.stage("projection");
    let reduction = Reduction::new(partition, &basis, &rigid).with_mass_of(&job.reduction, &basis, &retained)?;
    let rubin = rubin::rubin_where_asked(&job.reduction, &basis, &reduction, &retained)?;

    let damping = Damping::of_reduction(job, partition, &reduction)?;

    observer.stage("enclosures");
    let enclosures = verification::enclosures_where_asked(component, &retained, job.certified())?;

    let evidence = Evidence {
        partition,
        factor: &factor,
        rigid: &rigid,
        rank,
        constraint: &constraint,
        retained: &retained,
        basis: &basis,
        reduction: &reduction,
        answers: answers.as_ref(),
        rubin: rubin.as_ref(),
        damping: damping.as_ref(),
        certificate: certificate.as_ref(),
        enclosures: enclosures.as_ref(),
        expect: job.model.expect.as_ref(),
    };
    let n_other_factors = n_extra + usize::from(search.edge().is_some());
    then(Stages { evidence, analysis: &analysis, loose: &loose, n_other_factors }, observer)
}

/// The first four stages, which every look at the full model begins with.
fn prepared(job: &Job, resources: Resources, observer: &mut dyn Observer) -> Result<(InputFacts, Partition)> {
    // Small dense decompositions use faer's global setting; sequential ones give the same bits on every machine.
    faer::set_global_parallelism(faer::Par::Seq);

    observer.stage("read");
    let allowance = Allowance::of(resources.allowed(job));
    let mut read = input::read_within(&job.model, &allowance)?;
    let columns = input::load_columns(&job.loads, &read)?;
    let modes = input::expansion_columns(&job.reduction, &read, &allowance)?;
    let rows = input::job_quantities(job.write.quantities.as_ref(), &read, &allowance)?;
    let matrices = input::further_matrices(job, &read, &allowance)?;
    let facts = InputFacts::of(&read).with_loads(&job.loads, &columns).with_modes(modes.as_ref());
    let mut facts = facts.with_quantities(rows.as_ref()).with_matrices(&matrices);

    observer.stage("check");
    facts.notes.extend(model::add_masses(&mut read, &job.added_masses)?);
    let model = Model::new(read)?;

    observer.stage("coordinates");
    let tied = partition::nodes_of_patches(&model, &job.interfaces);
    facts.notes.extend(partition::reference_nodes(&model, &job.interfaces));
    let model = coordinates::compared(model, &job.model.held_rotations, &tied)?;
    facts.notes.extend(coordinates::remark(&model).map(str::to_owned));

    observer.stage("partition");
    let recovered = partition::recovered_rows(&model, job.write.recovery.as_ref())?;
    let loads = partition::loads(&model, &job.loads, &columns)?;
    let modes = modes.map(|modes| partition::expansion_modes(&model, &modes)).transpose()?;
    let quantities = partition::quantities(&model, rows)?;
    let matrices = partition::further_matrices(&model, matrices)?;
    let patches = partition::patches(&model, &job.interfaces);
    facts.faces = input::patch_faces(&job.model, &patches, &allowance)?;
    let interfaces = partition::with_faces(&job.interfaces, &facts.faces)?;
    let is_weighed = job.model.expect.is_some() || !job.fixed.is_empty();
    let weight = if is_weighed { model.weight() } else { None };
    let held = partition::held(&model, &job.fixed)?;
    let mut partition = Partition::with_held(model, &interfaces, held)?;
    partition.recovered = recovered;
    partition.quantities = Quantities::carried(quantities, &partition.transformation);
    partition.matrices = CarriedMatrix::carried(matrices, &partition.transformation)?;
    partition.loads = Loads::carried(loads, &partition.transformation)?;
    if let Some(modes) = modes {
        partition.expansion = Expansion::carried(&modes, &partition.transformation)?;
    }
    partition.model.weight = weight;
    job.reduction.held.as_ref().map_or(Ok(()), |held| partition.hold_for_modes(held))?;
    Ok((facts, partition))
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
    let (facts, partition) = prepared(job, resources, observer)?;

    observer.stage("reference");
    memory_forecast::comparison_within_memory(&partition, job, resources, superelement.tensors().frequencies.len())?;
    let reference = Reference::new(job, &facts, &partition)?;

    observer.stage("comparison");
    let mut audit = audit::against(superelement, &reference)?;
    drop(reference);
    if job.accepted() != AcceptJob::default() {
        audit = audit.joined(accepted(superelement, job, &partition, (resources, observer))?);
    }
    Ok(audit)
}

/// What the scene accepts, measured on the matrices of a file by the stages of a reduction of the same job.
fn accepted(
    superelement: &Superelement,
    job: &Job,
    partition: &Partition,
    (resources, observer): (Resources, &mut dyn Observer),
) -> Result<Audit> {
    with_stages(job, partition, (resources, observer), |Stages { evidence: own, analysis, .. }, observer| {
        observer.stage("preservation");
        let Some(reduction) = audit::reduction_of(superelement, &own) else {
            return Ok(Audit::unlike(
                "what the scene accepts was not measured: its coordinates are not those of the job",
            ));
        };
        let evidence = Evidence { reduction: &reduction, ..own };
        let compared = verification::preservation_of_file((&evidence, &own), analysis, job)?;
        Ok(Audit::of_accuracy(&compared))
    })
}
