//! The straight line: the stages of a reduction in their order, as far as somebody needs them.

use crate::basis::{self, Basis};
use crate::constraint::{self, Constrained, LooseMotions, constrained};
use crate::coordinates;
use crate::cost_forecast::{Comparisons, Foreseen};
use crate::damping::{Damping, refuse_resistance};
use crate::error::{Error, Result};
use crate::factor::{Analysis, Storage};
use crate::input::{self, Allowance, InputFacts};
use crate::job::{Mechanisms, ModeSelection};
use crate::memory_forecast::{self, Resources};
use crate::model::{self, Model};
use crate::modes::{Component, Retained, Search, StaticSet};
use crate::outcome::Outcome;
use crate::output::{self, Results};
use crate::partition::{self, CarriedMatrix, Expansion, Partition, Quantities};
use crate::plan::{Mass, Modes, Plan};
use crate::random::SEED;
use crate::reduction::Reduction;
use crate::report::Observer;
use crate::rigid::{self, InterfaceRank, RigidBodyModes};
use crate::rubin::{self, Reaction};
use crate::size_forecast;
use crate::unseen::unseen_modes;
use crate::verification::{self, Evidence};

/// The first four stages, which every look at the full model begins with.
pub(crate) fn prepared(
    plan: &Plan,
    resources: Resources,
    observer: &mut dyn Observer,
) -> Result<(InputFacts, Partition)> {
    let job = plan.job();
    // Small dense decompositions use faer's global setting; sequential ones give the same bits on every machine.
    faer::set_global_parallelism(faer::Par::Seq);

    observer.stage("read");
    let allowance = Allowance::of(resources.allowed(job));
    let mut read = input::read_within(&job.model, &allowance)?;
    let columns = input::load_columns(&job.loads, &read, &allowance)?;
    let modes = input::expansion_columns(&job.reduction, &read, &allowance)?;
    let rows = input::job_quantities(job.write.quantities.as_ref(), &read, &allowance)?;
    let matrices = input::further_matrices(job, &read, &allowance)?;
    let facts = InputFacts::of(&read).with_loads(&job.loads, &columns).with_modes(modes.as_ref());
    let mut facts = facts.with_quantities(rows.as_ref()).with_matrices(&matrices);

    observer.stage("check");
    facts.notes.extend(model::add_masses(&mut read, &job.added_masses)?);
    let model = Model { cache: resources.cache.cloned(), ..Model::new(read)? };

    observer.stage("coordinates");
    let tied = partition::nodes_of_patches(&model, &job.interfaces);
    facts.notes.extend(partition::reference_nodes(&model, &job.interfaces));
    let model = coordinates::compared(model, (&job.model.held_rotations, job.model.mechanisms), &tied)?;
    let model = model.knowing_supports(&job.model.held_rotations);
    facts.notes.extend(coordinates::remark(&model).map(str::to_owned));

    observer.stage("partition");
    let outputs = partition::outputs(&model, job.scene.as_ref())?;
    let recovered = partition::recovered_rows(&model, job.write.recovery.as_ref())?;
    let faces = input::patch_faces(&job.model, &partition::patches(&model, job), &allowance)?;
    let (recovered, remark) = recovered.with_faces(&faces);
    facts.notes.extend(remark);
    let loads = partition::loads(&model, (&job.loads, &job.added_masses), &columns, &faces)?;
    let modes = modes.map(|modes| partition::expansion_modes(&model, &modes)).transpose()?;
    let quantities = partition::quantities(&model, rows)?;
    let matrices = partition::further_matrices(&model, matrices)?;
    let interfaces = partition::with_faces(&job.interfaces, &faces)?;
    facts.faces = faces.into_iter().filter(|patch| patch.is_of_interface()).collect();
    let weight = model.weight();
    let held = partition::held(&model, &job.fixed)?;
    let mut partition = Partition::in_scene(model, &interfaces, held, (plan.statements(), plan.parting()))?;
    let supports = job.scene.as_ref().and_then(|scene| scene.boundaries.as_deref());
    partition.refuse_partly_loaded(supports.unwrap_or_default())?;
    (partition.recovered, partition.outputs) = (recovered, outputs);
    partition.quantities = Quantities::carried(quantities, &partition.transformation);
    partition.matrices = CarriedMatrix::carried(matrices, &partition.transformation)?;
    partition.carry_loads(loads, &job.loads)?;
    if let Some(modes) = modes {
        partition.expansion = Expansion::carried(&modes, (&partition.transformation, &partition.mass))?;
    }
    partition.model.weight = weight;
    job.reduction.held.as_ref().map_or(Ok(()), |held| partition.hold_for_modes(held))?;
    Ok((facts, partition))
}

/// A component before its modes: what the stages up to the constraint modes have made.
#[derive(Clone, Copy)]
pub(crate) struct Conditioned<'a> {
    pub(crate) component: Component<'a>,
    /// The plan with what the model has decided.
    plan: &'a Plan,
    rank: InterfaceRank,
    loose: &'a LooseMotions,
    storage: Storage,
    /// Factorisations in addition to that of K_II.
    n_other_factors: usize,
}

/// The stages from the rigid-body modes to the constraint modes, and what is made of their results.
pub(crate) fn with_component<T>(
    plan: &Plan,
    partition: &Partition,
    (resources, observer): (Resources, &mut dyn Observer),
    then: impl FnOnce(Conditioned<'_>, &mut dyn Observer) -> Result<T>,
) -> Result<T> {
    size_forecast::of_interfaces(partition).iter().for_each(|warning| observer.warned(warning));
    observer.stage("rigid-body modes");
    // The analysis reads the pattern of the matrices alone, so that it runs at the same time.
    let (rigid, analysis) = rayon::join(|| rigid::rigid_body_modes(partition), || partition.analysis());
    let ((rigid, n_extra), analysis) = (rigid?, analysis?);
    let (Reaction { rank, every, n_factorisations: n_counted }, plan) = known(plan, partition, &rigid)?;
    let rigid = every.unwrap_or(rigid);

    observer.stage("factor");
    let compared = Comparisons::in_memory(&plan, (partition, &analysis), None);
    let storage = memory_forecast::storage_within_memory(&analysis, partition, (&plan, compared), resources)?;
    observer.foreseen(&Foreseen::of(&plan, (partition, &analysis), None));
    let factor = constraint::interior_factor(partition, &analysis, &rigid, (storage, rank))?;

    observer.stage("constraint modes");
    let Constrained { modes: held, rigid, rank, loose, n_factorisations } =
        constrained(partition, (&factor, plan.statics()), rigid, rank)
            .map_err(|error| naming_unloaded(error, &plan))?;
    loose.refuse_unmeant(plan.job().model.mechanisms, partition, &rigid)?;
    let component = Component::new(partition, &analysis, &factor, &rigid, held.as_ref());
    let n_other_factors = n_extra + n_counted + n_factorisations;
    then(Conditioned { component, plan: &plan, rank, loose: &loose, storage, n_other_factors }, observer)
}

/// The plan of [`known`] and all motions without energy: with them the mechanisms that the job accepts, which a reduction finds behind its
/// factorisation. Here they take one.
pub(crate) fn foreknown(plan: &Plan, partition: &Partition, rigid: RigidBodyModes) -> Result<(Plan, RigidBodyModes)> {
    let (Reaction { rank, every, .. }, known) = known(plan, partition, &rigid)?;
    if every.is_some() || plan.job().model.mechanisms != Mechanisms::Accept {
        return Ok((known, every.unwrap_or(rigid)));
    }
    let every = match rigid::counted_by_matrices(partition, rigid.clone()) {
        // What the digits do not let be counted, a reduction finds in its own way.
        Err(error) if error.class().is_of_matrices() => return Ok((known, rigid)),
        counted => counted?.0,
    };
    Ok((known.knowing(rigid::facts(partition, &every, rank)), every))
}

/// How the interface reacts motions without energy, and the plan with what the model decides.
pub(crate) fn known(plan: &Plan, partition: &Partition, rigid: &RigidBodyModes) -> Result<(Reaction, Plan)> {
    refuse_resistance(plan.job(), partition, rigid)?;
    let counted = || rigid::counted_by_matrices(partition, rigid.clone());
    let reaction = rubin::reaction(partition, (rigid, counted), plan).map_err(|error| naming_unloaded(error, plan))?;
    let facts = rigid::facts(partition, reaction.every.as_ref().unwrap_or(rigid), reaction.rank);
    Ok((reaction, plan.knowing(facts)))
}

/// An interface that lacks a motion, with what the scene leaves unloaded of it.
fn naming_unloaded(mut error: Error, plan: &Plan) -> Error {
    if let (Error::InterfaceRank { unloaded, .. }, Some(scene)) = (&mut error, &plan.job().scene) {
        unloaded.extend(scene.unloaded.iter().map(|part| format!("`{}`", part.0)));
        unloaded.extend(scene.connected.iter().map(|_| "all that is not `connected`".to_owned()));
    }
    error
}

/// What the stages up to the projection have made.
pub(crate) struct Stages<'a> {
    /// The plan with what the model has decided.
    plan: &'a Plan,
    pub(crate) evidence: Evidence<'a>,
    pub(crate) analysis: &'a Analysis,
    loose: &'a LooseMotions,
    /// Factorisations in addition to that of K_II.
    n_other_factors: usize,
}

/// The stages from the rigid-body modes to the projection, and what is made of their results.
pub(crate) fn with_stages<T>(
    plan: &Plan,
    partition: &Partition,
    (resources, observer): (Resources, &mut dyn Observer),
    then: impl FnOnce(Stages<'_>, &mut dyn Observer) -> Result<T>,
) -> Result<T> {
    with_component(plan, partition, (resources, observer), |conditioned, observer| {
        with_reduction(conditioned, (resources, observer), then)
    })
}

/// The band is looked through again to this multiple where what the scene accepts is not met.
const FURTHER: f64 = 2.0;
/// So many bands are looked through.
const SEARCHES: i32 = 3;
/// Where a basis of the fewest modes errs more than foreseen, at a place of its own, it gets one mode more for so many.
const GROWTH: usize = 8;

/// The stages from the modes on: with those that the job asks for, or with the fewest that meet what its scene accepts.
pub(crate) fn reduced(
    conditioned: Conditioned<'_>,
    facts: &InputFacts,
    (resources, observer): (Resources, &mut dyn Observer),
) -> Result<Outcome> {
    let made = |plan: &Plan, facts: &InputFacts, observer: &mut dyn Observer| {
        let conditioned = Conditioned { plan, ..conditioned };
        with_reduction(conditioned, (resources, observer), |stages, observer| concluded(&stages, facts, observer))
    };
    let Some(first_hz) = conditioned.plan.searched_hz() else { return made(conditioned.plan, facts, observer) };
    let (mut plan, mut n_widest) = (conditioned.plan.clone(), 0);
    for n_searches in 0..SEARCHES {
        plan = plan.keeping(ModeSelection::UpTo { up_to_hz: first_hz * FURTHER.powi(n_searches) });
        let looking = plan.uncertified();
        let all = Conditioned { plan: &looking, ..conditioned };
        let (fewest, n_all) = with_reduction(all, (resources, &mut *observer), |stages, observer| {
            observer.stage("choice of modes");
            let fewest = verification::fewest_modes(&stages.evidence, stages.analysis, looking.job())?;
            Ok((fewest, stages.evidence.retained.modes.count()))
        })?;
        n_widest = n_all;
        let mut next = fewest;
        while let Some(count) = next.filter(|count| *count <= n_all) {
            let facts = facts.remarking(format!(
                "{count} of the {n_all} lowest modes are kept: as many as the accepted errors of frequencies, response and loads \
                 need"
            ));
            let outcome = made(&plan.keeping(ModeSelection::Count { count }), &facts, observer)?;
            if outcome.report.body.preservation.modes_are_enough() {
                return Ok(outcome);
            }
            let n_kept = outcome.superelement.tensors().frequencies.len();
            next = Some(n_kept + n_kept.div_ceil(GROWTH).max(1));
        }
    }
    made(&plan.keeping(ModeSelection::Count { count: n_widest }), facts, observer)
}

/// The stages from the modes to the projection.
fn with_reduction<T>(
    conditioned: Conditioned<'_>,
    (resources, observer): (Resources, &mut dyn Observer),
    then: impl FnOnce(Stages<'_>, &mut dyn Observer) -> Result<T>,
) -> Result<T> {
    let Conditioned { component, plan, rank, loose, storage, n_other_factors } = conditioned;
    let (Component { partition, analysis, factor, rigid, .. }, job) = (component, plan.job());

    observer.stage("modes");
    let search = Search::new(component, &job.reduction)?;
    let size = (storage, search.n_expected());
    observer.foreseen(&Foreseen::of(plan, (partition, analysis), search.n_expected()));
    let forecast = search.n_expected().and_then(|n_modes| size_forecast::of_modes(n_modes, job));
    forecast.iter().for_each(|warning| observer.warned(warning));
    let planned = (plan, Comparisons::in_memory(plan, (partition, analysis), search.n_expected()));
    let at_once = memory_forecast::slices_within_memory(analysis, partition, planned, resources, size)?;
    let search = search.with_slices_at_once(at_once);
    let found = match plan.modes() {
        Modes::Computed => search.lowest_or_earlier(SEED)?,
        Modes::NotAsked => search.nothing(),
    };

    observer.stage("certificate");
    let (found, certificate) = search.certified(found, job.certified())?;
    let retained = Retained::new(partition, found, search.problem.boundary);
    let retained = retained.ranked(partition, plan.gravity());

    observer.stage("basis");
    let StaticSet { constraint, n_more } = StaticSet::of(component)?;
    let constraint = &*constraint;
    let answers = basis::static_answers(component, constraint);
    let named = basis::retained_columns(component, constraint, plan.relief(), &retained);
    let named = named.with_answers(component, answers.as_ref());
    let basis = Basis::answering(component, constraint, &named).with_coordinates()?;

    observer.stage("projection");
    let reduction = match plan.mass() {
        Mass::Reduced => Reduction::new(partition, &basis, rigid).with_mass_of(&job.reduction, &basis, &retained)?,
        Mass::NotAsked => Reduction::of_statics(partition, &basis, rigid),
    };
    let rubin = rubin::rubin_where_asked(&job.reduction, &basis, &reduction, &retained)?;
    let damping = Damping::of_reduction(job, partition, &reduction)?;
    let of_modes = (partition, &retained);
    let unseen = unseen_modes(plan.unseen(), of_modes, (&basis, &reduction, damping.as_ref()));
    observer.stage("enclosures");
    let enclosures = verification::enclosures_where_asked(component, &retained, job.certified())?;

    let evidence = Evidence {
        partition,
        factor,
        rigid,
        rank,
        constraint,
        retained: &retained,
        basis: &basis,
        reduction: &reduction,
        answers: answers.as_ref(),
        rubin: rubin.as_ref(),
        damping: damping.as_ref(),
        unseen: &unseen,
        certificate: certificate.as_ref(),
        enclosures: enclosures.as_ref(),
        expect: job.model.expect.as_ref(),
    };
    let n_other_factors = n_other_factors + n_more + usize::from(search.edge().is_some());
    then(Stages { plan, evidence, analysis, loose, n_other_factors }, observer)
}

/// The stages that prove what a reduction is worth, and what is made of it.
pub(crate) fn concluded(stages: &Stages<'_>, facts: &InputFacts, observer: &mut dyn Observer) -> Result<Outcome> {
    let Stages { plan, evidence, analysis, loose, n_other_factors } = *stages;
    observer.stage("verification");
    let findings = match plan.mass() {
        Mass::Reduced => verification::verify(&evidence)?,
        Mass::NotAsked => verification::verify_statics(&evidence)?,
    };

    observer.stage("preservation");
    let preserved = verification::preservation(&evidence, analysis, plan.job())?;
    let (input, findings, preserved) = (facts, &findings, &preserved);
    let results = Results { plan, input, loose, evidence, findings, preserved, analysis, n_other_factors };
    output::output(&results).map(|(superelement, report)| Outcome { superelement, report })
}
