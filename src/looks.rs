//! Looks at a model without a reduction of it: a result of another program held against it, and what it is.

use crate::certification::{
    self, Band, Claims, Foreign, ForeignSuperelement, Interface, LeftOut, Own, PairFiles, Placed, ReducedCertification,
    ReducedFiles, ResultFiles,
};
use crate::error::{Error, Result};
use crate::examination::{self, Examination, Examined};
use crate::input::{self, Allowance, ModeValues};
use crate::job::{Job, ModeSelection, ModesJob, ReductionJob};
use crate::line::{Conditioned, Stages, concluded, prepared, with_component, with_stages};
use crate::memory_forecast::Resources;
use crate::plan::Plan;
use crate::report::{
    CertificationReport, CertifiedModel, CertifiedResult, Generator, Observer, ReducedReport, ReducedSource,
    ResultReport,
};
use crate::verification::check::Check;
use crate::verification::preservation::Preservation;

/// Holds what another program computed against the matrices of a model: eigenpairs, or a superelement by its basis. The job names the
/// model and what is held of it; it has no interface: rows that a superelement keeps as coordinates are found in its basis.
///
/// # Errors
/// The errors of reading the model and the result; [`Error::ValuesUnit`]; those of the stages up to the modes.
pub fn certify(
    job: &Job,
    files: &ResultFiles,
    band: Option<Band>,
    run: (Resources, &mut dyn Observer),
) -> Result<CertifiedResult> {
    match files {
        ResultFiles::Pairs(files) => certified_pairs(job, files, band, run).map(Box::new).map(CertifiedResult::Pairs),
        ResultFiles::Superelement(files) => {
            certified_superelement(job, files, band, run).map(Box::new).map(CertifiedResult::Superelement)
        }
    }
}

fn certified_pairs(
    job: &Job,
    files: &PairFiles,
    band: Option<Band>,
    (resources, observer): (Resources, &mut dyn Observer),
) -> Result<CertificationReport> {
    let (facts, partition) = prepared(&Plan::of(job), resources, observer)?;

    observer.stage("result");
    let allowance = Allowance::of(resources.allowed(job));
    let mut modes = input::foreign_modes(&files.shapes, &certification::mode_rows(&partition, &facts), &allowance)?;
    let left_out = std::mem::take(&mut modes.notes);
    let values = match &files.values {
        Some((unit, source)) => Some(ModeValues::read(*unit, source, modes.columns.len(), &allowance)?),
        None => modes.values.clone(),
    };
    let (modes, turned) = certification::right_way_round(&partition, modes);
    let claims = Claims::of(&partition, &modes, values.as_ref())?;
    let result = ResultReport::of(&modes, values.as_ref());
    drop(modes);

    with_component(&Plan::of(job), &partition, (resources, observer), |Conditioned { component, .. }, observer| {
        observer.stage("certificate");
        let mut certification = certification::certified_pairs(component, &job.reduction, &claims, band)?;
        certification.notes.extend(left_out.into_iter().chain(turned.map(str::to_owned)));
        let model = CertifiedModel::of(&facts, component);
        Ok(CertificationReport { generator: Generator::default(), model, result, certification })
    })
}

fn certified_superelement(
    job: &Job,
    files: &ReducedFiles,
    band: Option<Band>,
    (resources, observer): (Resources, &mut dyn Observer),
) -> Result<ReducedReport> {
    let (facts, partition) = prepared(&Plan::of(job), resources, observer)?;

    observer.stage("result");
    let rows = certification::mode_rows(&partition, &facts);
    let allowance = Allowance::of(resources.allowed(job));
    let given = ForeignSuperelement::read(files, &rows, (job.model.duplicates, &allowance))?;
    let Placed { given, interface, notes: told, names } = given.placed(&partition);
    // Where no coordinate is a row of the model nothing tells which are static answers, and half of them may be.
    let n_modes = match interface.coordinates.len() {
        0 => given.n_coordinates().div_ceil(2),
        n_static => given.n_coordinates().saturating_sub(n_static).max(1),
    };
    let wanted =
        band.map_or(ModeSelection::Count { count: n_modes }, |band| ModeSelection::UpTo { up_to_hz: band.to_hz });
    let reduction = ReductionJob { modes: Some(ModesJob::Computed(wanted)), ..job.reduction.clone() };
    let foreign = Foreign::of(&partition, &given, &interface)?;
    let (model, free, left_out) = with_component(
        &Plan::of(job),
        &partition,
        (resources, observer),
        |Conditioned { component, .. }, observer| {
            observer.stage("certificate");
            let free = certification::compared_free(component, &reduction, &foreign, band)?;
            let boundary = (Own::Free, free.n_without_stiffness);
            let left_out = certification::left_out(component, &job.reduction, (&given, &interface), boundary);
            Ok((CertifiedModel::of(&facts, component), free, left_out))
        },
    )?;
    let mut certification = ReducedCertification::new(&foreign, &interface, (free, names));
    certification.notes.extend(given.basis.notes.iter().chain(&given.notes).cloned().chain(told));
    let source = ReducedSource::of(&given);
    drop(partition);
    certification.complete(match held_modes(job, (&given, &interface), (resources, observer)) {
        Ok(None) => left_out,
        with_held => with_held,
    })?;

    if let Some(job) = certification.job_of_interface(job, interface.jobs.clone()) {
        let compared = at_interface(&job, (&given, &interface), (resources, observer));
        certification.compare(compared)?;
    }
    Ok(ReducedReport { generator: Generator::default(), model, source, certification })
}

/// What modes of the component with its interface held a superelement of another program left out; none where it has none of them.
fn held_modes(
    job: &Job,
    (given, interface): (&ForeignSuperelement, &Interface),
    (resources, observer): (Resources, &mut dyn Observer),
) -> Result<Option<LeftOut>> {
    let Some(job) = interface.held(job) else { return Ok(None) };
    let partition = match prepared(&Plan::of(&job), resources, observer) {
        // What keeps all rows has no modes with them held.
        Err(Error::AllFixed { .. }) => return Ok(None),
        prepared => prepared?.1,
    };
    with_component(&Plan::of(&job), &partition, (resources, observer), |Conditioned { component, .. }, observer| {
        observer.stage("certificate");
        certification::left_out(component, &job.reduction, (given, interface), (Own::Held, 0))
    })
}

/// A superelement of another program at the interface that a job names, which is its own.
fn at_interface(
    job: &Job,
    (given, interface): (&ForeignSuperelement, &Interface),
    (resources, observer): (Resources, &mut dyn Observer),
) -> Result<(Preservation, Vec<Check>)> {
    let (_, partition) = prepared(&Plan::of(job), resources, observer)?;
    let foreign = Foreign::of(&partition, given, interface)?;
    with_stages(&Plan::of(job), &partition, (resources, observer), |Stages { evidence, analysis, .. }, observer| {
        observer.stage("preservation");
        certification::preserved(&evidence, analysis, &foreign, job)
    })
}

/// Finds out what a pair of matrices is. The job names the model and what is held of it; it has no interface, and asks for
/// [`crate::examination::N_MODES`] modes. Where a stage refuses the model, that is a finding, and the examination goes on without what was refused.
///
/// # Errors
/// Those of the machine: files that cannot be read, no memory.
pub fn examine(job: &Job, (resources, observer): (Resources, &mut dyn Observer)) -> Result<Examined> {
    let mut examination = Examination::of(job);
    let mut attempt = job.clone();
    let (facts, partition) = loop {
        let error = match prepared(&Plan::of(&attempt), resources, observer) {
            Ok(prepared) => break prepared,
            Err(error) => error,
        };
        let next = examination.retreat(&attempt, &error);
        if next.is_none() && !examination::is_of_model(&error) {
            return Err(error);
        }
        examination.refused(&attempt, &error, next.as_ref().map(|next| next.how.as_str()));
        match next {
            Some(next) => attempt = next.job,
            None => return Ok(examination.given_up(attempt)),
        }
    };
    let allowance = Allowance::of(resources.allowed(&attempt));
    let nodes = attempt.model.nodes.as_deref().map(|path| input::nodes(path, &allowance)).transpose()?;
    examination.look_at(&partition, &facts, nodes.as_ref());
    if let Some(nodes) = nodes.as_ref().filter(|_| examination.lacks_interfaces()) {
        // A surface that takes more memory than there is, or that is damaged, leaves the ends of the component to be proposed.
        let faces = input::outer_faces(&attempt.model, nodes, &allowance).unwrap_or_default();
        examination.look_at_surface(&partition, nodes, &faces);
    }
    let reduced = with_stages(&Plan::of(&attempt), &partition, (resources, observer), |stages, observer| {
        concluded(&stages, &facts, observer)
    });
    match reduced {
        Ok(outcome) => Ok(examination.ended(attempt, Some(outcome.report.body))),
        Err(error) if examination::is_of_model(&error) => {
            examination.refused(&attempt, &error, None);
            Ok(examination.ended(attempt, None))
        }
        Err(error) => Err(error),
    }
}
